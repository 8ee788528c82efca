"""Test of the virtual board's memory against LiteDRAM's own model, which has a separate memory for each bank."""

import random
from types import SimpleNamespace

from litedram.phy.model import SDRAMPHYModel
from migen import Module

from glint_soc.memory_model import MemoryModel
from simulation import run_simulation

CYCLES = 400
SEED = 1
CLOCK = 81.25e6

# Levels of ras_n, cas_n and we_n.
ACTIVATE, PRECHARGE, READ, WRITE, NONE = (0, 1, 1), (0, 1, 0), (1, 0, 1), (1, 0, 0), (1, 1, 1)
ALL_BANKS = 1 << 10

PLACES = (2, 5)
"""Number of rows, and of words per row, that are accessed: small, so that words are read after they are written."""


def _commands(rng, geometry, settings):
    """Yields for each cycle legal commands of a controller: a tuple of levels, bank and address for some phases."""
    rows = {}
    # The first cycle in which the row of a bank may change, because the data of a write come later than its command.
    earliest = {bank: 0 for bank in range(2**geometry.bankbits)}
    for cycle in range(CYCLES):
        commands = {}
        kind, bank = rng.choice((READ, WRITE, NONE)), rng.randrange(2**geometry.bankbits)
        if kind != NONE and bank in rows:
            # With A10, memory closes the row after the access. The models do not close the row, but a controller opens a row before each
            # use.
            column = 8*rng.choice(PLACES) | rng.choice((0, ALL_BANKS))
            commands[settings.rdphase if kind == READ else settings.wrphase] = kind, bank, column
            earliest[bank] = max(earliest[bank], cycle + 1 + settings.write_latency)
        free = next(phase for phase in range(settings.nphases) if phase not in (settings.rdphase, settings.wrphase))
        bank = rng.randrange(2**geometry.bankbits)
        if bank not in rows:
            rows[bank] = rng.choice(PLACES)
            commands[free] = ACTIVATE, bank, rows[bank]
        elif rng.random() < 0.02 and all(earliest[other] <= cycle for other in rows):
            commands[free] = PRECHARGE, bank, ALL_BANKS
            rows.clear()
        elif rng.random() < 0.1 and earliest[bank] <= cycle:
            commands[free] = PRECHARGE, bank, 0
            del rows[bank]
        yield commands


def test_same_data():
    geometry = SimpleNamespace(bankbits=3, rowbits=3, colbits=6, addressbits=11)
    module = SimpleNamespace(memtype="DDR3", geom_settings=geometry)
    top, rng, problems = Module(), random.Random(SEED), []
    top.submodules.found = found = MemoryModel(module, 16, CLOCK)
    top.submodules.expected = expected = SDRAMPHYModel(module, data_width=16, clk_freq=CLOCK)
    read = 0

    def drive():
        nonlocal read
        for cycle, commands in enumerate(_commands(rng, geometry, found.settings)):
            for number in range(found.settings.nphases):
                levels, bank, address = commands.get(number, (NONE, 0, 0))
                data, mask = rng.getrandbits(32), rng.getrandbits(4)
                for phase in (found.dfi.phases[number], expected.dfi.phases[number]):
                    yield phase.cs_n.eq(0)
                    for signal, level in zip((phase.ras_n, phase.cas_n, phase.we_n), levels):
                        yield signal.eq(level)
                    yield phase.bank.eq(bank)
                    yield phase.address.eq(address)
                    yield phase.wrdata.eq(data)
                    yield phase.wrdata_mask.eq(mask)
            yield
            for mine, theirs in zip(found.dfi.phases, expected.dfi.phases):
                read += (yield theirs.rddata) != 0
                for name in ("rddata_valid", "rddata"):
                    if (yield getattr(mine, name)) != (yield getattr(theirs, name)):
                        problems.append(f"cycle {cycle}: {name} differs from LiteDRAM's model (seed {SEED})")

    run_simulation(top, drive())
    assert not problems[:10]
    assert read >= CYCLES/4, "words that were written before"

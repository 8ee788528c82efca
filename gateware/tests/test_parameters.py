"""Test of the parameters of passes, behind a stage of this project and behind a bank of LiteX alone: writes and loads at random times."""

import random

import pytest
from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRStorage
from litex.soc.interconnect.csr_bus import CSRBank, Interface

from glint_soc.parameters import Parameter, PassParameters
from glint_soc.register_bus import RegisterStage
from glint_soc.register_map import CSR_PAGING
from simulation import run_simulation

_WINDOW = 3


class _Block(LiteXModule):
    """A block with an ordinary register, four parameters in two passes (one parameter is in both), and a separate `Parameter`."""

    def __init__(self, has_stage):
        other = CSRStorage(32, name="other")
        wide, narrow, both, last = (Parameter(size, name=name, description="")
                                    for name, size in {"wide": 32, "narrow": 3, "both": 20, "last": 32}.items())
        alone = Parameter(8, name="alone", description="")
        self.parameters = PassParameters([wide, narrow, both], [both, last])
        self.registers = [other, wide, alone, narrow, both, last]
        bank = CSRBank(self.registers, _WINDOW, Interface(data_width=32), CSR_PAGING)
        self.bus = bank.bus
        if has_stage:
            self.stage = RegisterStage(bank, _WINDOW)
            self.bus = self.stage.bus
            self.parameters.connect(self.stage, bank.simple_csrs)
        self.submodules += bank


@pytest.mark.parametrize("has_stage", (True, False))
def test_loads(has_stage):
    """Checks that the copies for a pass equal the words that software wrote before the load, and hold until the next load."""
    rng = random.Random(1)
    block = _Block(has_stage)
    bus, parameters, registers = block.bus, block.parameters, block.registers
    written, problems = [0] * len(registers), []
    loaded = [dict.fromkeys(copies, None) for copies in parameters.copies]

    def write(number, value, window=_WINDOW):
        yield bus.adr.eq(window * CSR_PAGING // 4 + number)
        yield bus.dat_w.eq(value)
        yield bus.we.eq(1)
        yield
        # The bridge holds address and data until the write has its effect.
        yield bus.we.eq(0)
        yield
        if window == _WINDOW:
            written[number] = value & (1 << registers[number].size) - 1

    def compare():
        for k, copies in enumerate(parameters.copies):
            for register, copy in copies.items():
                if loaded[k][register] is not None and (found := (yield copy)) != loaded[k][register]:
                    problems.append(f"{register.name} of pass {k}: {found:#x}, expected {loaded[k][register]:#x}")

    def run():
        for number in range(len(registers)):
            yield from write(number, rng.getrandbits(32))
        for _ in range(300):
            for _ in range(rng.randrange(6)):
                yield from write(rng.randrange(len(registers)), rng.getrandbits(32), rng.choice([_WINDOW, _WINDOW + 1]))
            yield
            yield from compare()
            load = rng.randrange(1, 4)
            loads = [load]
            if rng.random() < 0.3:
                loads.append(rng.randrange(1, 4))
            for load in loads:
                yield parameters.load.eq(load)
                yield
                for k in range(2):
                    if load >> k & 1:
                        loaded[k] = {register: written[registers.index(register)] for register in parameters.copies[k]}
            yield parameters.load.eq(0)
            yield
            clocks = 0
            while (yield parameters.loading):
                clocks += 1
                yield
            if clocks > 20:
                problems.append(f"loads of {loads} took {clocks} clocks")
            yield from compare()
            # At this time the stage has forwarded the last write.
            alone = registers[2]
            if (found := (yield alone.storage)) != written[2]:
                problems.append(f"{alone.name}: {found:#x}, expected {written[2]:#x}")

    run_simulation(block, run())
    assert not problems[:5]

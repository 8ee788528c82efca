"""Test of the arbiter of the CPU's two buses, with main memory behind it, and with random traffic in the CPU's protocol."""

import random

import pytest
from litex.soc.interconnect import wishbone
from migen import Module, passive

from glint_soc.cpu_bus import BusSelections, CpuBus
from memory_bench import BASE, WORDS, access, bench, merged
from simulation import run_simulation

_TRANSACTIONS = 300
_LINE = 8


class _Cpu(Module):
    """The arbiter between two buses and main memory."""

    def __init__(self, slave, bridge):
        self.data, self.instructions = (wishbone.Interface(data_width=32, address_width=32, addressing="word") for _ in range(2))
        self.submodules += bridge
        self.submodules.stage = CpuBus(self.data, self.instructions)
        self.comb += self.stage.bus.connect(slave)


@pytest.mark.parametrize("data_width", (128, 32))
def test_random_traffic(data_width):
    """Checks that reads of lines and single words on both buses return the latest written data, and that the memory ends with
    all writes."""
    rng = random.Random(4)
    slave, bridge, memory = bench(data_width, rng)
    cpu = _Cpu(slave, bridge)
    expected, problems = list(memory.words), []

    def pause(longest):
        for _ in range(rng.randrange(longest + 1)):
            yield

    def data():
        for _ in range(_TRANSACTIONS):
            word = rng.randrange(WORDS // 2)
            if rng.random() < 0.5:
                value, sel = rng.getrandbits(32), rng.randrange(1, 16)
                yield from access(cpu.data, BASE // 4 + word, data=value, sel=sel)
                expected[word] = merged(expected[word], value, sel)
            else:
                length = rng.choice((1, _LINE))
                word -= word % length
                if (found := (yield from access(cpu.data, BASE // 4 + word, length))) != expected[word:word + length]:
                    problems.append(f"data, word {word}: expected {expected[word:word + length]}, got {found}")
            yield from pause(rng.choice((0, 0, 9)))
        for _ in range(50):
            yield

    @passive
    def instructions():
        while True:
            word = rng.randrange(WORDS // 2, WORDS) // _LINE * _LINE
            if (found := (yield from access(cpu.instructions, BASE // 4 + word, _LINE))) != expected[word:word + _LINE]:
                problems.append(f"instructions, line at word {word}: got {found}")
            yield from pause(rng.choice((0, 3, 40)))

    run_simulation(cpu, [data(), instructions(), memory.run()])
    assert not problems
    assert memory.words == expected


def test_selected_slaves():
    """Checks the stored selections of the SoC's decoder against LiteX's own selections, for random requests of both buses."""
    rng, top = random.Random(8), Module()
    top.data, top.instructions = (wishbone.Interface(data_width=32, address_width=32, addressing="word") for _ in range(2))
    top.submodules.stage = stage = CpuBus(top.data, top.instructions)
    covers = [lambda adr: adr[3:] == 1, lambda adr: adr[4:] == 3, lambda adr: adr[3:] == 2]
    found, expected = ([(own, wishbone.Interface(data_width=32, address_width=32, addressing="word")) for own in covers] for _ in range(2))
    top.submodules.selections = selections = BusSelections(stage)
    top.submodules += wishbone.InterconnectShared([stage.bus], [(selections.stored(own), slave) for own, slave in found])
    shown = wishbone.Interface(data_width=32, address_width=32, addressing="word")
    top.comb += [shown.adr.eq(stage.bus.adr), shown.cyc.eq(stage.bus.cyc)]
    top.submodules += wishbone.Decoder(shown, expected)
    selected = []

    def requests(bus):
        for _ in range(200):
            word, length, is_write = rng.randrange(64), rng.choice((1, _LINE)), rng.random() < 0.3
            if is_write or length == 1:
                yield from access(bus, word, data=rng.getrandbits(32) if is_write and bus is top.data else None)
            else:
                yield from access(bus, word - word % _LINE, length)

    @passive
    def answers():
        while True:
            pending, ours, theirs = (yield stage.bus.cyc), [], []
            for (_, slave), (_, other) in zip(found, expected):
                ours.append((yield slave.cyc))
                theirs.append((yield other.cyc))
                yield slave.ack.eq(0)
            # The selected slave answers. For an address without a slave the first slave answers, in place of LiteX's timeout.
            if pending and rng.random() < 0.5:
                yield found[ours.index(1) if 1 in ours else 0][1].ack.eq(1)
            selected.append((ours, theirs))
            yield

    run_simulation(top, [requests(top.data), requests(top.instructions), answers()])
    assert all(ours == theirs for ours, theirs in selected)
    assert {tuple(ours) for ours, _ in selected} == {(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)}

"""Test of the arbiter of the CPU's two buses, with main memory behind it, and with random traffic in the CPU's protocol."""

import random

import pytest
from litex.soc.interconnect import wishbone
from migen import Module, passive, run_simulation

from glint_soc.cpu_bus import CpuBus
from memory_bench import BASE, WORDS, access, bench, merged

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

"""Test of the stage between the CPU's two buses and the shared bus, before main memory: random traffic as the CPU's."""

import random

import pytest
from litex.soc.interconnect import wishbone
from migen import Module, passive, run_simulation

from glint_soc.cpu_bus import CpuBus
from test_memory_bridge import BASE, WORDS, bench, merged

_TRANSACTIONS = 300
_LINE = 8


class _Cpu(Module):
    """The stage between two buses and the main memory."""

    def __init__(self, slave, bridge):
        self.data, self.instructions = (wishbone.Interface(data_width=32, address_width=32, addressing="word") for _ in range(2))
        self.submodules += bridge
        self.submodules.stage = CpuBus(self.data, self.instructions)
        self.comb += self.stage.bus.connect(slave)


def access(bus, word, length=1, data=None, sel=0b1111):
    """An access as VexRiscv's: the request stays until its last word is acknowledged. Returns the words that were read."""
    found = []
    yield bus.cyc.eq(1)
    yield bus.stb.eq(1)
    yield bus.we.eq(data is not None)
    yield bus.dat_w.eq(data or 0)
    yield bus.sel.eq(sel)
    for n in range(length):
        yield bus.adr.eq(BASE // 4 + word + n)
        yield bus.cti.eq(wishbone.CTI_BURST_INCREMENTING if n < length - 1 else wishbone.CTI_BURST_END)
        yield
        for _ in range(400):
            if (yield bus.ack):
                break
            yield
        else:
            raise AssertionError("no acknowledgement in 400 cycles")
        found.append((yield bus.dat_r))
    yield bus.cyc.eq(0)
    yield bus.stb.eq(0)
    return found


@pytest.mark.parametrize("data_width", (128, 32))
def test_random_traffic(data_width):
    """Checks that both buses read what was written before, lines and single words, and that all writes reach the memory once."""
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
                yield from access(cpu.data, word, data=value, sel=sel)
                expected[word] = merged(expected[word], value, sel)
            else:
                length = rng.choice((1, _LINE))
                word -= word % length
                if (found := (yield from access(cpu.data, word, length))) != expected[word:word + length]:
                    problems.append(f"data, word {word}: expected {expected[word:word + length]}, got {found}")
            yield from pause(rng.choice((0, 0, 9)))
        for _ in range(50):
            yield

    @passive
    def instructions():
        while True:
            word = rng.randrange(WORDS // 2, WORDS) // _LINE * _LINE
            if (found := (yield from access(cpu.instructions, word, _LINE))) != expected[word:word + _LINE]:
                problems.append(f"instructions, line at word {word}: got {found}")
            yield from pause(rng.choice((0, 3, 40)))

    run_simulation(cpu, [data(), instructions(), memory.run()])
    assert not problems
    assert memory.words == expected

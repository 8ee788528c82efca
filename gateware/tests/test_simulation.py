"""Test of `simulation`: compares it with Migen's simulator."""

import random

from migen import Array, Case, Cat, If, Memory, Module, Mux, Replicate, Signal
from migen.sim import core

import simulation


class _Block(Module):
    """Registers and combinational signals with all operators, and all kinds of targets."""

    def __init__(self):
        self.a, self.b, self.c, self.index = a, b, c, index = Signal(8), Signal((7, True)), Signal((4, True)), Signal(2)
        values = [a + b, a - b, a * b, -a, -b, ~a, ~b, a & b, a | b, a ^ b, a < b, a <= b, a == b, a != b, a > b, a >= b, a >> index,
                  b >> index, a << index, b << index, Mux(a > b, b, c), a[2:5], b[3:], a.part(index, 3), Cat(a, b, c), Replicate(b[:3], 3),
                  Array((a, b))[index], Array((a[:4], b + 1, c))[index]]
        self.outputs = []
        for value in values:
            unsigned, signed = Signal(11), Signal((6, True))
            self.comb += unsigned.eq(value)
            self.sync += signed.eq(value + signed)
            self.outputs += [unsigned, signed]
        words, joined, low, high, placed = Array(Signal(5) for _ in range(3)), Signal(12), Signal(3), Signal((5, True)), Signal(9, reset=77)
        self.comb += [joined[3:7].eq(b), If(a[0], joined[:2].eq(c)).Elif(b < 0, joined.part(index, 3).eq(a)),
                      Cat(low, high, joined[8:10]).eq(a ^ b)]
        self.sync += [words[index].eq(words[index] + a), words[index][1:3].eq(b), placed.part(index, 2).eq(c),
                      Case(c, {-3: placed.eq(a), 2: placed[4:].eq(b), "default": Array((placed[:3], placed[6:]))[a[3]].eq(b)})]
        memory = Memory(6, 4, init=[9, 8, 7])
        port = memory.get_port(write_capable=True)
        self.specials += memory, port
        self.comb += [port.adr.eq(index), port.we.eq(a[1]), port.dat_w.eq(b)]
        self.outputs += [*words, joined, low, high, placed, port.dat_r]


def _outputs(run_simulation):
    rng, block, found = random.Random(1), _Block(), []

    def run():
        for _ in range(300):
            for signal in (block.a, block.b, block.c, block.index):
                yield signal.eq(rng.getrandbits(len(signal)))
            yield
            found.append((yield block.outputs))

    run_simulation(block, run())
    return found


def test_same_values():
    """Compares all signals in each clock, for random inputs."""
    assert _outputs(simulation.run_simulation) == _outputs(core.run_simulation)

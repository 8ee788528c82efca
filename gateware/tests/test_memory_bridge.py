"""Tests of the bridge from Wishbone to LiteDRAM, with random traffic and a model of the memory with random latency."""

import random

import pytest
from litex.soc.interconnect import wishbone

from memory_bench import BASE, WORDS, access, bench, merged
from simulation import run_simulation

TRANSACTIONS = 250

_WIDTHS = (128, 32, 16)
"""Tested widths of the memory port in bits."""


def master(bus, memory, rng, errors, counts):
    """Bus master: issues random reads, bursts, aborted bursts and writes, and compares what it reads with its own copy of the
    memory."""
    expected = list(memory.words)

    def beat():
        for _ in range(200):
            yield
            if (yield bus.ack):
                return (yield bus.dat_r)
        raise AssertionError("no acknowledgement in 200 cycles")

    for number in range(TRANSACTIONS):
        kind = rng.choice(["write", "read", "line", "burst", "given up"])
        word = rng.randrange(WORDS)
        length = 1
        if kind == "line":
            word, length = word & ~7, 8
        elif kind in ("burst", "given up"):
            length = min(rng.randint(2, 12), WORDS - word)
        counts[kind] = counts.get(kind, 0) + 1
        stop = rng.randrange(length) if kind == "given up" else length
        yield bus.cyc.eq(1)
        yield bus.stb.eq(1)
        yield bus.we.eq(kind == "write")
        for n in range(stop):
            last = n == length - 1
            yield bus.adr.eq(BASE // 4 + word + n)
            if length == 1:
                yield bus.cti.eq(wishbone.CTI_BURST_NONE)
            else:
                yield bus.cti.eq(wishbone.CTI_BURST_END if last else wishbone.CTI_BURST_INCREMENTING)
            if kind == "write":
                data, sel = rng.getrandbits(32), rng.randrange(1, 16)
                yield bus.dat_w.eq(data)
                yield bus.sel.eq(sel)
                yield from beat()
                expected[word] = merged(expected[word], data, sel)
            else:
                found = yield from beat()
                if found != expected[word + n]:
                    errors.append(f"transaction {number}, {kind} of {length}, word {word + n}: "
                                  f"expected {expected[word + n]:#010x}, got {found:#010x}")
                    return
        if kind == "given up" and stop == 0:
            # Cancels the access before its first answer: the request holds for 1 to 12 cycles, so that its command may already have
            # reached memory.
            yield bus.adr.eq(BASE // 4 + word)
            yield bus.cti.eq(wishbone.CTI_BURST_INCREMENTING)
            for _ in range(rng.randint(1, 12)):
                yield
                if (yield bus.ack):
                    break
        yield bus.cyc.eq(0)
        yield bus.stb.eq(0)
        yield bus.we.eq(0)
        yield bus.adr.eq(rng.getrandbits(20))
        yield
        for _ in range(rng.choice([0, 0, 1, 5, 20])):
            yield
    for _ in range(50):
        yield
    if memory.words != expected:
        errors.append("the memory does not hold what was written")


@pytest.mark.parametrize("data_width", _WIDTHS)
def test_random_traffic(data_width):
    """Checks that reads see all earlier writes, commands stay unchanged until taken, and write data are valid when requested."""
    rng = random.Random(1)
    bus, bridge, memory = bench(data_width, rng)
    errors, counts = [], {}
    run_simulation(bridge, [master(bus, memory, rng, errors, counts), memory.run()])
    assert not errors


@pytest.mark.parametrize("data_width", _WIDTHS)
def test_accesses_of_a_line(data_width):
    """Checks that the fill of a cache line of 32 bytes reads each word of the memory once."""
    rng = random.Random(2)
    bus, bridge, memory = bench(data_width, rng)

    def line():
        yield from access(bus, BASE // 4 + 16, 8)
        for _ in range(30):
            yield

    run_simulation(bridge, [line(), memory.run()])
    assert memory.commands == 256 // data_width

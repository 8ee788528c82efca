"""Tests of the bridge from Wishbone to LiteDRAM: random traffic, and a model of the memory with random latency."""

import random
from collections import deque

import pytest
from litedram.common import LiteDRAMNativePort
from litedram.frontend.adapter import LiteDRAMNativePortConverter
from litex.soc.interconnect import wishbone
from migen import Module, run_simulation, passive

from glint_soc.memory_bridge import MemoryBridge

BASE = 0x4000_0000
WORDS = 256
"""Number of 32-bit words of the memory; it is small, so that accesses overlap."""

TRANSACTIONS = 250

_WIDTHS = (128, 32, 16)
"""Bits of the port of the memory."""


class Memory:
    """Model of the memory at a native port of LiteDRAM: takes commands at random times, and answers without back-pressure."""

    def __init__(self, bus, port, rng):
        self.bus = bus
        self.port = port
        self.rng = rng
        self.bytes = bytearray(rng.randbytes(4 * WORDS))
        self.width = port.data_width // 8
        self.changed = set()
        self.commands = 0

    @passive
    def run(self):
        """Answers commands in order, each some cycles after it was taken, with at most one word per cycle, like LiteDRAM."""
        port, rng = self.port, self.rng
        queue = deque()
        cycle, earliest = 0, 0
        previous = None
        while True:
            # Checks that a command holds until it is taken, unless the bus withdraws the access.
            shown = None
            if (yield port.cmd.valid):
                shown = ((yield port.cmd.we), (yield port.cmd.addr))
            withdrawn = shown is None and not (yield self.bus.cyc)
            if previous is not None and shown != previous and not withdrawn:
                raise AssertionError(f"command {previous} became {shown} before it was taken")
            previous = shown
            if shown is not None and (yield port.cmd.ready):
                previous = None
                self.commands += 1
                earliest = max(earliest + 1, cycle + rng.randint(3, 9))
                queue.append((earliest, *shown))
            if (yield port.wdata.ready):
                if not (yield port.wdata.valid):
                    raise AssertionError("the controller asked for data that were not there")
                self.write(address, (yield port.wdata.data), (yield port.wdata.we))
            yield port.wdata.ready.eq(0)
            yield port.rdata.valid.eq(0)
            if queue and queue[0][0] <= cycle:
                _, we, address = queue.popleft()
                if we:
                    yield port.wdata.ready.eq(1)
                else:
                    yield port.rdata.valid.eq(1)
                    yield port.rdata.data.eq(self.read(address))
            yield port.cmd.ready.eq(rng.random() < 0.6)
            cycle += 1
            yield

    @property
    def words(self):
        """The words of 32 bits."""
        return [int.from_bytes(self.bytes[n:n + 4], "little") for n in range(0, len(self.bytes), 4)]

    def read(self, address):
        return int.from_bytes(self.bytes[self.width * address:self.width * (address + 1)], "little")

    def write(self, address, data, strobes):
        for byte in range(self.width):
            if strobes >> byte & 1:
                self.bytes[self.width * address + byte] = data >> 8 * byte & 0xff


def merged(old, new, sel):
    """Returns the word `old` with the bytes of `new` that the mask `sel` selects."""
    mask = sum(0xff << 8 * byte for byte in range(4) if sel >> byte & 1)
    return old & ~mask | new & mask


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


def bench(data_width, rng):
    """Returns a bus, the bridge behind it, and a memory with a port of `data_width` bits. A port of 16 bits gets a converter."""
    bus = wishbone.Interface(data_width=32, address_width=32, addressing="word")
    port = LiteDRAMNativePort(mode="both", address_width=23, data_width=data_width)
    memory = Memory(bus, port, rng)
    if data_width < 32:
        wide = LiteDRAMNativePort(mode="both", address_width=22, data_width=32)
        both = Module()
        both.submodules += LiteDRAMNativePortConverter(wide, port), MemoryBridge(bus, wide, BASE, early=True)
        return bus, both, memory
    return bus, MemoryBridge(bus, port, BASE), memory


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
        yield bus.cyc.eq(1)
        yield bus.stb.eq(1)
        for n in range(8):
            yield bus.adr.eq(BASE // 4 + 16 + n)
            yield bus.cti.eq(wishbone.CTI_BURST_END if n == 7 else wishbone.CTI_BURST_INCREMENTING)
            yield
            while not (yield bus.ack):
                yield
        yield bus.cyc.eq(0)
        yield bus.stb.eq(0)
        for _ in range(30):
            yield

    run_simulation(bridge, [line(), memory.run()])
    assert memory.commands == 256 // data_width

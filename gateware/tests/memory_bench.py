"""A memory at a bus, with the bridge between them, and accesses to a bus, for tests."""

from collections import deque

from litedram.common import LiteDRAMNativePort
from litedram.frontend.adapter import LiteDRAMNativePortConverter
from litex.soc.interconnect import wishbone
from migen import Module, passive

from glint_soc.memory_bridge import MemoryBridge

BASE = 0x4000_0000
WORDS = 256
"""Number of 32-bit words of the memory; it is small, so that accesses overlap."""


class Memory:
    """Model of the memory at a native port of LiteDRAM: accepts commands at random times, and answers without back-pressure."""

    def __init__(self, bus, port, rng):
        self.bus = bus
        self.port = port
        self.rng = rng
        self.bytes = bytearray(rng.randbytes(4 * WORDS))
        self.width = port.data_width // 8
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
                    raise AssertionError("the controller took write data that were not valid")
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


def access(bus, word, length=1, data=None, sel=0b1111):
    """An access of `length` words with VexRiscv's protocol: the request holds until its last word is acknowledged. `word` is the first
    address in words. Returns the words that were read."""
    found = []
    yield bus.cyc.eq(1)
    yield bus.stb.eq(1)
    yield bus.we.eq(data is not None)
    yield bus.dat_w.eq(data or 0)
    yield bus.sel.eq(sel)
    for n in range(length):
        yield bus.adr.eq(word + n)
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

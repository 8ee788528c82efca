"""Arbiter between the CPU's two buses and the shared bus, with registers for one request, and the selections of the bus's slaves."""

from litex.gen import LiteXModule
from litex.soc.interconnect import wishbone
from litex.soc.interconnect.wishbone import CTI_BURST_END, CTI_BURST_INCREMENTING
from migen import Cat, If, Mux, Signal, log2_int

LINE_WORDS = 8
"""Words of a cache line of the CPU. A burst ends with the last word of its line."""


class CpuBus(LiteXModule):
    """Passes requests of the CPU's Wishbone buses `data` and `instructions` to `bus`; `data` has priority.

        data ─────────┐   ┌───────────────────────────┐
                      ├──▶│ request, in flip-flops    ├──▶ bus ─▶ address decoder ─▶ memories, registers
        instructions ─┘   └───────────────────────────┘
               ◀──────────────── acknowledgement, data of reads

    A request reaches `bus` one clock after the CPU issues it. A write is acknowledged when it is stored in these flip-flops, and
    takes effect before all later requests. The address of a burst is incremented here, so only the first word of a burst takes the
    additional clock. A CPU without a data cache only reads single words, and every CPU reads registers as single words.
    """

    def __init__(self, data, instructions):
        self.bus = bus = wishbone.Interface(data_width=32, address_width=32, addressing="word")
        # The address of the next request, which the bus shows from the next clock on if `loads` is high.
        self.next_adr, self.loads = next_adr, loads = Signal.like(bus.adr), Signal()

        # High while a read of this bus is pending. The bus then still shows the read, which must not start again.
        reads_data, reads_instructions = Signal(), Signal()
        asks_data, asks_instructions, busy, bursts, more, free = (Signal() for _ in range(6))
        word = bus.adr[:log2_int(LINE_WORDS)]
        self.comb += [
            asks_data.eq(data.cyc & data.stb & ~reads_data),
            asks_instructions.eq(instructions.cyc & instructions.stb & ~reads_instructions & ~asks_data),
            more.eq(bursts & (word != LINE_WORDS - 1)),
            free.eq(~busy | (bus.ack & ~more)),
            loads.eq(free),
            next_adr.eq(Mux(asks_data, data.adr, instructions.adr)),
            bus.cyc.eq(busy),
            bus.stb.eq(busy),
            bus.cti.eq(Mux(more, CTI_BURST_INCREMENTING, CTI_BURST_END)),
            data.ack.eq((reads_data & bus.ack) | (asks_data & data.we & free)),
            instructions.ack.eq(reads_instructions & bus.ack),
            data.dat_r.eq(bus.dat_r),
            instructions.dat_r.eq(bus.dat_r),
        ]
        self.sync += [
            If(bus.ack, word.eq(word + 1)),
            If(free,
                busy.eq(asks_data | asks_instructions),
                reads_data.eq(asks_data & ~data.we),
                reads_instructions.eq(asks_instructions),
                bus.dat_w.eq(data.dat_w),
                bus.we.eq(asks_data & data.we),
                bus.adr.eq(next_adr),
                If(asks_data,
                    Cat(bus.sel, bursts).eq(Cat(data.sel, data.cti == CTI_BURST_INCREMENTING)),
                ).Else(
                    Cat(bus.sel, bursts).eq(Cat(instructions.sel, instructions.cti == CTI_BURST_INCREMENTING)),
                ),
            ),
        ]


class BusSelections(LiteXModule):
    """Selections of the slaves of the bus of `stage`, a `CpuBus`: the addresses are compared before the stage stores them, and the
    results are stored with them. The words of a burst have the same slave."""

    def __init__(self, stage):
        self._next_adr, self._loads = stage.next_adr, stage.loads

    def stored(self, covers):
        """Returns the stored result of `covers`, a function that compares an address, as a function for LiteX's decoder."""
        own = Signal()
        self.sync += If(self._loads, own.eq(covers(self._next_adr)))
        return lambda _: own

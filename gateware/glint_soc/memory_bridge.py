"""Bridge from the CPU's bus to the DDR3 memory, which reads a whole cache line at a time."""

from litex.gen import LiteXModule
from litex.soc.interconnect import stream
from litex.soc.interconnect.wishbone import CTI_BURST_INCREMENTING
from migen import FSM, Array, Cat, If, NextState, NextValue, Replicate, Signal

_BUS_BITS = 32
_PORT_BITS = 128
_WORDS = _PORT_BITS // _BUS_BITS


class MemoryBridge(LiteXModule):
    """Wishbone slave of 32 bits over a native LiteDRAM port of 128 bits.

    Reads: an incrementing burst that begins in the first half of 32 aligned bytes (the CPU's line fill) asks for both
    16-byte words at once, and is then served a word of 32 bits a cycle. Any other read asks for one 16-byte word. Words
    that were read are dropped at the end of the burst, so that no data older than the burst are ever served: the next
    line fill sees what DMA has written.

    Writes: a write is acknowledged in the cycle after the controller has taken its command, which fixes its order among
    all accesses to the same bank; the data follow when the controller asks for them. A word takes two cycles if the
    memory keeps up.

    A command is withdrawn only if the bus gives up its access before memory has taken the command, which the CPU never does.
    LiteX's own converter makes one access to memory for each 32-bit word, one after the other.
    """

    def __init__(self, bus, port, base_address):
        if bus.data_width != _BUS_BITS or bus.addressing != "word":
            raise ValueError(f"expected a word addressed bus of {_BUS_BITS} bits, got {bus.data_width}")
        if port.data_width != _PORT_BITS:
            raise ValueError(f"expected a memory port of {_PORT_BITS} bits, got {port.data_width}")

        address = Signal.like(bus.adr)
        beat = address[:2]
        self.comb += address.eq(bus.adr - base_address // (_BUS_BITS // 8))

        # Data of writes wait here from the acceptance of their command until the controller requests them.
        self.writes = writes = stream.SyncFIFO([("data", _BUS_BITS), ("sel", _BUS_BITS // 8), ("beat", 2)], depth=8)
        # FIFO with room for both 16-byte words of a cache line, which the controller sends without back-pressure.
        self.reads = reads = stream.SyncFIFO([("data", _PORT_BITS)], depth=2)
        self.comb += [
            writes.sink.data.eq(bus.dat_w),
            writes.sink.sel.eq(bus.sel),
            writes.sink.beat.eq(beat),
            writes.source.ready.eq(port.wdata.ready),
            port.wdata.valid.eq(writes.source.valid),
            port.wdata.data.eq(Replicate(writes.source.data, _WORDS)),
            port.wdata.we.eq(Cat(*[
                Replicate(writes.source.beat == word, _BUS_BITS // 8) & writes.source.sel for word in range(_WORDS)])),
            port.rdata.connect(reads.sink, omit={"first", "last"}),
            bus.dat_r.eq(Array(reads.source.data[_BUS_BITS * word:][:_BUS_BITS] for word in range(_WORDS))[beat]),
        ]

        # Word address of the second half of the cache line, kept because the bus access may have ended before memory takes its
        # command.
        second = Signal.like(port.cmd.addr)

        # Number of 16-byte words that were requested and not yet taken out of `reads`.
        owed = Signal(max=3)
        asked = Signal()
        taken = Signal()
        more = Signal()
        self.comb += [
            asked.eq(port.cmd.valid & port.cmd.ready & ~port.cmd.we),
            taken.eq(reads.source.valid & reads.source.ready),
            more.eq(bus.cti == CTI_BURST_INCREMENTING),
        ]
        self.sync += owed.eq(owed + asked - taken)

        self.fsm = fsm = FSM(reset_state="COMMAND")
        fsm.act("COMMAND",
            port.cmd.valid.eq(bus.cyc & bus.stb & (~bus.we | writes.sink.ready)),
            port.cmd.we.eq(bus.we),
            port.cmd.addr.eq(address[2:]),
            If(port.cmd.valid & port.cmd.ready,
                If(bus.we,
                    writes.sink.valid.eq(1),
                    NextState("WRITTEN"),
                ).Elif(more & ~address[2],
                    NextValue(second, Cat(1, address[3:])),
                    NextState("SECOND"),
                ).Else(
                    NextState("SERVE"),
                )
            )
        )
        fsm.act("WRITTEN",
            bus.ack.eq(bus.cyc & bus.stb),
            NextState("COMMAND"),
        )
        fsm.act("SECOND",
            port.cmd.valid.eq(1),
            port.cmd.addr.eq(second),
            If(port.cmd.ready,
                NextState("SERVE"),
            )
        )
        fsm.act("SERVE",
            bus.ack.eq(bus.cyc & bus.stb & ~bus.we & reads.source.valid),
            If(bus.ack,
                # Takes the 16-byte word out of `reads` when the bus gets the last of its 32-bit parts, or when the burst ends.
                # After the last requested 16-byte word, the bus needs a new request.
                reads.source.ready.eq(~more | (beat == _WORDS - 1)),
                If(~more | ((beat == _WORDS - 1) & (owed == 1)),
                    NextState("DROP"),
                    If(owed == 1,
                        NextState("COMMAND"),
                    )
                )
            ),
            If(~bus.cyc | bus.we,
                NextState("DROP"),
            )
        )
        # Discards the words that were requested for a burst and not taken before the burst ended.
        fsm.act("DROP",
            reads.source.ready.eq(1),
            If((owed == 0) | ((owed == 1) & reads.source.valid),
                NextState("COMMAND"),
            )
        )

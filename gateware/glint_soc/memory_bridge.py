"""Bridge from the CPU's bus to main memory, which reads a whole cache line at a time."""

from litex.gen import LiteXModule
from litex.soc.interconnect import stream
from litex.soc.interconnect.wishbone import CTI_BURST_INCREMENTING
from migen import FSM, Array, Cat, Constant, If, Mux, NextState, NextValue, Replicate, Signal, log2_int

from .cpu_bus import LINE_WORDS

_BUS_BITS = 32


class MemoryBridge(LiteXModule):
    """Wishbone slave of 32 bits over a native LiteDRAM port of 32, 64 or 128 bits.

    Reads: an incrementing burst (the CPU's line fill) requests all words of the port from its first word to the end of
    an aligned block of 32 bytes, and is then served one 32-bit word per cycle. Any other read requests one word of the
    port. Words that the burst has not used are discarded at its end, so no data older than a burst are ever served: the
    next line fill sees the data that DMA has written.

    Writes: a write is acknowledged in the cycle after the controller has taken its command, which fixes its order among
    all accesses to the same bank. Its data are stored in that cycle too. The controller requests them at least two cycles after
    the command. A write takes two cycles unless the memory is slower. A port with a width converter accepts a command before the
    controller does (`early`). A write is then acknowledged when its data have been taken, which also fixes the order.

    A command is withdrawn only if the bus cancels its access before memory has accepted the command, which the CPU never
    does. LiteX's own converter makes a separate access to memory for each 32-bit word.
    """

    def __init__(self, bus, port, base_address, early=False):
        if bus.data_width != _BUS_BITS or bus.addressing != "word":
            raise ValueError(f"expected a word addressed bus of {_BUS_BITS} bits, got {bus.data_width}")
        if port.data_width not in (32, 64, 128):
            raise ValueError(f"expected a memory port of 32, 64 or 128 bits, got {port.data_width}")

        # Number of bus words per port word, and of port words per cache line.
        words = port.data_width // _BUS_BITS
        line = LINE_WORDS // words
        address = Signal.like(bus.adr)
        beat = address[:log2_int(words)] if words > 1 else Constant(0)
        word = address[log2_int(words):]
        self.comb += address.eq(bus.adr - base_address // (_BUS_BITS // 8))

        # Holds write data from the cycle after the acceptance of their command until the controller requests the data.
        self.writes = writes = stream.SyncFIFO([("data", _BUS_BITS), ("sel", _BUS_BITS // 8), ("beat", len(beat))], depth=8)
        # FIFO for all words of a cache line, because the controller sends them without back-pressure. If the FIFO is empty, an
        # arriving word bypasses it.
        self.reads = reads = stream.SyncFIFO([("data", port.data_width)], depth=line)
        there, takes = Signal(), Signal()
        self.comb += [
            writes.sink.data.eq(bus.dat_w),
            writes.sink.sel.eq(bus.sel),
            writes.sink.beat.eq(beat),
            writes.source.ready.eq(port.wdata.ready),
            port.wdata.valid.eq(writes.source.valid),
            port.wdata.data.eq(Replicate(writes.source.data, words)),
            port.wdata.we.eq(Cat(*[
                Replicate(writes.source.beat == place, _BUS_BITS // 8) & writes.source.sel for place in range(words)])),
            port.rdata.ready.eq(1),
            there.eq(reads.source.valid | port.rdata.valid),
            reads.sink.valid.eq(port.rdata.valid & (reads.source.valid | ~takes)),
            reads.sink.data.eq(port.rdata.data),
            reads.source.ready.eq(takes),
            bus.dat_r.eq(Mux(reads.source.valid, *(
                Array(data[_BUS_BITS * place:][:_BUS_BITS] for place in range(words))[beat]
                for data in (reads.source.data, port.rdata.data)))),
        ]

        # Address of the next word of the line, stored because the bus access may end before memory takes the word's command.
        next_word = Signal.like(port.cmd.addr)
        is_last = Signal()
        # The bus ended the burst before all commands of its line were taken.
        given_up = Signal()

        # Number of port words that were requested and not yet taken.
        owed = Signal(max=line + 1)
        asked = Signal()
        taken = Signal()
        more = Signal()
        self.comb += [
            asked.eq(port.cmd.valid & port.cmd.ready & ~port.cmd.we),
            taken.eq(there & takes),
            more.eq(bus.cti == CTI_BURST_INCREMENTING),
            is_last.eq(next_word[:log2_int(line)] == line - 1),
        ]
        self.sync += owed.eq(owed + asked - taken)

        self.fsm = fsm = FSM(reset_state="COMMAND")
        fsm.act("COMMAND",
            port.cmd.valid.eq(bus.cyc & bus.stb & (~bus.we | writes.sink.ready)),
            port.cmd.we.eq(bus.we),
            port.cmd.addr.eq(word),
            If(port.cmd.valid & port.cmd.ready,
                NextValue(given_up, 0),
                If(bus.we,
                    NextState("WRITTEN"),
                ).Elif(more & (word[:log2_int(line)] != line - 1),
                    NextValue(next_word, word + 1),
                    NextState("REST"),
                ).Else(
                    NextState("SERVE"),
                )
            )
        )
        acknowledge = [bus.ack.eq(bus.cyc & bus.stb), NextState("COMMAND")]
        fsm.act("WRITTEN",
            writes.sink.valid.eq(1),
            *([NextState("WAIT")] if early else acknowledge),
        )
        if early:
            fsm.act("WAIT", If(~writes.source.valid, *acknowledge))
        fsm.act("REST",
            port.cmd.valid.eq(1),
            port.cmd.addr.eq(next_word),
            If(port.cmd.ready,
                NextValue(next_word, next_word + 1),
                If(is_last,
                    NextState("SERVE"),
                    If(given_up | ~bus.cyc,
                        NextState("DROP"),
                    )
                )
            ),
            If(~bus.cyc,
                NextValue(given_up, 1),
            )
        )
        fsm.act("SERVE",
            bus.ack.eq(bus.cyc & bus.stb & ~bus.we & there),
            If(bus.ack,
                # Takes the port word when the bus receives the last 32-bit part of the word, or when the burst
                # ends. After the last requested word, a new request is needed.
                takes.eq(~more | (beat == words - 1)),
                If(~more | ((beat == words - 1) & (owed == 1)),
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
        # Discards the words of a burst that the bus did not take before the burst ended.
        fsm.act("DROP",
            takes.eq(1),
            If((owed == 0) | ((owed == 1) & there),
                NextState("COMMAND"),
            )
        )

"""Joins the native LiteDRAM ports of engines to a single memory port of another bus, for designs without LiteDRAM."""

from functools import reduce
from operator import or_

from litex.gen import LiteXModule
from litex.soc.interconnect import stream, wishbone
from litex.soc.interconnect.axi import AXIInterface
from litex.soc.interconnect.csr import CSRStatus
from migen import FSM, Array, Cat, Constant, If, Mux, NextState, NextValue, Replicate, Signal

from .round_robin import RoundRobin

WORD_BYTES = 16
"""Bytes of a word of the ports."""

_BURST_INCR, _SIZE_16_BYTES, _CACHE_BUFFERABLE, _RESPONSE_OKAY = 0b01, 4, 0b0011, 0b00

_MOST_WRITES = 31
"""Largest number of pending writes of a port."""


class _Ports(LiteXModule):
    """What both buses have in common: the ports, of 128 bits, and the counter of errors."""

    def __init__(self, ports, origin):
        for port in ports:
            if port.data_width != 8 * WORD_BYTES or port.mode not in ("read", "write"):
                raise ValueError(f"expected ports of {8 * WORD_BYTES} bits that read or write, got {port.data_width} bits, {port.mode}")
        self._readers = [port for port in ports if port.mode == "read"]
        self._writers = [port for port in ports if port.mode == "write"]
        self._origin = origin
        # Bit k is set while a word that writer k has sent may not be in memory yet.
        self.pending = Signal(max(len(self._writers), 1))
        self.error = Signal()
        self._errors = CSRStatus(32, name="errors", description="Accesses that memory answered with an error, modulo 2^32.")
        self.sync += If(self.error, self._errors.status.eq(self._errors.status + 1))

    def _address(self, port):
        """Returns the byte address of a port's command. The origin is a multiple of the memory's size."""
        return Cat(Constant(0, 4), port.cmd.addr) | self._origin

    @staticmethod
    def _selected(turn, values):
        return reduce(or_, (Replicate(mine, len(value)) & value for mine, value in zip(turn, values)))


class AxiPorts(_Ports):
    """Joins `ports` to `axi`, an AXI4 master of 128 bits.

    Each access is a burst of one word, because the words of a port need not be consecutive. The identifier of an access is the number of
    its port among the readers, or among the writers. Memory may therefore answer different ports in any order, and must answer each port
    in the order of its accesses, as AXI demands. A write is in memory when it is answered, and the next port's access may come in the next
    clock: throughput is a read and a write per clock. `pending` tells when the writes of each port have been answered.

        readers ─▶ turn ─▶ AR                R ─▶ reader of the identifier
        writers ─▶ turn ─┬▶ AW               B ─▶ pending writes
                         └▶ order ─▶ turn ─▶ W
    """

    def __init__(self, ports, origin):
        _Ports.__init__(self, ports, origin)
        readers, writers = self._readers, self._writers
        self.axi = axi = AXIInterface(data_width=8 * WORD_BYTES, address_width=32, id_width=4)
        for channel in (axi.ar, axi.aw):
            self.comb += [channel.burst.eq(_BURST_INCR), channel.size.eq(_SIZE_16_BYTES), channel.cache.eq(_CACHE_BUFFERABLE)]
        self.comb += [axi.r.ready.eq(1), axi.b.ready.eq(1)]
        failed = [axi.r.valid & (axi.r.resp != _RESPONSE_OKAY), axi.b.valid & (axi.b.resp != _RESPONSE_OKAY)]
        # If two answers fail in the same clock, one is counted: the counter tells whether memory works.
        self.comb += self.error.eq(reduce(or_, failed))

        if readers:
            turns = self._turns(axi.ar, readers, [port.cmd.valid for port in readers])
            self.reads = turns
            for number, port in enumerate(readers):
                self.comb += [port.rdata.valid.eq(axi.r.valid & (axi.r.id == number)), port.rdata.data.eq(axi.r.data)]
        if writers:
            # The numbers of the ports whose words follow, in the order of the addresses.
            order = self.order = stream.SyncFIFO([("port", 4)], depth=_MOST_WRITES)
            levels = [Signal(max=_MOST_WRITES + 1) for _ in writers]
            turns = self._turns(axi.aw, writers, [
                port.cmd.valid & (level != _MOST_WRITES) & order.sink.ready for port, level in zip(writers, levels)])
            self.writes = turns
            self.comb += [
                order.sink.valid.eq(axi.aw.valid & axi.aw.ready),
                order.sink.port.eq(axi.aw.id),
                axi.w.valid.eq(order.source.valid & Array(port.wdata.valid for port in writers)[order.source.port]),
                axi.w.data.eq(Array(port.wdata.data for port in writers)[order.source.port]),
                axi.w.strb.eq(Array(port.wdata.we for port in writers)[order.source.port]),
                axi.w.last.eq(1),
                order.source.ready.eq(axi.w.valid & axi.w.ready),
            ]
            for number, (port, level) in enumerate(zip(writers, levels)):
                sent, answered = Signal(), Signal()
                self.comb += [
                    sent.eq(axi.aw.valid & axi.aw.ready & (axi.aw.id == number)),
                    answered.eq(axi.b.valid & (axi.b.id == number)),
                    port.wdata.ready.eq(order.source.ready & (order.source.port == number)),
                    self.pending[number].eq(level != 0),
                ]
                self.sync += level.eq(level + sent - answered)

    def _turns(self, channel, ports, wants):
        """Connects the commands of ports to a channel of addresses. An address stays until it is taken."""
        turns = RoundRobin(len(ports)) if len(ports) > 1 else None
        turn = turns.turn if turns else Constant(1, 1)
        self.comb += [
            channel.valid.eq(reduce(or_, (mine & want for mine, want in zip(turn, wants)))),
            channel.addr.eq(self._selected(turn, [self._address(port) for port in ports])),
            channel.id.eq(reduce(or_, (Mux(mine, number, 0) for number, mine in enumerate(turn)))),
            *(port.cmd.ready.eq(mine & want & channel.ready) for port, mine, want in zip(ports, turn, wants)),
        ]
        if turns:
            self.comb += [turns.wants.eq(Cat(*wants)), turns.holds.eq(channel.valid & ~channel.ready)]
        return turns or LiteXModule()


class WishbonePorts(_Ports):
    """Joins `ports` to `bus`, a Wishbone master of 128 bits, with addresses of words of 16 bytes.

    One access takes place at a time, and takes two clocks more than memory does: a small and slow port. `err` ends an access as `ack` does.
    """

    def __init__(self, ports, origin):
        _Ports.__init__(self, ports, origin)
        self.bus = bus = wishbone.Interface(data_width=8 * WORD_BYTES, address_width=32, addressing="word")
        ports = [*self._readers, *self._writers]
        wants = [port.cmd.valid for port in ports]
        turns = self.turns = RoundRobin(len(ports))
        owner = Signal.like(turns.turn)
        ended = Signal()
        self.comb += [
            turns.wants.eq(Cat(*wants)),
            ended.eq(bus.cyc & (bus.ack | bus.err)),
            self.error.eq(bus.cyc & bus.err),
            bus.stb.eq(bus.cyc),
        ]
        if self._writers:
            owners = [owner[ports.index(port)] for port in self._writers]
            self.comb += [
                bus.dat_w.eq(self._selected(owners, [port.wdata.data for port in self._writers])),
                bus.sel.eq(Mux(bus.we, self._selected(owners, [port.wdata.we for port in self._writers]), 2**WORD_BYTES - 1)),
            ]
        else:
            self.comb += bus.sel.eq(2**WORD_BYTES - 1)
        for number, port in enumerate(ports):
            if port.mode == "read":
                self.sync += [port.rdata.valid.eq(ended & owner[number]), port.rdata.data.eq(bus.dat_r)]
            else:
                self.comb += port.wdata.ready.eq(ended & owner[number])
        self.fsm = fsm = FSM()
        fsm.act("COMMAND",
            *(port.cmd.ready.eq(mine) for port, mine in zip(ports, turns.turn)),
            NextValue(owner, turns.turn),
            NextValue(bus.adr, self._selected(turns.turn, [self._address(port)[4:] for port in ports])),
            NextValue(bus.we, self._selected(turns.turn, [Constant(int(port.mode == "write"), 1) for port in ports])),
            If(reduce(or_, (mine & want for mine, want in zip(turns.turn, wants))), NextState("ACCESS")),
        )
        fsm.act("ACCESS",
            bus.cyc.eq(1),
            turns.holds.eq(1),
            If(ended, NextState("COMMAND")),
        )

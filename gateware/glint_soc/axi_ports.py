"""Joins the memory ports of engines to one AXI4 port."""

from functools import reduce
from operator import or_

from litex.gen import LiteXModule
from litex.soc.interconnect import stream
from litex.soc.interconnect.axi import AXIInterface
from migen import Array, Cat, Constant, Mux, Signal, log2_int

from .memory_ports import MemoryPorts
from .round_robin import RoundRobin

_BURST_INCR, _CACHE_BUFFERABLE, _RESPONSE_OKAY = 0b01, 0b0011, 0b00


class AxiPorts(MemoryPorts):
    """Joins `ports` to `axi`, an AXI4 master of the same width. At most `most_writes` writes of a port are pending.

    Each access is a burst of one word, because the words of a port need not be consecutive. The identifier of an access is the number of
    its port among the readers, or among the writers. Memory may therefore answer different ports in any order, and must answer each port
    in the order of its accesses, as AXI demands. A write is in memory when it is answered; until then `pending` is high. Throughput: one
    read and one write per clock.

        readers ─▶ turn ─▶ AR                R ─▶ reader of the identifier
        writers ─▶ turn ─┬▶ AW               B ─▶ pending writes
                         └▶ order ─▶ turn ─▶ W
    """

    def __init__(self, ports, origin, most_writes=31):
        MemoryPorts.__init__(self, ports, origin)
        readers, writers = self._readers, self._writers
        self.axi = axi = AXIInterface(data_width=self._bits, address_width=32, id_width=4)
        for channel in (axi.ar, axi.aw):
            self.comb += [channel.burst.eq(_BURST_INCR), channel.size.eq(log2_int(self._bits // 8)), channel.cache.eq(_CACHE_BUFFERABLE)]
        self.comb += [axi.r.ready.eq(1), axi.b.ready.eq(1)]
        failed = [axi.r.valid & (axi.r.resp != _RESPONSE_OKAY), axi.b.valid & (axi.b.resp != _RESPONSE_OKAY)]
        # If two answers fail in the same clock, only one is counted: the counter only shows whether memory works.
        self.comb += self.error.eq(reduce(or_, failed))

        if readers:
            turns = self._turns(axi.ar, readers, [port.cmd.valid for port in readers])
            self.reads = turns
            for number, port in enumerate(readers):
                self.comb += [port.rdata.valid.eq(axi.r.valid & (axi.r.id == number)), port.rdata.data.eq(axi.r.data)]
        if writers:
            # The numbers of the writers whose words are sent next, in the order of their addresses.
            order = self.order = stream.SyncFIFO([("port", 4)], depth=most_writes)
            levels = [Signal(max=most_writes + 1) for _ in writers]
            turns = self._turns(axi.aw, writers, [
                port.cmd.valid & (level != most_writes) & order.sink.ready for port, level in zip(writers, levels)])
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

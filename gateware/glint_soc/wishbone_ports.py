"""Joins the memory ports of engines to one Wishbone port."""

from functools import reduce
from operator import or_

from litex.soc.interconnect import wishbone
from migen import FSM, Cat, Constant, If, Mux, NextState, NextValue, Signal, log2_int

from .memory_ports import MemoryPorts
from .round_robin import RoundRobin


class WishbonePorts(MemoryPorts):
    """Joins `ports` to `bus`, a Wishbone master of the same width, with addresses of words.

    One access takes place at a time, and takes two clocks more than memory does: the port is small but slow. `err` ends an access as `ack`
    does.
    """

    def __init__(self, ports, origin):
        MemoryPorts.__init__(self, ports, origin)
        self.bus = bus = wishbone.Interface(data_width=self._bits, address_width=32, addressing="word")
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
                bus.sel.eq(Mux(bus.we, self._selected(owners, [port.wdata.we for port in self._writers]), 2**(self._bits // 8) - 1)),
            ]
        else:
            self.comb += bus.sel.eq(2**(self._bits // 8) - 1)
        for number, port in enumerate(ports):
            if port.mode == "read":
                self.sync += [port.rdata.valid.eq(ended & owner[number]), port.rdata.data.eq(bus.dat_r)]
            else:
                self.comb += port.wdata.ready.eq(ended & owner[number])
        self.fsm = fsm = FSM()
        fsm.act("COMMAND",
            *(port.cmd.ready.eq(mine) for port, mine in zip(ports, turns.turn)),
            NextValue(owner, turns.turn),
            NextValue(bus.adr, self._selected(turns.turn, [self._address(port)[log2_int(self._bits // 8):] for port in ports])),
            NextValue(bus.we, self._selected(turns.turn, [Constant(int(port.mode == "write"), 1) for port in ports])),
            If(reduce(or_, (mine & want for mine, want in zip(turns.turn, wants))), NextState("ACCESS")),
        )
        fsm.act("ACCESS",
            bus.cyc.eq(1),
            turns.holds.eq(1),
            If(ended, NextState("COMMAND")),
        )

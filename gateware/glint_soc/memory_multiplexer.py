"""Choice among the commands of the banks, for memories that receive one command per clock."""

import math
from functools import reduce
from operator import and_, or_

from litedram.common import tFAWController, tXXDController
from litex.gen import LiteXModule
from migen import FSM, Cat, If, Mux, NextState, NextValue, Replicate, Signal, bits_for

from .round_robin import RoundRobin


class _Timer(LiteXModule):
    """Time between two commands: `ready` is low for `clocks - 1` clocks after each clock in which `started` is high. If `clocks` is
    None, or at most 1, `ready` is constant."""

    def __init__(self, clocks, controller=tXXDController):
        self.started, self.ready = Signal(), Signal(reset=1)
        if clocks is not None and clocks > 1:
            self.controller = timer = controller(clocks)
            self.comb += [timer.valid.eq(self.started), self.ready.eq(timer.ready)]


class MemoryMultiplexer(LiteXModule):
    """Replaces LiteDRAM's multiplexer for a PHY with one phase: passes the commands of the banks and of the refresher to `dfi`, and keeps
    the times between commands of different banks.

    In LiteDRAM the kind of the selected command decides whether any command may be given in this clock. A bank's `cmd.ready` thus
    depends on the state of all banks, through the selection. Here flip-flops hold the turn, the direction of the data and the timers,
    so `cmd.ready` depends, apart from these, only on the bank's own command:

        kind of the own command ─────┐
        turn, direction, timers ─────┴─▶ ready of this bank ─▶ command
             ▲
             └── commands of all banks: the turn of the next clock

    Reads and writes take turns: the direction changes if only commands of the other direction are pending, or after
    `settings.read_time` or `settings.write_time` clocks with pending commands of both. A change takes at least one clock without
    commands; the minimum number of clocks from a read to a write, and from a write to a read, is that of LiteDRAM.
    """

    def __init__(self, settings, banks, refresher, dfi, interface):
        (phase,) = dfi.phases
        timing, phy = settings.timing, settings.phy
        commands = [bank.cmd for bank in banks]

        self.columns, self.activations = columns, activations = _Timer(timing.tCCD), _Timer(timing.tRRD)
        self.four_activations = four_activations = _Timer(timing.tFAW, tFAWController)
        # The data of a write end after its command, by the write latency and the length of the burst.
        after_write = timing.tWTR + math.ceil(phy.cwl / phy.nphases) + (timing.tCCD or 0)
        self.after_writes, self.after_reads = after_writes, after_reads = _Timer(after_write), _Timer(phy.read_latency - 1)

        # Commands are given while `opens` is high, and reads or writes in the direction `writes`. The bank machines of this controller set
        # `cas` for reads and writes only, and `ras` alone for activations.
        opens, writes = Signal(), Signal()
        self.turns = turns = RoundRobin(len(banks))
        own, given, waits = [], [], []
        for number, cmd in enumerate(commands):
            fits, may = Signal(), Signal()
            self.comb += [
                fits.eq(~cmd.cas | (cmd.we == writes)),
                If(cmd.cas,
                    may.eq(columns.ready),
                ).Else(
                    may.eq(cmd.we | (activations.ready & four_activations.ready)),
                ),
                cmd.ready.eq(opens & turns.turn[number] & fits & may),
            ]
            own.append(cmd.valid & fits)
            given.append(cmd.valid & cmd.ready)
            waits.append(own[-1] & turns.turn[number] & ~(opens & may))
        self.comb += [
            turns.wants.eq(Cat(*own)),
            # A bank keeps its turn while its command waits, so it cannot starve.
            turns.holds.eq(reduce(or_, waits)),
        ]

        def any_given(kind):
            """Returns whether a command of this kind is given."""
            return reduce(or_, (gives & kind(cmd) for gives, cmd in zip(given, commands, strict=True)))

        reads, writing, activates = (any_given(kind) for kind in (
            lambda cmd: cmd.cas & ~cmd.we, lambda cmd: cmd.cas & cmd.we, lambda cmd: cmd.ras & ~cmd.we))
        self.comb += [
            columns.started.eq(reads | writing),
            activations.started.eq(activates),
            four_activations.started.eq(activates),
            after_reads.started.eq(reads),
            after_writes.started.eq(writing),
        ]

        # `left` is negative when the time of a direction has ended; its sign is a flip-flop.
        left = Signal((bits_for(max(settings.read_time, settings.write_time)) + 1, True))
        pending, opposite = (reduce(or_, (cmd.cas & ((cmd.we == writes) ^ other) for cmd in commands)) for other in (0, 1))
        self.sync += [
            If(~opens,
                left.eq(Mux(writes, settings.write_time - 2, settings.read_time - 2)),
            ).Elif(~left[-1],
                left.eq(left - 1),
            )
        ]

        self.comb += (bank.refresh_req.eq(refresher.cmd.valid) for bank in banks)
        self.fsm = fsm = FSM()
        fsm.act("OPEN",
            opens.eq(1),
            If(reduce(and_, (bank.refresh_gnt for bank in banks)),
                NextState("REFRESH"),
            ).Elif(opposite & (~pending | left[-1]),
                NextValue(writes, ~writes),
                NextState("CHANGE"),
            )
        )
        fsm.act("CHANGE",
            If(Mux(writes, after_reads.ready, after_writes.ready),
                NextState("OPEN"),
            )
        )
        fsm.act("REFRESH",
            refresher.cmd.ready.eq(1),
            If(refresher.cmd.last,
                NextValue(writes, 0),
                NextState("CHANGE"),
            )
        )

        def selected(name):
            """Returns a member of the command whose turn it is."""
            return reduce(or_, (Replicate(granted, len(getattr(cmd, name))) & getattr(cmd, name)
                                for granted, cmd in zip(turns.turn, commands, strict=True)))

        # The refresher sets the levels of its command only in the state REFRESH.
        refreshes = refresher.cmd.ready
        self.comb += [phase.cs_n.eq(0), phase.cke.eq(1), phase.odt.eq(1), phase.reset_n.eq(1)]
        self.sync += [
            phase.bank.eq(selected("ba")),
            phase.address.eq(Mux(refreshes, refresher.cmd.a, selected("a"))),
            *(getattr(phase, f"{level}_n").eq(~(any_given(lambda cmd, level=level: getattr(cmd, level)) | getattr(refresher.cmd, level)))
              for level in ("ras", "cas", "we")),
            phase.rddata_en.eq(reads),
            phase.wrdata_en.eq(writing),
        ]
        self.comb += [
            interface.rdata.eq(phase.rddata),
            phase.wrdata.eq(interface.wdata),
            phase.wrdata_mask.eq(~interface.wdata_we),
        ]

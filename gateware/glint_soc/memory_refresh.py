"""Refresh of the memory, with timers that are computed one clock ahead."""

from litedram.common import cmd_request_rw_layout
from litedram.core.refresher import RefreshSequencer, ZQCSExecuter
from litex.gen import LiteXModule
from litex.soc.interconnect import stream
from migen import FSM, If, NextState, NextValue, Signal


class _Interval(LiteXModule):
    """Periodic request: `due` rises once every `clocks` clocks, and stays high until `served`."""

    def __init__(self, clocks):
        self.due, self.served = Signal(), Signal()

        left, is_last = Signal(max=clocks, reset=clocks - 1), Signal()
        self.sync += [
            is_last.eq(left == 1),
            If(is_last, left.eq(clocks - 1)).Else(left.eq(left - 1)),
            self.due.eq(is_last | (self.due & ~self.served)),
        ]


class MemoryRefresher(LiteXModule):
    """Replaces LiteDRAM's refresher: sends a refresh every tREFI, and once a second, after a refresh, a calibration
    of the output impedance (ZQCS).

    LiteDRAM's timers signal the end of an interval for a single clock, from a comparison of the count. The calibration timer is only
    checked when a refresh ends, so LiteDRAM misses nearly all calibrations. Here a flip-flop holds each request until it is served,
    and `cmd` is driven by flip-flops.
    """

    def __init__(self, settings, clk_freq):
        timing = settings.timing
        self.cmd = cmd = stream.Endpoint(cmd_request_rw_layout(a=settings.geom.addressbits, ba=settings.geom.bankbits))

        self.refresh = refresh = _Interval(timing.tREFI)
        self.sequencer = sequencer = RefreshSequencer(cmd, timing.tRP, timing.tRFC)
        self.fsm = fsm = FSM()
        # The banks wait while `cmd.valid` is high, and the multiplexer until `cmd.last`.
        finish = [NextValue(cmd.valid, 0), NextValue(cmd.last, 1), NextState("IDLE")]
        fsm.act("IDLE",
            NextValue(cmd.last, 0),
            If(refresh.due,
                refresh.served.eq(1),
                NextValue(cmd.valid, 1),
                NextState("WAIT"),
            )
        )
        fsm.act("WAIT",
            If(cmd.ready,
                sequencer.start.eq(1),
                NextState("REFRESH"),
            )
        )
        after_refresh = finish
        if timing.tZQCS is not None:
            self.calibration = calibration = _Interval(int(clk_freq))
            self.executer = executer = ZQCSExecuter(cmd, timing.tRP, timing.tZQCS)
            calibrate = [calibration.served.eq(1), executer.start.eq(1), NextState("CALIBRATE")]
            after_refresh = If(calibration.due, *calibrate).Else(*finish)
            fsm.act("CALIBRATE", If(executer.done, finish))
        fsm.act("REFRESH", If(sequencer.done, after_refresh))

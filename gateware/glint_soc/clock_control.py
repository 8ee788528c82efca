"""Clock requests of blocks, for a board that stops the clock of idle blocks."""

from litex.gen import LiteXModule
from migen import If, ResetSignal, Signal

LINGER = 31
"""Number of clocks after a block's last work: more than the latency from an event to its counter, and through a register bank."""


class ClockControl(LiteXModule):
    """Control of the clock of a block, its registers included.

    `working`: the block computes, or its pins may change its state. `accessed`: the register bus shows an address of the block; the SoC
    drives this input. While `enable` is low, the clock of the block's domain `sys` may stop.
    """

    def __init__(self, working):
        self.accessed, self.enable = Signal(), Signal()

        # # #

        awake, linger = Signal(), Signal(max=LINGER + 1)
        self.comb += [
            awake.eq(ResetSignal("sys") | working | self.accessed),
            self.enable.eq(awake | (linger != 0)),
        ]
        self.sync += If(awake, linger.eq(LINGER)).Elif(linger != 0, linger.eq(linger - 1))

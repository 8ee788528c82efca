"""Clock requests of blocks, for a board that stops the clock of idle blocks."""

from litex.gen import LiteXModule
from migen import If, ResetSignal, Signal

LINGER = 31
"""Number of clocks for which the clock of an idle block continues. It exceeds the latency from an event to its counter, and the
latency of a register bank."""


class ClockControl(LiteXModule):
    """Enables the clock of a block and of its registers.

    `working` is high while the block computes or while its pins may change its state. `accessed` is high while the register bus shows
    an address of the block; the SoC drives this input. While `enable` is low, the clock of the block's domain `sys` may stop.
    """

    def __init__(self, working):
        self.accessed, self.enable = Signal(), Signal()

        awake, linger = Signal(), Signal(max=LINGER + 1)
        self.comb += [
            awake.eq(ResetSignal("sys") | working | self.accessed),
            self.enable.eq(awake | (linger != 0)),
        ]
        self.sync += If(awake, linger.eq(LINGER)).Elif(linger != 0, linger.eq(linger - 1))

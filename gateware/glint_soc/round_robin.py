"""Round robin arbiter with a short path from the requests to the turn of the next clock."""

from functools import reduce
from operator import and_

from litex.gen import LiteXModule
from migen import Cat, If, Signal


class RoundRobin(LiteXModule):
    """Bit i of `turn` is set while it is the turn of request i. In each clock the turn passes to the next request of `wants`, in the order
    of the numbers. The turn stays if `wants` has no other request, and while `holds` is high.

    Migen's arbiter encodes the turn as a number, and looks for the next request one by one. Here each request compares with all others
    at once; which of two requests is earlier in the order depends only on flip-flops.
    """

    def __init__(self, count):
        self.wants, self.turn, self.holds = Signal(count), Signal(count, reset=1), Signal()

        # Requests with a larger number than the current request precede requests with a smaller number.
        first = Signal(count)
        self.comb += first.eq(Cat(0, *(self.turn[:number] != 0 for number in range(1, count))))
        following = []
        for number in range(count):
            earlier = (
                self.wants[other] & (first[other] | ~first[number] if other < number else first[other] & ~first[number])
                for other in range(count) if other != number)
            # The current request is the last in the order, as if it were always pending.
            following.append(reduce(and_, (~other for other in earlier), self.wants[number] | self.turn[number]))
        self.sync += If(~self.holds, self.turn.eq(Cat(*following)))

"""Register block of two four-digit displays; a digit has seven segments and a point."""

from litex.gen import LiteXModule
from migen import Case, If, Signal

from .parameters import Parameter

DIGITS = 4
"""Number of digits of each display."""

_SLOT_BITS = 13
_DARK_BITS = 9


class Digits(LiteXModule):
    """Lights the eight digits one after another: first those of the left display, from left to right, then those of the right display.

    A digit has 2^13 clocks, so at 81.25 MHz each one is lit 1,240 times a second. In the first 2^9 of these clocks no digit is lit,
    because the transistors that select a digit turn off slowly. For each display `pads` has the pins that select a digit, the leftmost
    digit first, and the pins of the segments; all are active low.
    """

    def __init__(self, pads):
        text = (f"Segments of the digits of the {{}} display, a byte each, the leftmost digit in bits 7:0. Bits 0 to 6 of a byte light the "
                "segments a to g, bit 7 the point.")
        self._left = Parameter(8 * DIGITS, name="left", description=text.format("left"))
        self._right = Parameter(8 * DIGITS, name="right", description=text.format("right"))

        count, place, lit = Signal(_SLOT_BITS + 3), Signal(3), Signal()
        digits, segments = Signal(2 * DIGITS), Signal(8)
        bytes_ = [register.storage[8 * k:][:8] for register in (self._left, self._right) for k in range(DIGITS)]
        self.comb += [
            place.eq(count[_SLOT_BITS:]),
            lit.eq(count[_DARK_BITS:_SLOT_BITS] != 0),
            pads.left_digits_n.eq(~digits[:DIGITS]),
            pads.right_digits_n.eq(~digits[DIGITS:]),
            pads.left_segments_n.eq(~segments),
            pads.right_segments_n.eq(~segments),
        ]
        self.sync += [
            count.eq(count + 1),
            Case(place, {k: segments.eq(byte) for k, byte in enumerate(bytes_)}),
            digits.eq(0),
            If(lit, Case(place, {k: digits[k].eq(1) for k in range(2 * DIGITS)})),
        ]

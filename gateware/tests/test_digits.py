"""Test of the digit displays: the pins as a function of the registers."""

from migen import Record

from glint_soc.digits import DIGITS, Digits
from simulation import run_simulation

_LAYOUT = [(f"{side}_{kind}_n", bits) for side in ("left", "right") for kind, bits in (("digits", DIGITS), ("segments", 8))]
_TURN = 1 << 16


def test_digits():
    """Checks that digits show their bytes for equal times, at most one digit is lit at a time, and none while segments change."""
    pads = Record(_LAYOUT)
    digits, problems = Digits(pads), []
    times, shown, before = {}, {}, {}
    expected = dict(enumerate(b"\x06\x5b\xcf\x66" + b"\x6d\x80\x07\x7f"))

    def run():
        for name, register in (("left", digits._left), ("right", digits._right)):
            first = DIGITS * (name == "right")
            yield register.storage.eq(sum(expected[first + k] << 8 * k for k in range(DIGITS)))
        yield
        yield
        for _ in range(_TURN):
            for first, side in ((0, "left"), (DIGITS, "right")):
                selected = ~(yield getattr(pads, f"{side}_digits_n")) & 0xf
                segments = ~(yield getattr(pads, f"{side}_segments_n")) & 0xff
                if selected:
                    place = first + selected.bit_length() - 1
                    times[place] = times.get(place, 0) + 1
                    shown.setdefault(place, set()).add(segments)
                    if before[side] != (0, segments) and before[side] != (selected, segments):
                        problems.append(f"{side}: {selected:04b}, {segments:#x} after {before[side]}")
                before[side] = selected, segments
            if before["left"][0] and before["right"][0]:
                problems.append("digits of both displays are lit")
            yield

    run_simulation(digits, run())
    assert not problems[:5]
    assert shown == {place: {byte} for place, byte in expected.items()}
    assert set(times.values()) == {(1 << 13) - (1 << 9)}

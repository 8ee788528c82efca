"""A signal some clocks later."""

from migen import Signal


def delayed(module, value, clocks):
    """Returns `value` as it was `clocks` ago, in registers of `module`; without any for 0 clocks."""
    for _ in range(clocks):
        later = Signal.like(value)
        module.sync += later.eq(value)
        value = later
    return value

"""Delay of a signal by a number of clocks."""

from migen import Signal


def delayed(module, value, clocks):
    """Returns `value` delayed by `clocks` clocks, through registers of `module`; `value` itself for 0 clocks."""
    for _ in range(clocks):
        later = Signal.like(value)
        module.sync += later.eq(value)
        value = later
    return value

"""Free-running counters of a block: one line of the description each.

The RTL reports events, in one packed struct `events_t` with a member of each counter's name: how much the counter grows in
this clock. A module sets the members it counts and leaves the others 0; its parent ORs the structs of its parts.
"""

from litex.soc.interconnect.csr import CSRStatus
from migen import Signal

from .packed import Struct


class Counters:
    """The counters of `block`, as registers at the place where this is built, and the accumulators behind them.

    `counters` gives each name its text, or a tuple of text and bits of the largest step where that is not 1. `events` is
    what the RTL is to drive. A counter follows its event by two clocks; its difference between two readings is modulo 2^32.
    """

    def __init__(self, block, counters):
        self.texts, self.registers, members = {}, {}, {}
        for name, counter in counters.items():
            text, bits = counter if isinstance(counter, tuple) else (counter, 1)
            self.texts[name] = text
            self.registers[name] = CSRStatus(32, name=name, description=f"{text.removesuffix('.')}, modulo 2^32.")
            setattr(block, f"_{name}", self.registers[name])
            members[name] = Signal(bits, name=f"event_{name}")
        self.events = Struct("events_t", "Growth of each counter in this clock.", members)
        # `step` registers each event before its counter: the carry chain of 32 bits is long enough alone, and events come from
        # all parts of the block.
        for name, event in members.items():
            step, count = Signal(len(event), name=f"step_{name}"), self.registers[name].status
            block.sync += [step.eq(event), count.eq(count + step)]

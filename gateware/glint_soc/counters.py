"""Free-running counters of a block, each declared by one line of the block's description.

The RTL reports events in one packed struct `events_t`. It has a member for each counter, with the counter's name: the growth of
the counter in this clock. A module sets the members that it counts and leaves all other members 0; its parent ORs the structs of
its parts.
"""

from litex.soc.interconnect.csr import CSRStatus
from migen import Signal

from .packed import Struct


class Counters:
    """The counters of `block`: their registers, which follow the registers that the block has so far, and their accumulators.

    `counters` maps each name to its text, or to a tuple of the text and the number of bits of the largest growth in a clock, if
    that is more than 1. The RTL must drive `events`. A counter follows its event by two clocks. Differences of two readings are
    modulo 2^32.
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
        # `step` registers each event before its counter, because the 32-bit carry chain is a long path by itself, and events come
        # from all parts of the block.
        for name, event in members.items():
            step, count = Signal(len(event), name=f"step_{name}"), self.registers[name].status
            block.sync += [step.eq(event), count.eq(count + step)]

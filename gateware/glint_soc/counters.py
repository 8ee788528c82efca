"""Free-running counters of a block, each declared by one line of the block's description.

The RTL reports events in one packed struct `events_t`. It has a member for each counter, with the counter's name: the increment
of the counter in this clock. A module sets the members of its own events and leaves all other members 0; the parent module
combines the structs of its submodules with OR.
"""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRStatus
from migen import Array, If, Memory, Mux, Signal

from .clock_control import LINGER
from .packed import Struct

_BITS = 32
_DELAY = 3
"""Largest number of clocks from an event to its counter, not including the wait for the counter's turn."""


class Counters(LiteXModule):
    """The counters of `block`: their registers, which are added after the block's existing registers, and their accumulators.

    `counters` maps each name to its text, or to a tuple of the text and the width in bits of the increment, if that is more
    than 1. The RTL must drive `events`. Differences of two readings are modulo 2^32; a reset does not clear a counter. The
    latency from an event to its counter is at most the number of counters plus three clocks.

    The counters are words of one LUT memory. A small register for each counter accumulates the increments between two turns
    of the counter. In each turn, one adder, shared by all counters, adds this register to the counter's word:

        events ─▶ steps ─▶ grown[turn] ─▶ + ─▶ words[turn]
                                          ▲        │
                                          └────────┴──▶ read
    """

    def __init__(self, block, counters):
        self.texts, self.registers, members = {}, {}, {}
        for name, counter in counters.items():
            text, bits = counter if isinstance(counter, tuple) else (counter, 1)
            self.texts[name] = text
            self.registers[name] = CSRStatus(_BITS, name=name, description=f"{text.removesuffix('.')}, modulo 2^{_BITS}.")
            setattr(block, f"_{name}", self.registers[name])
            members[name] = Signal(bits, name=f"event_{name}")
        self.events = Struct("events_t", "Increment of each counter in this clock.", members)

        count = len(members)
        if count + _DELAY > LINGER:
            raise ValueError(f"{count} counters: expected at most {LINGER - _DELAY}, because the clock of an idle block stops")
        words = Memory(_BITS, count)
        total, read = words.get_port(write_capable=True, async_read=True), words.get_port(async_read=True)
        self.specials += words, total, read
        turn = Signal(max=count)
        grown = []
        self.sync += turn.eq(Mux(turn == count - 1, 0, turn + 1))
        for place, (name, event) in enumerate(members.items()):
            # `step` registers each event before it is added, because events come from all parts of the block.
            step = Signal(len(event), name=f"step_{name}")
            # Each counter has its turn once in `count` clocks.
            growth = Signal(max=count * (2**len(event) - 1) + 1, name=f"grown_{name}")
            grown.append(growth)
            self.sync += [step.eq(event), growth.eq(Mux(turn == place, 0, growth) + step)]
            self.comb += [
                self.registers[name].status.eq(read.dat_r),
                If(self.registers[name].we, read.adr.eq(place)),
            ]
        self.comb += [
            total.adr.eq(turn),
            total.we.eq(1),
            total.dat_w.eq(total.dat_r + Array(grown)[turn]),
        ]

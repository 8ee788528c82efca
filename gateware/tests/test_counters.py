"""Test of the counters of a block: random events, and readings at random times."""

import random

from litex.gen import LiteXModule
from litex.soc.interconnect.csr_bus import CSRBank, Interface

from glint_soc.counters import Counters
from simulation import run_simulation


class _Block(LiteXModule):
    """A block with counters and no other registers."""

    def __init__(self):
        self.counters = Counters(self, {"first": "Events.", "second": ("Items.", 3), "third": "Events."})
        self.bank = CSRBank([csr for csr in self.get_csrs() if csr.name in self.counters.registers],
                            bus=Interface(data_width=32))


def test_readings():
    """Checks that each reading is the sum of all events up to a time shortly before it, and that events of all sizes count."""
    rng = random.Random(1)
    block = _Block()
    names = list(block.counters.registers)
    sums, problems = {name: [0] for name in names}, []
    bus = block.bank.bus

    # The delay from an event to its sum is the number of counters plus three clocks.
    late = len(names) + 3

    def run():
        for _ in range(500):
            asked = rng.choice(names)
            yield bus.adr.eq(names.index(asked))
            yield bus.re.eq(1)
            # The address is on the bus in the next clock, the value in the clock after that.
            for _ in range(2):
                for name in names:
                    event = block.counters.events[name]
                    grown = rng.getrandbits(len(event)) if rng.random() < 0.7 else 0
                    yield event.eq(grown)
                    sums[name].append(sums[name][-1] + grown)
                yield
            value = (yield bus.dat_r)
            earliest = sums[asked][max(len(sums[asked]) - 1 - late - 2, 0)]
            if not earliest <= value <= sums[asked][-1]:
                problems.append(f"{asked}: {value}, expected {earliest} to {sums[asked][-1]}")

    run_simulation(block, run())
    assert not problems[:5]

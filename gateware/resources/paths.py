"""Slow paths of a routed netlist, grouped by their ends, computed from the delays in nextpnr's SDF file.

nextpnr's report contains only one path for each clock. This module computes the latest arrival at every register from the delays of
cells and wires:

    register ─▶ wire ─▶ cell ─▶ wire ─▶ ... ─▶ register's input, and its setup time
"""

import re
from collections import Counter, defaultdict, deque
from dataclasses import dataclass

_WIRE = re.compile(r"\(INTERCONNECT (\S+)/(\w+) (\S+)/(\w+) \(\d+:\d+:(\d+)\)")
_CELL = re.compile(r"\(INSTANCE (\S*)\)")
_THROUGH = re.compile(r"\(IOPATH (\w+) (\w+) \(\d+:\d+:(\d+)\)")
_SETUP = re.compile(r"\(SETUPHOLD \(\w+ (\w+)\) \(\w+ (\w+)\) \((-?\d+):(-?\d+):(-?\d+)\)")


@dataclass(frozen=True)
class Group:
    """The slow paths from the registers of one place to the registers of another place: number of endpoints, and delay of the
    longest path in ns."""

    start: str
    end: str
    endpoints: int
    longest: float


def groups(sdf, period, place):
    """Returns the groups of the paths that take longer than `period` ns, the longest path first. `sdf` yields the lines of the
    file. `place` returns the place of a register, given the names of its cell and pin. Each endpoint counts once, with its longest
    path."""
    counts, longest = Counter(), defaultdict(float)
    for (cell, pin), (arrival, start) in _endpoints(sdf).items():
        if arrival > period:
            ends = place(*start), place(cell, pin)
            counts[ends] += 1
            longest[ends] = max(longest[ends], arrival)
    found = [Group(*ends, count, longest[ends]) for ends, count in counts.items()]
    return sorted(found, key=lambda group: (-group.longest, group.start, group.end))


def _endpoints(sdf):
    """Returns for each input of a register, by cell and pin, the latest arrival in ns including the setup time, and the output
    at which the path starts."""
    loads, drivers, setups = _edges(sdf)
    # A pin is processed after all its drivers, so that its arrival time is the latest.
    waits = Counter({pin: len(sources) for pin, sources in drivers.items()})
    arrivals, ready = {}, deque(pin for pin in loads if not waits[pin])
    while ready:
        pin = ready.popleft()
        for load, delay, starts in loads.get(pin, ()):
            # The delay of the clock network is not counted, because it is common to both ends. Constants have no arrival time.
            before = (0, load) if starts else arrivals.get(pin)
            if before and before[0] + delay >= arrivals.get(load, (-1, None))[0]:
                arrivals[load] = before[0] + delay, before[1]
            waits[load] -= 1
            if not waits[load]:
                ready.append(load)
    return {pin: ((arrivals[pin][0] + setup) / 1000, arrivals[pin][1]) for pin, setup in setups.items() if pin in arrivals}


def _edges(sdf):
    """Returns three dictionaries: for each pin the following pins, with the delay in ps and whether paths start at this edge; for
    each pin the preceding pins; and the setup times of the inputs of registers in ps."""
    loads, drivers, setups = defaultdict(list), defaultdict(list), {}
    through, clocks, cell = [], set(), ""

    def close():
        for source, target, delay in through:
            begins = source in clocks
            loads[cell, source].append(((cell, target), delay, begins))
            drivers[cell, target].append((cell, source))
        through.clear()
        clocks.clear()

    for line in sdf:
        if wire := _WIRE.search(line):
            source, source_pin, target, target_pin, delay = wire.groups()
            ends = (_name(source), source_pin), (_name(target), target_pin)
            loads[ends[0]].append((ends[1], int(delay), False))
            drivers[ends[1]].append(ends[0])
        elif edge := _THROUGH.search(line):
            through.append((edge[1], edge[2], int(edge[3])))
        elif setup := _SETUP.search(line):
            pin, clock, *times = setup.groups()
            clocks.add(clock)
            setups[cell, pin] = max(map(int, times), default=0)
        elif instance := _CELL.search(line):
            close()
            cell = _name(instance[1])
    close()
    return loads, drivers, setups


def _name(text):
    """Returns the name of a cell without the escape characters of the SDF format."""
    return text.replace("\\", "")

"""Tests of the multiplexer for memories with one command per clock: bank machines, refresher and multiplexer with random requests."""

import random
from types import SimpleNamespace

import pytest
from litedram.common import LiteDRAMInterface
from litedram.core.controller import ControllerSettings
from litedram.core.multiplexer import Multiplexer
from litedram.modules import MT48LC16M16
from litedram.phy.dfi import Interface
from litedram.phy.gensdrphy import get_default_cl
from litex.gen import LiteXModule

from glint_soc.memory_bank import MemoryBank
from glint_soc.memory_multiplexer import MemoryMultiplexer
from glint_soc.memory_refresh import MemoryRefresher
from simulation import run_simulation

_BANKS = 4
_PENDING = 5
"""Largest number of pending requests of a bank, as in the crossbar."""


def _settings(clock, **changes):
    """Settings of the ULX3S's memory at a frequency in Hz. `changes` replaces times, in clocks."""
    module, settings = MT48LC16M16(clock, "1:1"), ControllerSettings(cmd_buffer_depth=8, read_time=16, write_time=24)
    cl = get_default_cl("SDR", 1 / clock)
    settings.phy = SimpleNamespace(nphases=1, nranks=1, rdphase=0, wrphase=0, dfi_databits=16, cl=cl, cwl=cl, read_latency=cl + 1,
                                   write_latency=0)
    settings.geom, settings.timing = module.geom_settings, module.timing_settings
    settings.timing.tREFI = 200
    for name, clocks in changes.items():
        setattr(settings.timing, name, clocks)
    return settings


class _Controller(LiteXModule):
    def __init__(self, multiplexer, settings):
        self.interface = LiteDRAMInterface(0, settings)
        self.dfi = Interface(settings.geom.addressbits, settings.geom.bankbits, 1, 16, 1)
        self.refresher = MemoryRefresher(settings, 40e6)
        self.banks = [MemoryBank(number, self.interface.address_width, 0, settings) for number in range(_BANKS)]
        self.submodules += self.banks
        self.multiplexer = multiplexer(settings, self.banks, self.refresher, self.dfi, self.interface)


class _Memory:
    """Checks the commands at a DFI port. `problems` are accesses to closed rows, and commands earlier than `settings` allow; `columns`
    the accesses to each bank."""

    def __init__(self, settings):
        timing, phy = settings.timing, settings.phy
        after_write = phy.cwl + timing.tCCD
        # The minimum number of clocks between two commands to the same bank, and to any two banks.
        self.same = {("activate", "column"): timing.tRCD, ("activate", "precharge"): timing.tRAS, ("activate", "activate"): timing.tRC,
                     ("precharge", "activate"): timing.tRP, ("write", "precharge"): after_write + timing.tWR}
        self.any = {("activate", "activate"): timing.tRRD, ("column", "column"): timing.tCCD, ("read", "write"): phy.read_latency,
                    ("write", "read"): after_write + timing.tWTR, ("refresh", "activate"): timing.tRFC,
                    ("precharge", "refresh"): timing.tRP}
        self.window = timing.tFAW or 0
        self.last, self.activated = {}, []
        self.rows = [None] * _BANKS
        self.columns, self.problems, self.refreshes = [[] for _ in range(_BANKS)], [], 0

    def _event(self, names, banks, cycle):
        for (earlier, later), wait in (*self.same.items(), *self.any.items()):
            places = banks if (earlier, later) in self.same else range(_BANKS)
            clocks = min((cycle - self.last.get((earlier, bank), -99) for bank in places), default=99)
            if later in names and clocks < wait:
                self.problems.append(f"cycle {cycle}: {later} {clocks} clocks after {earlier}, expected {wait}")
        for bank in banks:
            self.last |= {(name, bank): cycle for name in names}

    def watch(self, phase, cycle):
        """Checks the command of this clock."""
        levels = []
        for level in (phase.ras_n, phase.cas_n, phase.we_n):
            levels.append(1 - (yield level))
        bank, address = (yield phase.bank), (yield phase.address)
        if (yield phase.rddata_en) != (levels == [0, 1, 0]) or (yield phase.wrdata_en) != (levels == [0, 1, 1]):
            self.problems.append(f"cycle {cycle}: the data do not belong to the command")
        if levels == [1, 0, 0]:
            self._event(("activate",), [bank], cycle)
            self.activated = [*self.activated[-3:], cycle]
            if len(self.activated) == 4 and self.last.get("window", -99) > cycle - self.window:
                self.problems.append(f"cycle {cycle}: five rows are opened in {self.window} clocks")
            self.last["window"] = self.activated[0]
            if self.rows[bank] is not None:
                self.problems.append(f"cycle {cycle}: a row is opened while one is open")
            self.rows[bank] = address
        elif levels[:2] == [0, 1]:
            self._event(("column", "write" if levels[2] else "read"), [bank], cycle)
            self.columns[bank].append((self.rows[bank], address & 0x1ff, levels[2]))
            if address >> 10 & 1:
                self.rows[bank] = None
        elif levels == [1, 0, 1]:
            banks = range(_BANKS) if address >> 10 & 1 else [bank]
            self._event(("precharge",), banks, cycle)
            for bank in banks:
                self.rows[bank] = None
        elif levels == [1, 1, 0]:
            self._event(("refresh",), range(_BANKS), cycle)
            self.refreshes += 1
            if self.rows != [None] * _BANKS:
                self.problems.append(f"cycle {cycle}: a refresh while a row is open")
        elif levels != [0, 0, 0]:
            self.problems.append(f"cycle {cycle}: a command with the levels {levels}")


def _requests(rng, count, longest=12):
    """Random requests for the banks, in runs of at most `longest` for a row and a direction: tuples of bank, row, column and direction."""
    requests = []
    while len(requests) < count:
        bank, row, is_write = rng.randrange(_BANKS), rng.choice((5, 5, 9, 4000)), rng.randrange(2)
        requests += ((bank, row, rng.randrange(512), is_write) for _ in range(rng.randint(1, longest)))
    return requests


def _run(multiplexer, settings, requests, gap=0, checked=None):
    """Sends the requests in their order, one per clock, with pauses whose mean is `gap`. The checks are those of the settings `checked`.
    Returns the number of clocks, the memory, and the longest time from a request to its access."""
    controller, memory, rng = _Controller(multiplexer, settings), _Memory(checked or settings), random.Random(5)
    waiting, done = ([[] for _ in range(_BANKS)] for _ in range(2))
    clocks = longest = 0

    def drive():
        nonlocal clocks, longest
        left, pause = list(reversed(requests)), 0
        while (left or any(waiting)) and clocks < 40 * len(requests):
            given = None
            if pause:
                pause -= 1
            elif left and len(waiting[left[-1][0]]) < _PENDING:
                given = left.pop()
                waiting[given[0]].append(clocks)
                pause = rng.randint(0, 2 * gap)
            for number, bank in enumerate(controller.banks):
                yield bank.req.valid.eq(given is not None and given[0] == number)
                if given:
                    yield bank.req.addr.eq(given[1] << settings.geom.colbits | given[2])
                    yield bank.req.we.eq(given[3])
            yield
            clocks += 1
            yield from memory.watch(controller.dfi.phases[0], clocks)
            for times, columns, sent in zip(waiting, memory.columns, done, strict=True):
                if len(columns) > len(sent):
                    sent.append(columns[-1])
                    longest = max(longest, clocks - times.pop(0))

    run_simulation(controller, drive())
    return clocks, memory, longest


_COUNT = 400
# At 40 MHz no time between activations is longer than a clock; at 133 MHz nearly all times are.
_CASES = {"40 MHz": (40e6, {}), "133 MHz": (133e6, {}), "long times": (133e6, {"tRRD": 4, "tFAW": 24, "tCCD": 2})}


@pytest.mark.parametrize("case, gap", (("40 MHz", 0), ("40 MHz", 4), ("133 MHz", 0), ("long times", 0)))
def test_accesses_and_times(case, gap):
    """Compares the accesses to each bank with the requests, checks the times between commands, and compares the number of clocks with
    LiteDRAM's multiplexer."""
    clock, changes = _CASES[case]
    settings = _settings(clock, **changes)
    requests = _requests(random.Random(11), _COUNT)
    clocks, memory, longest = _run(MemoryMultiplexer, settings, requests, gap)
    litedrams, other, _ = _run(Multiplexer, settings, requests, gap)
    expected = [[request[1:] for request in requests if request[0] == bank] for bank in range(_BANKS)]
    for found in (memory, other):
        assert not found.problems[:10]
        assert found.columns == expected
    assert abs(memory.refreshes - clocks // settings.timing.tREFI) <= 1
    assert clocks <= litedrams
    # Each pending request may need a row of its own, and wait for a change of the direction.
    assert longest <= _BANKS * _PENDING * settings.timing.tRC + settings.read_time + settings.write_time


@pytest.mark.parametrize("name, clocks", (("tRRD", 3), ("tFAW", 8), ("tCCD", 1), ("tWTR", 0)))
def test_a_shorter_time_is_detected(name, clocks):
    """Checks the commands of a multiplexer with a shorter time against the correct times."""
    clock, changes = _CASES["long times"]
    shorter = _settings(clock, **changes | {name: clocks})
    _, memory, _ = _run(MemoryMultiplexer, shorter, _requests(random.Random(11), 120, longest=2), checked=_settings(clock, **changes))
    assert memory.problems


def test_a_row_that_waits_gets_its_turn():
    """Checks that continuous requests of one direction for three banks do not starve a bank with a request of the other direction."""
    rng, settings = random.Random(2), _settings(40e6)
    requests = [(rng.randrange(3), 5, rng.randrange(512), 0) for _ in range(300)]
    requests.insert(50, (3, 7, 1, 1))
    _, memory, longest = _run(MemoryMultiplexer, settings, requests)
    assert not memory.problems[:10]
    assert memory.columns[3] == [(7, 1, 1)]
    assert longest <= 2 * settings.read_time + settings.timing.tRFC + settings.timing.tRC

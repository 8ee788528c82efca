"""Tests of parts of the memory controller: compares the bank machine with LiteDRAM's, and checks the refresher's commands."""

import math
import random

import pytest
from litedram.core.bankmachine import BankMachine
from litedram.core.controller import ControllerSettings
from litedram.modules import MT41K64M16
from litedram.phy.model import get_sdram_phy_settings
from migen import Module

from glint_soc.memory_bank import MemoryBank
from glint_soc.memory_refresh import MemoryRefresher
from simulation import run_simulation

_CLOCK = 81.25e6
_ALIGNMENT = 3
_ADDRESS_BITS = 13 + 10 - _ALIGNMENT
_CYCLES = 4000


def _settings():
    module = MT41K64M16(_CLOCK, "1:4")
    settings = ControllerSettings(cmd_buffer_depth=8)
    settings.phy = get_sdram_phy_settings(module.memtype, 16, _CLOCK)
    settings.geom, settings.timing = module.geom_settings, module.timing_settings
    return settings


class _Machine:
    """A bank machine and the log of its accesses. Checks the rows and the timing of its commands."""

    def __init__(self, bank, settings):
        self.bank, self.columns, self.row, self.problems = bank, [], None, []
        timing = settings.timing
        after_write = math.ceil(settings.phy.cwl / settings.phy.nphases) + timing.tWR + timing.tCCD
        self.waits = {("activate", "column"): timing.tRCD, ("activate", "precharge"): timing.tRAS, ("activate", "activate"): timing.tRC,
                      ("precharge", "activate"): timing.tRP, ("write", "precharge"): after_write, ("write", "refresh"): after_write}
        self.last = {}

    def _event(self, name, cycle):
        for (earlier, later), wait in self.waits.items():
            if later == name and cycle - self.last.get(earlier, -99) < wait:
                self.problems.append(f"cycle {cycle}: {name} {cycle - self.last[earlier]} clocks after {earlier}, expected {wait}")
        self.last[name] = cycle

    def watch(self, cycle):
        """Records the command of this clock."""
        cmd, address = self.bank.cmd, (yield self.bank.cmd.a)
        if (yield self.bank.refresh_gnt):
            self._event("refresh", cycle)
            self.row = None
        if not ((yield cmd.valid) and (yield cmd.ready)):
            return
        if (yield cmd.cas):
            self._event("column", cycle)
            is_write = yield cmd.we
            if is_write:
                self.last["write"] = cycle
            self.columns.append((self.row, address & 0x3ff, is_write))
            if address >> 10 & 1: # the memory closes the row after the access
                self.row = None
        elif (yield cmd.we):
            self._event("precharge", cycle)
            self.row = None
        else:
            self._event("activate", cycle)
            if self.row is not None:
                self.problems.append(f"cycle {cycle}: a row is opened while one is open")
            self.row = address


@pytest.mark.parametrize("busy", (0.1, 0.5, 0.9))
def test_a_bank_asks_for_what_litedrams_asks(busy):
    """Sends the same requests, for a few rows, to both bank machines, accepts their commands at the same
    random times, and compares their accesses."""
    rng, settings, top = random.Random(7), _settings(), Module()
    machines = [_Machine(bank(3, _ADDRESS_BITS, _ALIGNMENT, *ranks, settings), settings)
                for bank, ranks in ((MemoryBank, ()), (BankMachine, (1,)))]
    top.submodules += (machine.bank for machine in machines)
    requests, pending = [], 0

    def drive():
        nonlocal pending
        refreshing = 0
        for cycle in range(_CYCLES + 300):
            # At most as many pending requests as the crossbar allows.
            gives = cycle < _CYCLES and rng.random() < busy and pending < 5
            row, column, is_write = rng.choice((5, 5, 5, 9, 4000)), rng.randrange(128), rng.randrange(2)
            if gives:
                requests.append((row, column << _ALIGNMENT, is_write))
            refreshing = max(refreshing - 1, 0) or (cycle < _CYCLES and rng.random() < 0.01) * rng.randint(20, 60)
            ready = rng.random() < 0.7
            for machine in machines:
                bank = machine.bank
                yield bank.req.valid.eq(gives)
                yield bank.req.addr.eq(row << 10 - _ALIGNMENT | column)
                yield bank.req.we.eq(is_write)
                yield bank.refresh_req.eq(refreshing != 0)
                yield bank.cmd.ready.eq(ready)
            yield
            for machine in machines:
                yield from machine.watch(cycle)
            pending = len(requests) - min(len(machine.columns) for machine in machines)

    run_simulation(top, drive())
    for machine in machines:
        assert not machine.problems
        assert machine.columns == requests
    assert len(requests) > 100


def test_refreshes_and_calibrations():
    """Checks the intervals between refreshes, and that there is one calibration per calibration period, although the banks are
    ready at random times."""
    rng, settings = random.Random(3), _settings()
    settings.timing.tREFI = 200
    period = 1500
    refresher = MemoryRefresher(settings, period)
    refreshes, calibrations = [], []

    def drive():
        cmd = refresher.cmd
        for cycle in range(20 * period):
            levels = (yield cmd.ras), (yield cmd.cas), (yield cmd.we)
            if levels == (1, 1, 0):
                refreshes.append(cycle)
            elif levels == (0, 0, 1):
                calibrations.append(cycle)
            yield cmd.ready.eq((yield cmd.valid) and ((yield cmd.ready) or rng.random() < 0.1))
            yield

    run_simulation(refresher, drive())
    assert abs(len(refreshes) - 20 * period // 200) <= 1
    assert abs(len(calibrations) - 20) <= 1
    assert max(b - a for a, b in zip(refreshes, refreshes[1:])) < 200 + 150
    assert all(period - 300 < b - a < period + 300 for a, b in zip(calibrations, calibrations[1:]))

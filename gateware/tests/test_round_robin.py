"""Test of the round-robin arbiter against Migen's, which encodes the turn as a number."""

import random

import pytest
from migen import Module
from migen.genlib import roundrobin

from glint_soc.round_robin import RoundRobin
from simulation import run_simulation


@pytest.mark.parametrize("count", (1, 2, 3, 11))
def test_the_same_turns(count):
    rng, top, turns = random.Random(count), Module(), []
    top.submodules.found, top.submodules.expected = RoundRobin(count), roundrobin.RoundRobin(count, roundrobin.SP_CE)

    def drive():
        for clock in range(1000):
            wants = rng.getrandbits(count) & (rng.getrandbits(count) if clock % 100 < 50 else -1)
            holds = rng.random() < 0.2
            yield top.found.wants.eq(wants)
            yield top.found.holds.eq(holds)
            yield top.expected.request.eq(wants)
            yield top.expected.ce.eq(not holds)
            yield
            turns.append(((yield top.found.turn), 1 << (yield top.expected.grant)))

    run_simulation(top, drive())
    assert [found for found, _ in turns] == [expected for _, expected in turns]
    assert len(set(turns)) == count

"""Compares the tables of square roots, which Yosys computes with real numbers, with integer arithmetic."""

import json
from math import isqrt

from glint_soc import rtl
from resources.tools import BUILD, run_yosys


def _yosys(name, memory):
    """Returns the entries that Yosys computes for the table `memory` of the module `name`."""
    netlist = BUILD / f"{name}.json"
    run_yosys(f"hierarchy -top {name}; proc; memory_collect; write_json {netlist.name}", rtl.sources(name))
    cell = json.loads(netlist.read_text())["modules"][name]["cells"][memory]["parameters"]
    width = int(cell["WIDTH"], 2)
    words = [cell["INIT"][at:at + width] for at in range(0, len(cell["INIT"]), width)]
    return [int(word, 2) for word in reversed(words)]


def test_roots():
    """Checks `ROOTS` of docs/formats/raymarch.md: 18 fraction bits of each entry, and the distance to the next entry."""
    roots = [isqrt(max(i, 128) << 29) for i in range(512)]
    following = [isqrt((max(i, 128) + 1) << 29) for i in range(512)]
    expected = [(root - (1 << 18) << 10) + after - root for root, after in zip(roots, following)]
    assert _yosys("root_table", "entries") == expected


def test_paces():
    """Checks the table of paces of docs/formats/raymarch.md: the root of 32/(i + 1), u3.14, and the squares of i + 1."""
    assert _yosys("ring_lane", "paces") == [isqrt((1 << 33) // (i + 1)) for i in range(128)]
    assert _yosys("ring_lane", "squares") == [(i + 1) ** 2 for i in range(64)]

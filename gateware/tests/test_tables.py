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


def test_round_inverses():
    """Checks `ROUND_INVERSE` of docs/formats/raymarch.md: the root of 2^10/(i + 1), reduced by the fraction 2^-16 of itself, u8.9."""
    expected = [isqrt(((1 << 28) - (1 << 13)) // (i + 1)) for i in range(1024)]
    assert _yosys("round_inverse", "inverses") == expected

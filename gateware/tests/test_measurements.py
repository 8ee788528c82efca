"""Tests of the measurements of cells and clock rates."""

import itertools
import json
import re
from pathlib import Path

import pytest

from resources import paths, route, size
from resources.netlist import Netlist, placement
from resources.tools import ToolError, run_yosys

_SAMPLES = Path(__file__).parent

# Expected numbers for `size_sample.sv`, whose comments explain them.
_SAMPLE = {"logic": 42, "srl": 1, "lutram": 4, "ff": 105, "dsp48": 1, "ramb36": 1, "ramb18": 1, "carry4": 16, "others": {},
           "path": 10, "control_sets": 1, "small_set_ff": 0, "slices": 16}


def test_sample():
    """Checks that the measured size of a module with known cells is correct."""
    found = size.measure_module("size_sample", [_SAMPLES / "size_sample.sv"], "size_sample")
    assert {key: found[key] for key in _SAMPLE} == _SAMPLE


def test_sorting():
    """Checks that cells are sorted by resource, and that unknown cells are reported."""
    cells = {"LUT1": 1, "LUT6": 2, "INV": 4, "SRL16E": 8, "SRLC32E": 16, "RAM32M": 3, "RAM64X1S": 5, "FDRE": 32, "FDPE": 64,
             "FDCE_1": 1, "LDCE": 2, "RAMB18E1": 3, "RAMB36E1": 4, "DSP48E1": 5, "CARRY4": 6, "MUXF7": 7, "$scopeinfo": 8,
             "FDX": 9}
    assert size.sort_cells(cells, {"$scopeinfo"}) == {
        "logic": 7, "srl": 24, "lutram": 17, "ff": 99, "dsp48": 5, "ramb36": 4, "ramb18": 3, "carry4": 6,
        "others": {"FDX": 9, "MUXF7": 7}}
    with pytest.raises(ToolError):
        size.sort_cells({"RAM512X1S": 1})
    with pytest.raises(ToolError):
        size.longest_path("Warning")


def test_placement(tmp_path):
    """Checks the computed control sets, slices and fan-outs of a module with known values."""
    run_yosys("synth_xilinx -family xc7 -top placement_sample -flatten; select placement_sample; "
              "write_json -selected netlist.json", [_SAMPLES / "placement_sample.sv"], tmp_path)
    netlist = Netlist.read(tmp_path / "netlist.json")
    # An unnamed enable may be described by any flip-flop that it controls.
    fan_outs = sorted((re.sub(r"\[\d\]", "", name), loads) for name, loads in netlist.fan_outs(4))
    counts = placement(netlist, 1, 2)
    assert sorted(netlist.control_sets().values()) == [1, 1, 2, 8, 9]
    assert fan_outs == [("CE of eight", 8), ("enable", 10), ("reset", 8), ("shared", 9)]
    assert (counts["control_sets"], counts["small_set_ff"], counts["slices"]) == (5, 4, 6)
    assert placement(netlist, 26, 2)["slices"] == 7, "slices of 26 LUTs"
    assert placement(netlist, 26, 8)["slices"] == 8, "slices of 8 CARRY4"


def test_instances():
    """Checks the number of cells by instance in a netlist of flip-flops, a memory, and LUTs between them."""
    def cell(kind, source, **pins):
        return {"type": kind, "attributes": {"src": source}, "connections": {pin: [bit] for pin, bit in pins.items()},
                "port_directions": {pin: "output" if pin in "OQ" else "input" for pin in pins}}
    def net(source, *bits):
        return {"hide_name": 0, "bits": list(bits), "attributes": {"src": source}}
    part, top = "rtl/part.sv:3.1-4.5|/share/xilinx/ff_map.v:1", "rtl/top.sv:7.1-9.2"
    found = Netlist({
        "cells": {
            "$ff1": cell("FDRE", part, D=2, Q=3), "$ff2": cell("FDRE", part, D=2, Q=4), "$ff3": cell("FDRE", top, D=2, Q=5),
            "$near": cell("LUT2", "", I0=6, O=2), "$far": cell("LUT1", "", I0=5, O=6), "$end": cell("LUT3", "", I0=5, O=7),
            "core.words.0.1": cell("RAM32M", "", D=3, O=8)},
        "netnames": {
            "core.part.q": net("part.sv:2.3-2.4", 3, 4), "core.from_part": net("core.sv:5.6-5.7", 3), "main_bus_q": net(top, 5)},
    })
    counts = {False: {("core", "part"): {"FDRE": 2, "LUT2": 1, "LUT1": 1}, (): {"FDRE": 1, "LUT3": 1}, ("core",): {"RAM32M": 1}}}
    counts[True] = {**counts[False], ("main", "bus"): {"FDRE": 1}, (): {"LUT3": 1}}
    assert {is_flat: found.instances(is_flat) for is_flat in counts} == counts


@pytest.mark.parametrize("signed", [False, True])
@pytest.mark.parametrize(("a", "b", "operand_bits"), [(7, 4, 4), (9, 6, 4), (25, 18, 18), (33, 20, 18)])
def test_products(tmp_path, a, b, operand_bits, signed):
    """Checks that split products, without their registers, equal the products: by proof for multipliers of 4 by 4 bits, and
    at the ends of all ranges and parts for multipliers of 18 by 18 bits."""
    _write_both_products(tmp_path, a, b, operand_bits, signed)
    miter = "read_json both.json; miter -equiv -flatten product split miter;"
    if operand_bits == 4:
        run_yosys(f"{miter} sat -verify -prove trigger 0 miter", (), tmp_path)
        return
    tried = [f"tee -q -a eval.txt eval -set in_a {a}'d{x} -set in_b {b}'d{y} -show trigger miter"
             for x, y in itertools.product(_samples(a), _samples(b))]
    run_yosys("; ".join([miter, *tried]), (), tmp_path)
    assert (tmp_path / "eval.txt").read_text().count("trigger = 1'0.") == len(tried)


def _write_both_products(folder, a, b, operand_bits, signed):
    """Writes a netlist of two modules, a product and the product split into parts, with wires instead of registers."""
    kind = "signed" if signed else "unsigned"
    (folder / "product.sv").write_text(f"module product(input clk, input {kind} [{a - 1}:0] a, input {kind} [{b - 1}:0] b, "
                                       f"output {kind} [{a + b - 1}:0] y);\nassign y = a * b;\nendmodule\n")
    run_yosys("hierarchy -top product; proc; write_json product.json", [folder / "product.sv"], folder)
    whole, split = (json.loads((folder / "product.json").read_text())["modules"]["product"] for _ in range(2))
    route.split_products(split, operand_bits)
    widths = [len(cell["connections"][pin]) for cell in split["cells"].values() if cell["type"] == "$mul" for pin in "AB"]
    assert max(widths) <= operand_bits
    for cell in split["cells"].values():
        if cell["type"] == "$dff":
            d, q = cell["connections"]["D"], cell["connections"]["Q"]
            cell |= {"type": "$pos", "parameters": {"A_SIGNED": 0, "A_WIDTH": len(d), "Y_WIDTH": len(q)},
                     "port_directions": {"A": "input", "Y": "output"}, "connections": {"A": d, "Y": q}}
    (folder / "both.json").write_text(json.dumps({"modules": {"product": whole, "split": split}}))


def _samples(bits):
    """Extreme values of an operand and of its parts."""
    ends = {0, 1, 2, 1 << 16, 1 << 17, 1 << 18, 1 << bits - 1}
    return sorted({(sign * end - less) % (1 << bits) for end in ends for less in (0, 1) for sign in (1, -1)})


def test_path():
    """Checks names, levels and delays of a path from a port to a flip-flop, through a LUT, a wide multiplexer and a carry chain."""
    def part(kind, cell, pins, delay, **more):
        (first, from_pin), (last, to_pin) = zip(cell.split(" "), pins.split(" "))
        return {"type": kind, "from": {"cell": first, "port": from_pin}, "to": {"cell": last, "port": to_pin}, "delay": delay,
                **more}
    def flip_flop(d, q):
        return {"type": "TRELLIS_FF", "port_directions": {"DI": "input", "Q": "output"}, "attributes": {},
                "connections": {"DI": [d], "Q": [q]}}
    def net(*bits):
        return {"hide_name": 0, "bits": list(bits), "attributes": {}}
    netlist = Netlist({
        "cells": {"a_TRELLIS_FF_Q": flip_flop(2, 3), "sum_TRELLIS_FF_Q_1": flip_flop(4, 5), "block.table.0.1":
                  {"type": "DP16KD", "connections": {}}},
        "netnames": {"in_q": net(9, 3), "block.a": net(3), "block.part.sum": net(8, 5), "block.part.sum_TRELLIS_FF_Q_1_DI": net(4)}})
    segments = [
        part("clk-to-q", "a_TRELLIS_FF_Q a_TRELLIS_FF_Q", "Q Q", 0.5),
        part("routing", "a_TRELLIS_FF_Q lut", "Q A", 1.25, net="block.a"),
        part("logic", "lut lut", "A F", 0.25),
        part("routing", "lut lut", "F F1", 0.0, net="inside"),
        part("logic", "lut lut", "F1 OFX", 0.25),
        part("routing", "lut add$CCU2_COMB0", "OFX A", 1.0, net="block.wide"),
        part("logic", "add$CCU2_COMB0 add$CCU2_COMB0", "A FCO", 0.5),
        part("routing", "add$CCU2_COMB0 add$CCU2_COMB1", "FCO FCI", 0.0, net="carry"),
        part("logic", "add$CCU2_COMB1 add$CCU2_COMB1", "FCI F", 0.5),
        part("routing", "add$CCU2_COMB1 sum_TRELLIS_FF_Q_1", "F DI", 0.25, net="block.part.sum_TRELLIS_FF_Q_1_DI"),
        part("setup", "sum_TRELLIS_FF_Q_1 sum_TRELLIS_FF_Q_1", "DI DI", 0.0),
    ]
    assert route.worst_path(segments, netlist) == {
        "from": "port a", "to": "part.sum[1]", "levels": 2, "logic": 2.0, "wire": 2.5,
        "nets": ["a", "wide", "part.sum_TRELLIS_FF_Q_1_DI"]}
    assert route.register(netlist, {"cell": "block.table.0.1$split", "port": "DOA2"}) == "table (block RAM)"


_DELAYS = """
        (INTERCONNECT clock/O first/CLK (900:900:900) (900:900:900))
        (INTERCONNECT first/Q sum/A (0:900:1000) (0:0:0))
        (INTERCONNECT second/Q sum/B (0:0:3000) (0:0:0))
        (INTERCONNECT one/O sum/C (0:0:9000) (0:0:0))
        (INTERCONNECT sum/F third\\$1/DI (0:0:2000) (0:0:0))
        (INTERCONNECT sum/F second/DI (0:0:100) (0:0:0))
    (INSTANCE sum)
        (IOPATH A F (1:1:250) (1:1:250))
        (IOPATH B F (1:1:200) (1:1:200))
        (IOPATH C F (1:1:200) (1:1:200))
    (INSTANCE first)
        (IOPATH CLK Q (400:450:500) (400:450:500))
    (INSTANCE second)
        (IOPATH CLK Q (400:450:500) (400:450:500))
      (SETUPHOLD (posedge DI) (posedge CLK) (0:0:0) (1:2:3))
    (INSTANCE third\\$1)
        (IOPATH CLK Q (400:450:500) (400:450:500))
      (SETUPHOLD (posedge DI) (posedge CLK) (10:20:300) (0:0:0))
"""


def test_slow_paths():
    """Checks that the latest path to an endpoint counts, from the output of a register and including the setup time, and that
    constants are ignored."""
    lines = _DELAYS.splitlines()
    assert paths.groups(lines, 3.7, "{}.{}".format) == [paths.Group("second.Q", "third$1.DI", 1, 6.0), paths.Group("second.Q", "second.DI", 1, 3.8)]
    assert paths.groups(lines, 3.8, lambda *_: "here") == [paths.Group("here", "here", 1, 6.0)]


@pytest.mark.parametrize("name, place", [
    ("cpu.cache.line[3]", "cpu.cache"), ("sum.banks_0 (block RAM)", "sum"), ("bankmachine3_level[2]", "bankmachine*_level"),
    ("rom (block RAM)", "rom"),
])
def test_places(name, place):
    """Checks the instance of a register, and the place of a register in LiteX's flat module."""
    assert route._place(name) == place

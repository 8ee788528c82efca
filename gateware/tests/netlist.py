"""What the cells of a mapped netlist, as Yosys writes it in JSON, say about placement: names of nets, control sets, fan-outs,
slices of a 7-series FPGA."""

import json
import re
from collections import Counter, defaultdict
from math import ceil
from pathlib import Path

from tools import BUILD, TESTS, run_yosys

SLICE_LUTS, SLICE_FLIP_FLOPS = 4, 8
"""Numbers of LUTs and flip-flops in a slice of the 7 series, which has one CARRY4."""

_FLIP_FLOP = re.compile(r"(FD[RSCP]|LD[CP])E(_1)?")
_RESETS = ("R", "S", "CLR", "PRE")

# Pads and clock buffers: the nets on both sides share their names.
_BUFFERS = {"IBUF", "OBUF", "BUFG"}

# Names that Yosys derives from the cells around a net without a name (`autoname`).
_DERIVED = re.compile(r"_(TRELLIS_FF|LUT4|CCU2C|PFUMX|L6MUX21|MULT18X18D|DP16KD|TRELLIS_DPR16X4)_")


class Netlist:
    """One flat module of mapped cells."""

    def __init__(self, module):
        self.cells = module["cells"]
        self._names = defaultdict(list)
        for name, net in module["netnames"].items():
            if net["hide_name"] or _DERIVED.search(name):
                continue
            for index, bit in enumerate(net["bits"]):
                if isinstance(bit, int):
                    indexed = f"{name}[{index + net.get('offset', 0)}]" if len(net["bits"]) > 1 else name
                    self._names[bit].append((indexed, _files(net)))
        for cell in self.cells.values():
            if cell["type"] in _BUFFERS:
                (out,), (into,) = cell["connections"]["O"], cell["connections"]["I"]
                self._names[out] = self._names[into] = self._names[out] + self._names[into]
        self._drivers, self._loads = {}, defaultdict(list)
        for name, cell in self.cells.items():
            for pin in cell["connections"]:
                for bit in _bits(cell, "output", pin):
                    self._drivers[bit] = cell
                for bit in _bits(cell, "input", pin):
                    self._loads[bit].append((pin, name))

    @classmethod
    def read(cls, path):
        """The top module of a file of Yosys."""
        (top,) = (module for module in json.loads(path.read_text())["modules"].values() if "top" in module["attributes"])
        return cls(top)

    def name(self, bit):
        """The name of a net in the source code, or None. Of the names of a net that crosses instances, the one in the file of the
        cell that drives it; otherwise the one of the outermost instance."""
        files = _files(self._drivers[bit]) if bit in self._drivers else set()
        names = self._names.get(bit, ())
        return min((not files & declared, name.count("."), len(name), name) for name, declared in names)[-1] if names else None

    def name_in(self, bit, instance):
        """The shortest name of a net that starts with `instance`, or None."""
        return min((name for name, _ in self._names.get(bit, ()) if name.startswith(instance)), key=len, default=None)

    def described(self, bit):
        """The name of a net; for an unnamed net, a description by a register that it controls."""
        if name := self.name(bit):
            return name
        for pin, cell in self._loads[bit]:
            for output in _bits(self.cells[cell], "output"):
                if name := self.name(output):
                    return f"{pin} of {name}"
        return "without a name"

    def control_sets(self):
        """The number of flip-flops in each control set. The flip-flops of a slice share one set."""
        return Counter(_control_set(cell) for cell in self.cells.values() if _FLIP_FLOP.fullmatch(cell["type"]))

    def fan_outs(self, count):
        """Descriptions and numbers of loads of the nets with the most loads, except clocks."""
        numbers = {bit: len(loads) for bit, loads in self._loads.items()
                   if not any(_is_clock(pin, self.cells[cell]) for pin, cell in loads)}
        return [(self.described(bit), numbers[bit]) for bit in sorted(numbers, key=lambda bit: (-numbers[bit], bit))[:count]]

    def instances(self, is_flat_source=False):
        """The kinds of cells of each instance, counted, by its path: a tuple of names.

        A cell with a name in the source code belongs to the instance around it; any other cell to the instance of the net that
        it drives. Where that net has no name, as between LUTs, the cell belongs to the instance of most of its loads, so what
        several instances share is counted at one. In a flat source, the words of the names of nets stand for instances.
        """
        def path(name):
            *instance, name = name.split(".")
            return tuple(instance) if instance or not is_flat_source else tuple(name.split("_")[:-1])
        owners = {}
        for name, cell in self.cells.items():
            names = [None if name.startswith("$") else re.sub(r"(\.\d+)+$", "", name), *map(self.name, _bits(cell, "output"))]
            if is_flat_source and "." not in (names[0] or "."):
                names.append(names.pop(0) + "_") # a name such as that of a memory or a primitive, all of whose words count
            if own := next(filter(None, names), None):
                owners[name] = path(own)
        waiting = self.cells.keys() - owners.keys()
        while waiting:
            found = {name: votes.most_common(1)[0][0] for name in waiting if (votes := self._load_owners(name, owners))}
            owners |= found or dict.fromkeys(waiting, ())
            waiting -= owners.keys()
        counts = defaultdict(Counter)
        for name, owner in owners.items():
            counts[owner][self.cells[name]["type"]] += 1
        return counts

    def _load_owners(self, name, owners):
        loads = (load for bit in _bits(self.cells[name], "output") for _, load in self._loads[bit])
        return Counter(sorted(owners[load] for load in loads if load in owners))


def placement(netlist, luts, carries):
    """Control sets, slices and fan-outs of a netlist with the given numbers of LUTs and CARRY4, as a dictionary."""
    sets = netlist.control_sets()
    by_sets = sum(ceil(flip_flops / SLICE_FLIP_FLOPS) for flip_flops in sets.values())
    return {"control_sets": len(sets), "small_set_ff": sum(number for number in sets.values() if number < SLICE_FLIP_FLOPS),
            "slices": max(ceil(luts / SLICE_LUTS), by_sets, carries), "fan_outs": netlist.fan_outs(3)}


def _control_set(cell):
    """All that flip-flops of a slice share: nets of clock, enable, and set or reset, how they act, and latch or flip-flop.
    A pin at a constant has no net."""
    kind, (clock, enable, reset) = cell["type"], (_net(cell, *pins) for pins in (("C", "G"), ("CE", "GE"), _RESETS))
    inverted = tuple(sorted(key for key, value in cell["parameters"].items()
                            if re.fullmatch(r"IS_(?!D_)\w+_INVERTED", key) and int(value, 2)))
    return clock, enable, reset, reset and kind[2] in "CP", kind.startswith("LD"), kind.endswith("_1"), inverted


def _net(cell, *pins):
    return next((bit for pin in pins for bit in cell["connections"].get(pin, ()) if isinstance(bit, int)), None)


def _bits(cell, direction, pin=None):
    """The nets at the outputs or the inputs of a cell, or only at a given pin."""
    directions = cell.get("port_directions", {})
    return [bit for each in ([pin] if pin else cell["connections"]) if directions.get(each) == direction
            for bit in cell["connections"][each] if isinstance(bit, int)]


def _is_clock(pin, cell):
    return "CLK" in pin or pin in ("C", "G") and _FLIP_FLOP.fullmatch(cell["type"]) is not None


def _files(thing):
    """Names of the source files of a net or a cell, except Yosys' own files."""
    sources = thing["attributes"].get("src", "").split("|")
    return {Path(source.rpartition(":")[0]).name for source in sources if source and "/share/" not in source}


def check_placement():
    """Checks the computed control sets, slices and fan-outs of a module with known values."""
    folder = BUILD / "placement_sample"
    run_yosys("synth_xilinx -family xc7 -top placement_sample -flatten; select placement_sample; "
              "write_json -selected netlist.json", [TESTS / "placement_sample.sv"], folder)
    netlist = Netlist.read(folder / "netlist.json")
    # An unnamed enable may be described by any flip-flop that it controls.
    fan_outs = sorted((re.sub(r"\[\d\]", "", name), loads) for name, loads in netlist.fan_outs(4))
    counts = placement(netlist, 1, 2)
    expected = [
        ("sets", sorted(netlist.control_sets().values()), [1, 1, 2, 8, 9]),
        ("fan-outs", fan_outs, [("CE of eight", 8), ("enable", 10), ("reset", 8), ("shared", 9)]),
        ("number of sets", counts["control_sets"], 5),
        ("flip-flops in small sets", counts["small_set_ff"], 4),
        ("slices of the sets", counts["slices"], 6),
        ("slices of 26 LUTs", placement(netlist, 26, 2)["slices"], 7),
        ("slices of 8 CARRY4", placement(netlist, 26, 8)["slices"], 8),
    ]
    return [f"{what}: expected {wanted}, got {found}" for what, found, wanted in expected if found != wanted]


def check_instances():
    """Cells of a netlist by instance: flip-flops, a memory, and LUTs between them."""
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
    return [f"flat source {is_flat}: expected {wanted}, got {got}" for is_flat, wanted in counts.items()
            if (got := found.instances(is_flat)) != wanted]


CHECKS = {
    "placement of a module of known flip-flops": check_placement,
    "cells by instance": check_instances,
}

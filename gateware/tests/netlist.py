"""What the cells of a mapped netlist, as Yosys writes it in JSON, say about placement: names of nets, control sets, fan-outs,
slices of a 7-series FPGA."""

import json
import re
from collections import Counter, defaultdict
from math import ceil
from pathlib import Path

from tools import BUILD, TESTS, run_yosys

SLICE_LUTS, SLICE_FLIP_FLOPS = 4, 8
"""What a slice of the 7 series has of each; it has one CARRY4."""

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
    def read(cls, path, top):
        """A module of a file of Yosys."""
        return cls(json.loads(path.read_text())["modules"][top])

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
        """The name of a net; one without a name is described by a register that it controls."""
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
        """Descriptions and loads of the nets with the most loads, without clocks."""
        numbers = {bit: len(loads) for bit, loads in self._loads.items()
                   if not any(_is_clock(pin, self.cells[cell]) for pin, cell in loads)}
        return [(self.described(bit), numbers[bit]) for bit in sorted(numbers, key=lambda bit: (-numbers[bit], bit))[:count]]


def placement(netlist, luts, carries):
    """Control sets, slices and fan-outs of a netlist with so many LUTs and CARRY4, as a dictionary."""
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
    """The nets at the outputs or inputs of a cell, or at one pin if it is one of these."""
    directions = cell.get("port_directions", {})
    return [bit for each in ([pin] if pin else cell["connections"]) if directions.get(each) == direction
            for bit in cell["connections"][each] if isinstance(bit, int)]


def _is_clock(pin, cell):
    return "CLK" in pin or pin in ("C", "G") and _FLIP_FLOP.fullmatch(cell["type"]) is not None


def _files(thing):
    """Names of the source files of a net or a cell, without those of Yosys."""
    sources = thing["attributes"].get("src", "").split("|")
    return {Path(source.rpartition(":")[0]).name for source in sources if source and not source.startswith("/share/")}


def check_placement():
    """Control sets, slices and fan-outs of a module in which they are known."""
    folder = BUILD / "placement_sample"
    run_yosys("synth_xilinx -family xc7 -top placement_sample -flatten; select placement_sample; "
              "write_json -selected netlist.json", [TESTS / "placement_sample.sv"], folder)
    netlist = Netlist.read(folder / "netlist.json", "placement_sample")
    # Of the flip-flops that an enable without a name controls, any may describe it.
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


CHECKS = {
    "placement of a module of known flip-flops": check_placement,
}

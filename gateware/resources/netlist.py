"""Evaluation of a mapped netlist in Yosys' JSON format with regard to placement: names of nets, control sets, fan-outs, and
slices of a 7-series FPGA."""

import json
import re
from collections import Counter, defaultdict
from math import ceil
from pathlib import Path

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
        """Reads the top module from a JSON file of Yosys."""
        (top,) = (module for module in json.loads(path.read_text())["modules"].values() if "top" in module["attributes"])
        return cls(top)

    def name(self, bit):
        """Returns the name of a net in the source code, or None. A net that crosses instances has several names: the name in the
        source file of the driving cell is preferred, then the name in the outermost instance."""
        files = _files(self._drivers[bit]) if bit in self._drivers else set()
        names = self._names.get(bit, ())
        return min((not files & declared, name.count("."), len(name), name) for name, declared in names)[-1] if names else None

    def name_in(self, bit, instance):
        """Returns the shortest name of a net that starts with `instance`, or None."""
        return min((name for name, _ in self._names.get(bit, ()) if name.startswith(instance)), key=len, default=None)

    def described(self, bit):
        """Returns the name of a net; for an unnamed net, a description by a register that the net controls."""
        if name := self.name(bit):
            return name
        for pin, cell in self._loads[bit]:
            for output in _bits(self.cells[cell], "output"):
                if name := self.name(output):
                    return f"{pin} of {name}"
        return "without a name"

    def control_sets(self):
        """Returns the number of flip-flops in each control set. The flip-flops of a slice share one set."""
        return Counter(_control_set(cell) for cell in self.cells.values() if _FLIP_FLOP.fullmatch(cell["type"]))

    def fan_outs(self, count):
        """Returns descriptions and load counts of the `count` nets with the most loads, except clocks."""
        numbers = {bit: len(loads) for bit, loads in self._loads.items()
                   if not any(_is_clock(pin, self.cells[cell]) for pin, cell in loads)}
        return [(self.described(bit), numbers[bit]) for bit in sorted(numbers, key=lambda bit: (-numbers[bit], bit))[:count]]

    def instances(self, is_flat_source=False):
        """Returns the number of cells of each kind for each instance, by the path of the instance, a tuple of names.

        A cell with a name in the source code belongs to the instance around it; any other cell to the instance of the net that
        it drives. If that net has no name, for example between LUTs, the cell belongs to the instance of most of its loads,
        so a cell that several instances share is counted in one of them. In a flat source file, the words of a net's name take the place of
        the path of instances.
        """
        def path(name):
            *instance, name = name.split(".")
            return tuple(instance) if instance or not is_flat_source else tuple(name.split("_")[:-1])
        owners = {}
        for name, cell in self.cells.items():
            names = [None if name.startswith("$") else re.sub(r"(\.\d+)+$", "", name), *map(self.name, _bits(cell, "output"))]
            if is_flat_source and "." not in (names[0] or "."):
                # A memory or a primitive is an instance itself. The "_" keeps `path` from dropping the last word of its name.
                names.append(names.pop(0) + "_")
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
    """Returns control sets, slices and fan-outs of a netlist with the given numbers of LUTs and CARRY4, as a dictionary."""
    sets = netlist.control_sets()
    by_sets = sum(ceil(flip_flops / SLICE_FLIP_FLOPS) for flip_flops in sets.values())
    return {"control_sets": len(sets), "small_set_ff": sum(number for number in sets.values() if number < SLICE_FLIP_FLOPS),
            "slices": max(ceil(luts / SLICE_LUTS), by_sets, carries), "fan_outs": netlist.fan_outs(3)}


def _control_set(cell):
    """Returns the properties that all flip-flops of a slice share: the nets of clock, enable, and set or reset, their
    polarities, synchronous or asynchronous reset, and latch or flip-flop. A pin at a constant has no net."""
    kind, (clock, enable, reset) = cell["type"], (_net(cell, *pins) for pins in (("C", "G"), ("CE", "GE"), _RESETS))
    inverted = tuple(sorted(key for key, value in cell["parameters"].items()
                            if re.fullmatch(r"IS_(?!D_)\w+_INVERTED", key) and int(value, 2)))
    return clock, enable, reset, reset and kind[2] in "CP", kind.startswith("LD"), kind.endswith("_1"), inverted


def _net(cell, *pins):
    return next((bit for pin in pins for bit in cell["connections"].get(pin, ()) if isinstance(bit, int)), None)


def _bits(cell, direction, pin=None):
    """Returns the nets at the outputs or the inputs of a cell, or only at a given pin."""
    directions = cell.get("port_directions", {})
    return [bit for each in ([pin] if pin else cell["connections"]) if directions.get(each) == direction
            for bit in cell["connections"][each] if isinstance(bit, int)]


def _is_clock(pin, cell):
    return "CLK" in pin or pin in ("C", "G") and _FLIP_FLOP.fullmatch(cell["type"]) is not None


def _files(thing):
    """Returns the names of the source files of a net or a cell, except Yosys' own files."""
    sources = thing["attributes"].get("src", "").split("|")
    return {Path(source.rpartition(":")[0]).name for source in sources if source and "/share/" not in source}

"""Resources of a module, or of the SoC, on a 7-series FPGA, by Yosys: no place and route, no vendor tool."""

import json
import re
from importlib.metadata import version

import netlist
import urbana
from glint_soc.urbana_platform import CONTROL_PIN_LOADS
from modules import MODULES
from tools import BUILD, TESTS, YOSYS, ToolError, run_yosys
from verilate.programs import digest, is_current

SOC = "soc"
"""Name of the whole SoC on the Urbana, as `cargo xtask gateware --board urbana` builds it: with the BIOS in its ROM. `soc-SCENE` is the
build for a scene that `cargo xtask resources --scenes` makes beside it."""

_FOLDER = BUILD.parent / "size"

# For each resource, a regular expression for the names of its cells. Cells with any other name are counted per name.
_RESOURCES = {"logic": r"LUT[1-6]|INV", "srl": r"SRL16E|SRLC32E", "lutram": r"RAM\d+[MX]\w*", "ff": r"(FD[RSCP]|LD[CP])E(_1)?",
              "dsp48": r"DSP48E1", "ramb36": r"RAMB36E1", "ramb18": r"RAMB18E1", "carry4": r"CARRY4"}

# Number of LUTs that one cell of each kind of LUT memory takes.
_LUTRAM = {"RAM32M": 4, "RAM64M": 4, "RAM64X1S": 1, "RAM128X1S": 2, "RAM256X1S": 4, "RAM64X1D": 2, "RAM128X1D": 4}

# Marker cells that Yosys leaves in a netlist, and pads and clock buffers that it adds to a top module. Sizes omit these cells, but
# include the pads of the SoC.
_MARKS, _PADS = {"$scopeinfo"}, {"BUFG", "IBUF", "OBUF"}

# Script for Yosys that maps a design, and counts its cells. Enables and resets of few flip-flops are turned into logic, as in the Urbana's
# bitstream: `synth_xilinx` has no option for it, so `dfflegalize` runs between two of its steps, with the flip-flops that `synth_xilinx`
# itself allows there. The script then keeps only the combinational cells between registers and finds the longest path in them. Its command
# `ltp` treats a flip-flop as logic, and lets a path go from the write of a LUT memory to its read. Reads of LUT memories are therefore
# replaced by tables, and all sequential cells are deleted. A LUT memory of an unknown kind would cut a path, so it is an error.
_SCRIPT = """synth_xilinx -family xc7 -top {top} -flatten -run begin:map_ffs;
dfflegalize -mince {loads} -minsrst {loads} -cell $_DFFE_?P?P_ 01 -cell $_SDFFE_?P?P_ 01 -cell $_DLATCH_?P?_ 01;
synth_xilinx -family xc7 -top {top} -flatten -run map_ffs:;
tee -q -o {folder}/cells.json stat -json;
select A:top; write_json -selected {folder}/netlist.json; select -clear;
techmap -map {reads}; opt_clean;
select -assert-none t:RAM32* t:RAM64* t:RAM128* t:RAM256* t:RAM512*;
delete t:* t:LUT* %d t:INV %d t:CARRY4 %d t:MUXF* %d t:$lut %d;
tee -q -o {folder}/path.txt ltp"""


def measure(name):
    """Returns the resources of a block, a variant of one, or the SoC, its longest path in cells, and what its flip-flops and
    nets mean for placement (see `netlist.placement`), as a dictionary.

    The output of Yosys stays in `target/gateware/size/NAME`; `path.txt` there names the cells of the path. A SoC takes minutes, so it
    is measured again only after a change.
    """
    if is_soc(name):
        files = BUILD.parent / f"urbana{name.removeprefix(SOC)}" / "gateware"
        sources = urbana.synthesis_sources(files)
        stamp, result = (_folder(name) / file for file in ("inputs", "result.json"))
        code = [TESTS / file for file in ("size.py", "netlist.py", "tools.py", "lutram_reads.v")]
        inputs = digest([*(files / source for source in sources), *code, *sorted(files.glob("*.init"))], version(YOSYS))
        if not is_current(stamp, inputs, result):
            result.write_text(json.dumps(_measure("glint_urbana", sources, name, _MARKS, files)))
            stamp.write_text(inputs)
        return json.loads(result.read_text())
    module, parameters = build(name)
    return _measure(module.top, module.sources, name, parameters=parameters)


def _folder(name):
    folder = _FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def is_soc(name):
    """Returns whether this is the name of a SoC."""
    return name == SOC or name.startswith(f"{SOC}-")


def build(name):
    """Returns the module and the parameters of a block or of a block's variant."""
    known = {name: (module, parameters) for module in MODULES
             for name, parameters in module.builds().items()}
    if name not in known:
        raise ToolError(f"no block is named {name}; there are: {' '.join(known)} {SOC}")
    return known[name]


def _measure(top, sources, name, ignored=_MARKS | _PADS, cwd=BUILD, parameters=None):
    folder = _folder(name)
    cells, mapped, path, log = (folder / file for file in ("cells.json", "netlist.json", "path.txt", "yosys.log"))
    for result in (cells, mapped, path, log):
        result.unlink(missing_ok=True)
    script = set_parameters(top, parameters or {}) + _SCRIPT.format(
        top=top, loads=CONTROL_PIN_LOADS, folder=folder, reads=TESTS / "lutram_reads.v")
    run_yosys(script, sources, cwd, log)
    stat = json.loads(cells.read_text())
    resources = sort_cells(stat["design"]["num_cells_by_type"], ignored)
    design = netlist.Netlist.read(mapped)
    return {"yosys": stat["creator"].split(" (")[0], **resources, "path": longest_path(path.read_text()),
            **netlist.placement(design, _luts(resources), resources["carry4"]),
            "instances": [_instance(path, kinds) for path, kinds in sorted(design.instances(is_flat_source=is_soc(name)).items())]}


def _instance(path, kinds):
    """Returns the resources of an instance that has these kinds of cells."""
    resources = sort_cells(kinds)
    return {"path": path, "lut": _luts(resources), "ff": resources["ff"], "dsp48": resources["dsp48"],
            "ramb36": resources["ramb36"] + resources["ramb18"] / 2}


def _luts(resources):
    return sum(resources[kind] for kind in ("logic", "srl", "lutram"))


def set_parameters(top, parameters):
    """Returns the Yosys commands that set a module's parameters."""
    return "".join(f"chparam -set {key} {value} {top};\n" for key, value in parameters.items())


def sort_cells(cells, ignored=frozenset()):
    """Sums the cells of a netlist by resource; LUT memories count as the LUTs that they take. Other cells are
    counted by their names, unless ignored."""
    resources, others = dict.fromkeys(_RESOURCES, 0), {}
    for cell, count in sorted(cells.items()):
        resource = next((resource for resource, pattern in _RESOURCES.items() if re.fullmatch(pattern, cell)), None)
        if resource == "lutram":
            if cell not in _LUTRAM:
                raise ToolError(f"{cell}: a LUT memory of unknown size")
            count *= _LUTRAM[cell]
        if resource:
            resources[resource] += count
        elif cell not in ignored:
            others[cell] = count
    return resources | {"others": others}


def longest_path(report):
    """Returns the number of cells on the longest path from the report of Yosys' command `ltp`."""
    found = re.search(r"Longest topological path in \S+ \(length=(\d+)\)", report)
    if not found:
        raise ToolError(f"Yosys found no longest path:\n{report}")
    return int(found[1])


def read(module, parameters):
    """Checks that Yosys can read a module."""
    run_yosys(f"{set_parameters(module.top, parameters)}hierarchy -check -top {module.top}; proc; check -assert", module.sources)


def check_sample():
    """Checks that the measured size of a module with known cells is correct."""
    return _differences(_SAMPLE, _measure("size_sample", [TESTS / "size_sample.sv"], "size_sample"))


def check_sorting():
    """Checks that cells are sorted by resource, and that unknown cells are reported."""
    cells = {"LUT1": 1, "LUT6": 2, "INV": 4, "SRL16E": 8, "SRLC32E": 16, "RAM32M": 3, "RAM64X1S": 5, "FDRE": 32, "FDPE": 64,
             "FDCE_1": 1, "LDCE": 2, "RAMB18E1": 3, "RAMB36E1": 4, "DSP48E1": 5, "CARRY4": 6, "MUXF7": 7, "$scopeinfo": 8,
             "FDX": 9}
    problems = _differences(
        {"logic": 7, "srl": 24, "lutram": 17, "ff": 99, "dsp48": 5, "ramb36": 4, "ramb18": 3, "carry4": 6,
         "others": {"FDX": 9, "MUXF7": 7}}, sort_cells(cells, {"$scopeinfo"}))
    for bad, action in {"RAM512X1S": lambda: sort_cells({"RAM512X1S": 1}), "no path": lambda: longest_path("Warning")}.items():
        try:
            problems.append(f"{bad}: expected an error, got {action()}")
        except ToolError:
            pass
    return problems


def _differences(expected, measured):
    return [f"{key}: expected {value}, got {measured.get(key)}" for key, value in expected.items() if measured.get(key) != value]


# Expected numbers for `size_sample.sv`, which explains them.
_SAMPLE = {"logic": 42, "srl": 1, "lutram": 4, "ff": 105, "dsp48": 1, "ramb36": 1, "ramb18": 1, "carry4": 16, "others": {},
           "path": 10, "control_sets": 1, "small_set_ff": 0, "slices": 16}

CHECKS = {
    "a module of known cells": check_sample,
    "cells sorted": check_sorting,
}

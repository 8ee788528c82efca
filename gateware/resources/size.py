"""Resources of a module, or of the SoC, on a 7-series FPGA, by Yosys, without place and route and without a vendor tool.

`python -m resources.size NAME` prints the resources of a block as JSON.
"""

import json
import re
import sys
from importlib.metadata import version
from pathlib import Path

from glint_soc.urbana_platform import CONTROL_PIN_LOADS
from verilate.programs import digest, is_current

from . import netlist
from .modules import MODULES
from .tools import BUILD, YOSYS, ToolError, run_yosys

SOC = "soc"
"""Name of the whole SoC on the Urbana, as built by `cargo xtask gateware --board urbana`, with the BIOS in its ROM. `soc-SCENE` is the
build for a scene, made by `cargo xtask resources --scenes`."""

_FOLDER = BUILD.parent / "size"
_CODE = [Path(__file__).with_name(name) for name in ("size.py", "netlist.py", "tools.py", "lutram_reads.v")]

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
    """Returns a dictionary with the resources of a block, of a variant of a block, or of the SoC, with its longest path in
    cells, and with the figures of `netlist.placement`.

    The output of Yosys stays in `target/gateware/size/NAME`; `path.txt` there names the cells of the path. A SoC takes minutes, so it
    is measured again only after a change.
    """
    if is_soc(name):
        files = BUILD.parent / f"urbana{name.removeprefix(SOC)}" / "gateware"
        sources = synthesis_sources(files)
        stamp, result = (_folder(name) / file for file in ("inputs", "result.json"))
        inputs = digest([*(files / source for source in sources), *_CODE, *sorted(files.glob("*.init"))], version(YOSYS))
        if not is_current(stamp, inputs, result):
            result.write_text(json.dumps(measure_module("glint_urbana", sources, name, _MARKS, files)))
            stamp.write_text(inputs)
        return json.loads(result.read_text())
    module, parameters = build(name)
    return measure_module(module.top, module.sources, name, parameters=parameters)


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


def measure_module(top, sources, name, ignored=_MARKS | _PADS, cwd=BUILD, parameters=None):
    """Returns the resources of the module `top`, as `measure`."""
    folder = _folder(name)
    cells, mapped, path, log = (folder / file for file in ("cells.json", "netlist.json", "path.txt", "yosys.log"))
    for result in (cells, mapped, path, log):
        result.unlink(missing_ok=True)
    script = set_parameters(top, parameters or {}) + _SCRIPT.format(
        top=top, loads=CONTROL_PIN_LOADS, folder=folder, reads=_CODE[-1])
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


def synthesis_sources(folder):
    """Returns the Verilog files named in the Vivado script in `folder`, in a form that Yosys accepts."""
    verilog, script = folder / "glint_urbana.v", folder / "glint_urbana.tcl"
    for path in (verilog, script):
        if not path.exists():
            raise ToolError(f"{path} is missing; `cargo xtask gateware --board urbana` makes it")
    # LiteX ties the unused outputs of its serializers to 0, which Vivado accepts and Yosys does not.
    open_outputs = folder / "open_outputs.v"
    open_outputs.write_text(re.sub(r"(\.SHIFTOUT\d +)\(1'd0\)", r"\1()", verilog.read_text()))
    sources = [open_outputs if source == verilog.name else source
               for source in re.findall(r"^read_verilog (?:-v )?\{(.+)\}$", script.read_text(), re.M)]
    if open_outputs not in sources:
        raise ToolError(f"{script} does not read {verilog.name}")
    return sources


if __name__ == "__main__":
    print(json.dumps(measure(sys.argv[1])))

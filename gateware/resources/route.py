"""Clock rates of a module by place and route on an ECP5 FPGA, with open tools.

The rate itself says little about a chip of another family. The useful figure is its ratio to the rate of the soft
core, measured by the same tools. A wrapper connects every port of the module to a flip-flop, so that the ports need
no pads, and paths between a port and a register count too:

       serial_in --> [input flip-flops: a shift register] --> module --> [output flip-flops] --> [XOR chain] --> serial_out

An ECP5 multiplies 18 by 18 bits. A product of 25 by 18 bits, one DSP48E1 of the 7 series, takes two multipliers and a wide sum
there, whose delay would hide the relevant paths. Wide products therefore get a register between multipliers and sum
(`split_products`): the netlist then has a different latency, but the paths of a pipeline designed for the ECP5.
"""

import itertools
import json
import re
from collections import Counter
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import pythondata_cpu_vexriscv

from verilate.programs import digest, is_current

from . import machine, paths, size
from .netlist import Netlist
from .tools import BUILD, NEXTPNR, YOSYS, ToolError, run_nextpnr, run_yosys

REFERENCE = "vexriscv"
"""The soft core, in the variant of the SoC. All ratios are relative to the rate of this block."""

SEEDS = (1, 2, 3)
"""Seeds of the placer. The rate of a block is the median over the seeds."""

_FOLDER = BUILD.parent / "route"
_CODE = [Path(__file__).with_name(name) for name in ("route.py", "machine.py", "netlist.py", "tools.py")]
_VEXRISCV = Path(pythondata_cpu_vexriscv.data_location) / "VexRiscv_Full.v"
_DEVICE = ["--85k", "--package", "CABGA381", "--speed", "6", "--freq", "100", "--timing-allow-fail", "--lpf-allow-unconstrained"]
_CLOCK = re.compile(r"(\w+_)?clk(_\w+)?")
_BLOCK = "block." # the module's instance in the wrapper

# Inputs of a cell that do not start a new level of logic: the carry chain, and the multiplexers of wide LUTs.
_JOINED = {"FCI", "F1", "FXA", "FXB"}
_KINDS = {"DP16KD": "block RAM", "TRELLIS_DPR16X4": "LUT memory", "MULT18X18D": "multiplier"}


@dataclass(frozen=True)
class Port:
    """A port of a module in Yosys, which converts packed structs to vectors."""

    name: str
    width: int
    is_input: bool

    @property
    def is_clock(self):
        """Whether the port is a clock, by its name."""
        return self.is_input and self.width == 1 and _CLOCK.fullmatch(self.name) is not None


def measure(name, seeds=SEEDS):
    """Returns a dictionary with the clock rates of a block or of `REFERENCE` for each seed and their median, in MHz, and the
    worst path of the median.

    The output files of all programs remain in `target/gateware/route/NAME`. The result only depends on the inputs and the
    versions of the programs, so a block is measured again only after a change of these.
    """
    folder = _FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    top, sources, parameters = _block(name, folder)
    stamp, result = folder / "inputs", folder / "result.json"
    inputs = digest([*sources, *_CODE], top, parameters, seeds, version(YOSYS), version(NEXTPNR))
    if not is_current(stamp, inputs, result):
        result.write_text(json.dumps(_measure(top, sources, parameters, seeds, folder)))
        stamp.write_text(inputs)
    return json.loads(result.read_text())


def _measure(top, sources, parameters, seeds, folder):
    # Yosys renames a module with parameters, so it is renamed back.
    choose = f"{size.set_parameters(top, parameters)}hierarchy -check -top {top}; rename -top {top};"
    run_yosys(f"{choose} proc; select {top}; write_json -selected ports.json", sources, folder)
    ports = _ports(json.loads((folder / "ports.json").read_text()), top)
    (folder / "wrapper.v").write_text(wrapper(top, ports))
    run_yosys(f"{choose} read_verilog wrapper.v; hierarchy -check -top route_wrapper; proc; flatten; opt; wreduce; "
              "opt_clean; write_json flat.json", sources, folder)
    flat = json.loads((folder / "flat.json").read_text())
    split_products(flat["modules"]["route_wrapper"])
    (folder / "split.json").write_text(json.dumps(flat))
    run_yosys("read_json split.json; synth_ecp5 -top route_wrapper -json netlist.json", (), folder, folder / "yosys.log")
    runs = [_route(folder, seed) for seed in seeds]
    median = sorted(runs, key=lambda run: run["mhz"])[len(runs) // 2]
    return {"nextpnr": version(NEXTPNR), "seeds": [run["mhz"] for run in runs], "mhz": median["mhz"], "seed": median["seed"],
            "path": worst_path(median["path"], Netlist.read(folder / "netlist.json"))}


def _block(name, folder):
    """Returns top module, sources and parameters of a block. The Verilog of a machine is written to `folder`."""
    if name == REFERENCE:
        return "VexRiscv", [_VEXRISCV], {}
    if name in machine.MACHINES:
        return machine.TOP, machine.write(name, folder), {}
    module, parameters = size.build(name)
    return module.top, module.sources, parameters


def _ports(netlist, top):
    (module,) = (body for module, body in netlist["modules"].items() if module == top)
    return [Port(name, len(port["bits"]), port["direction"] == "input") for name, port in module["ports"].items()]


def wrapper(top, ports):
    """Returns the Verilog of the wrapper of a module. The module's clock `sys_clk`, or otherwise its first clock, drives the
    flip-flops of all ports. Paths between two clocks are not measured, so ports of another clock do not affect the rate."""
    clocks = sorted((port for port in ports if port.is_clock), key=lambda port: port.name != "sys_clk")
    inputs = [port for port in ports if port.is_input and not port.is_clock]
    outputs = [port for port in ports if not port.is_input]
    if not clocks or not outputs:
        raise ToolError(f"{top}: expected a clock and an output, got the ports {' '.join(port.name for port in ports)}")
    clock = clocks[0].name
    bits_in, bits_out = (max(1, sum(port.width for port in group)) for group in (inputs, outputs))
    connections = [f".{port.name}({port.name})" for port in clocks]
    for group, vector in ((inputs, "in_q"), (outputs, "out_d")):
        low = 0
        for port in group:
            connections.append(f".{port.name}({vector}[{low} +: {port.width}])")
            low += port.width
    return f"""module route_wrapper(input {', input '.join(port.name for port in clocks)}, input serial_in, output serial_out);
reg [{bits_in - 1}:0] in_q;
reg [{bits_out - 1}:0] out_q, chain;
wire [{bits_out - 1}:0] out_d;
always @(posedge {clock}) begin
    in_q <= {{in_q, serial_in}};
    out_q <= out_d;
    chain <= out_q ^ {{chain, chain[{bits_out - 1}]}};
end
assign serial_out = chain[{bits_out - 1}];
{top} block({', '.join(connections)});
endmodule
"""


def split_products(module, operand_bits=18):
    """Replaces each product with an operand of more than `operand_bits` bits, in a flat netlist, by products that fit, a register after
    each of these products, and the sum of the registers. The clock of the registers is the first port of the wrapper."""
    clock = next(iter(module["ports"].values()))["bits"][0]
    wires = itertools.count(1 + max(bit for net in module["netnames"].values() for bit in net["bits"] if isinstance(bit, int)))
    for name, cell in list(module["cells"].items()):
        if cell["type"] != "$mul" or max(_number(cell, "A_WIDTH"), _number(cell, "B_WIDTH")) <= operand_bits:
            continue
        del module["cells"][name]
        output, signed = cell["connections"]["Y"], _number(cell, "A_SIGNED")
        terms = []
        for (a_at, a), (b_at, b) in itertools.product(_chunks(cell["connections"]["A"], signed, operand_bits),
                                                      _chunks(cell["connections"]["B"], signed, operand_bits)):
            at = a_at + b_at
            if at >= len(output):
                continue
            product, kept = ([next(wires) for _ in range(min(len(output) - at, len(a) + len(b)))] for _ in range(2))
            module["cells"][f"{name}.product_{a_at}_{b_at}"] = _cell("$mul", signed, A=a, B=b, Y=product)
            module["cells"][f"{name}.register_{a_at}_{b_at}"] = {
                "type": "$dff", "parameters": {"CLK_POLARITY": 1, "WIDTH": len(kept)}, "attributes": {},
                "port_directions": {"CLK": "input", "D": "input", "Q": "output"},
                "connections": {"CLK": [clock], "D": product, "Q": kept}}
            top = [kept[-1] if signed else "0"] * len(output)
            terms.append((["0"] * at + kept + top)[:len(output)])
        while terms:
            total = output if len(terms) <= 2 else [next(wires) for _ in output]
            first, second = terms.pop(), terms.pop() if terms else ["0"] * len(output)
            module["cells"][f"{name}.sum_{len(terms)}"] = _cell("$add", 0, A=first, B=second, Y=total)
            if total is not output:
                terms.append(total)


def _chunks(bits, signed, operand_bits):
    """Yields the parts of an operand, each with the position of its lowest bit. The parts of a signed operand are signed."""
    size = operand_bits - 1 if signed else operand_bits
    for at in range(0, len(bits), size):
        is_last = len(bits) - at <= operand_bits
        part = bits[at:] if is_last else bits[at:at + size] + (["0"] if signed else [])
        yield at, part
        if is_last:
            return


def _cell(kind, signed, **connections):
    """Returns an arithmetic cell in Yosys' JSON format."""
    parameters = {f"{port}_WIDTH": len(bits) for port, bits in connections.items()}
    return {"type": kind, "parameters": parameters | {"A_SIGNED": signed, "B_SIGNED": signed}, "attributes": {},
            "port_directions": {"A": "input", "B": "input", "Y": "output"}, "connections": connections}


def _number(cell, parameter):
    """Returns a parameter of a cell as a number: Yosys writes it in binary digits."""
    return int(cell["parameters"][parameter], 2)


def _route(folder, seed):
    """Runs place and route; returns the rate of the slowest clock in MHz, and its critical path."""
    report = folder / f"report-{seed}.json"
    report.unlink(missing_ok=True)
    run_nextpnr(*_DEVICE, "-q", "--json", "netlist.json", "--seed", seed, "--report", report.name,
                "--sdf", _delays(folder, seed).name, "--log", f"nextpnr-{seed}.log", cwd=folder)
    result = json.loads(report.read_text())
    clock, rate = min(result["fmax"].items(), key=lambda entry: entry[1]["achieved"])
    (path,) = (path["path"] for path in result["critical_paths"] if path["from"] == path["to"] == f"posedge {clock}")
    return {"mhz": round(rate["achieved"], 1), "seed": seed, "path": path}


def _delays(folder, seed):
    """Returns the path of the SDF file with the delays for a seed."""
    return folder / f"delays-{seed}.sdf"


def slow_paths(name, mhz):
    """Returns the groups of the paths (`paths.groups`) of a measured block that are too slow for a clock of `mhz`, in the placement
    with the median rate."""
    folder = _FOLDER / name
    netlist = Netlist.read(folder / "netlist.json")
    seed = json.loads((folder / "result.json").read_text())["seed"]

    def place(cell, pin):
        return _place(register(netlist, {"cell": cell, "port": pin}))

    with _delays(folder, seed).open() as sdf:
        return [vars(group) for group in paths.groups(sdf, 1000 / mhz, place)]


def _place(name):
    """Returns the instance that contains a register. LiteX writes one flat module: for its registers, the name without its numbers
    replaces the instance."""
    name = re.sub(r"(\[\d+\])+| \(.*\)$", "", name)
    instance, dot, _ = name.rpartition(".")
    return instance if dot else re.sub(r"\d+", "*", name)


def worst_path(segments, netlist):
    """Returns a path of nextpnr's report: the registers at its ends, the nets between them, the number of logic levels, and
    the delays in logic and in wires in ns. A carry chain is one level, and so is a LUT with the multiplexers that combine it
    with other LUTs."""
    delays = Counter()
    for part in segments:
        delays["wire" if part["type"] == "routing" else "logic"] += part["delay"]
    levels = sum(part["type"] == "logic" and part["from"]["port"] not in _JOINED for part in segments)
    nets = [part["net"] for part in segments if part["type"] == "routing" and part["to"]["port"] not in _JOINED]
    return {"from": register(netlist, segments[0]["from"]), "to": register(netlist, segments[-1]["to"]), "levels": levels,
            **{kind: round(delay, 2) for kind, delay in sorted(delays.items())}, "nets": [_short(net) for net in nets]}


def register(netlist, end):
    """Returns the name of a register at an end of a path. A flip-flop of the wrapper is named by the module's port."""
    name = end["cell"]
    while name not in netlist.cells and "$" in name: # nextpnr appends a suffix to the names of cells that it splits
        name = name.rpartition("$")[0]
    cell = netlist.cells.get(name, {"type": "", "connections": {}})
    if cell["type"] != "TRELLIS_FF":
        return f"{_short(re.sub(r'([.][0-9]+)+$', '', name))} ({_KINDS.get(cell['type'], end['port'])})"
    (q,), (d,) = cell["connections"]["Q"], cell["connections"]["DI"]
    name = netlist.name(q) or name
    if name.startswith("in_q"):
        return "port " + _short(netlist.name_in(q, _BLOCK) or name)
    if name.startswith("out_q"):
        return "port " + _short(netlist.name_in(d, _BLOCK) or name)
    return _short(name)


def _short(name):
    return name.removeprefix(_BLOCK)

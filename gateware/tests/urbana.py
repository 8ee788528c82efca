"""Checks the generated files of the Urbana board against facts that were recorded independently of its platform file."""

import math
import re
from collections import Counter

from litex.soc.integration.builder import Builder

from glint_soc import register_map
from glint_soc.register_map import OPTIONAL_BLOCKS
from glint_soc.urbana import UrbanaSoC
from glint_soc.virtual import VirtualSoC

import boards
from tools import BUILD, TESTS, ToolError, run_yosys

_OUTPUT = BUILD / "urbana"
_GATEWARE = _OUTPUT / "gateware"
_PINS = TESTS / "urbana_pins.csv"

# Clocks that the FPGA's MMCMs and PLLs must generate exactly, for each system clock in MHz: frequency in MHz and phase in degrees.
_CLOCKS = {
    81.25: Counter({(81.25, 0): 1, (325.0, 0): 1, (325.0, 90): 1, (200.0, 0): 1, (74.25, 0): 1, (371.25, 0): 1}),
    100: Counter({(100.0, 0): 1, (400.0, 0): 1, (400.0, 90): 1, (200.0, 0): 1, (74.25, 0): 1, (371.25, 0): 1}),
}

# Constants for a system clock of 100 MHz: 115200 baud as a fraction of 2^32, and the number of clocks per third of an I2C bit.
_NUMBERS_100_MHZ = ["23'd4947802", ".PHASE    (7'd84)"]

# Number of 100 MHz clocks between two refreshes of the memory: 64 ms for 8192 rows, rounded up.
_REFRESH_100_MHZ = 782

_CONSTRAINTS = [
    "create_clock -name clk100 -period 10.0 [get_ports clk100]",
    "set_property INTERNAL_VREF 0.675 [get_iobanks 34]",
    "set_property CFGBVS VCCO [current_design]",
    "set_property CONFIG_VOLTAGE 3.3 [current_design]",
    "set_property BITSTREAM.CONFIG.SPI_BUSWIDTH 4 [current_design]",
    "set_property BITSTREAM.CONFIG.CONFIGRATE 33 [current_design]",
    "set_clock_groups -group [get_clocks -include_generated_clocks -of [get_nets sys_clk]] "
    "-group [get_clocks -include_generated_clocks -of [get_nets pix_clk]] -asynchronous",
]


def generate():
    """Elaborates the board (no BIOS, no vendor tool) and returns its XDC, Verilog and Vivado script as text."""
    return _elaborate(UrbanaSoC(build_id=0, blocks=OPTIONAL_BLOCKS), _OUTPUT)


def _elaborate(soc, output):
    Builder(soc, output_dir=str(output), compile_software=False, compile_gateware=False).build()
    return tuple((output / "gateware" / f"glint_urbana.{kind}").read_text() for kind in ("xdc", "v", "tcl"))


def check_pins(xdc, verilog, _script):
    """Checks that the ports of the design have exactly the pins and properties of urbana_pins.csv, and no pin is used twice."""
    found = {}
    for key, value, port in re.findall(r"^set_property (\S+) (\S+) \[get_ports \{(.+)\}\]$", xdc, re.M):
        found.setdefault(port, {})[key] = value
    return boards.check_pins(found, _PINS, boards.ports(verilog, "glint_urbana"))


def check_constraints(xdc, _verilog, script):
    """Checks that input clock, clock groups and configuration are constrained, and that the script contains part and sources."""
    problems = [f"not in the XDC: {line}" for line in _CONSTRAINTS if line not in xdc.splitlines()]
    for word in ("-part xc7s50csga324-1", "scanout.sv", "read_xdc glint_urbana.xdc", "write_bitstream",
                 "synth_design -directive default -control_set_opt_threshold 4 "):
        if word not in script:
            problems.append(f"not in the Vivado script: {word}")
    return problems


def check_clocks(_xdc, verilog, _script, megahertz=81.25):
    """Checks that the MMCMs and PLLs give exactly the clocks in `_CLOCKS`, with parameters in the range of the FPGA."""
    problems, expected = [], _CLOCKS[megahertz]
    found = Counter()
    for kind, text in re.findall(r"^(MMCME2_ADV|PLLE2_ADV) #\((.*?)^\) ", verilog, re.M | re.S):
        parameters = {name: float(value) for name, value in
                      re.findall(r"\.(\w+)\s+\((?:\d+'d)?([\d.]+)\)", text)}
        multiplier = parameters.get("CLKFBOUT_MULT_F", parameters.get("CLKFBOUT_MULT"))
        vco = 1e3 / parameters["CLKIN1_PERIOD"] / parameters["DIVCLK_DIVIDE"] * multiplier
        low, high = (600, 1200) if kind == "MMCME2_ADV" else (800, 1600)
        if not low <= vco <= high:
            problems.append(f"{kind} runs at {vco} MHz, outside {low} to {high}")
        if not math.isclose(multiplier * 8, round(multiplier * 8)):
            problems.append(f"{kind}: {multiplier} is not a multiple of 1/8")
        for name, divide in parameters.items():
            if output := re.fullmatch(r"CLKOUT(\d)_DIVIDE(_F)?", name):
                found[vco / divide, int(parameters[f"CLKOUT{output[1]}_PHASE"])] += 1
    if found != expected:
        problems.append(f"expected the clocks (MHz, phase) {sorted(expected)}, got {sorted(found.elements())}")
    return problems


def check_100_mhz(*_files):
    """Checks that all constants that depend on the system clock match its frequency, on both boards."""
    urbana, virtual = (board(build_id=0, blocks=OPTIONAL_BLOCKS, sys_clk_freq=100e6) for board in (UrbanaSoC, VirtualSoC))
    files = _elaborate(urbana, _OUTPUT.with_name("urbana_100_mhz"))
    virtual.finalize()
    problems = check_clocks(*files, megahertz=100)
    problems += [f"{number} is not in the Verilog" for number in _NUMBERS_100_MHZ if number not in files[1]]
    for soc in urbana, virtual:
        name, refresh = type(soc).__name__, soc.sdram.controller.settings.timing.tREFI
        if refresh != _REFRESH_100_MHZ:
            problems.append(f"{name}: a refresh every {refresh} clocks")
        stated = soc.constants["CONFIG_CLOCK_FREQUENCY"], soc.identity.clock.status.reset.value
        if stated != (100_000_000, 100_000_000):
            problems.append(f"{name}: the BIOS has {stated[0]} Hz, the identity {stated[1]} Hz")
    return problems


def check_complete(_xdc, _verilog, _script, folder=_GATEWARE):
    """Checks that each instantiated module, or primitive of the FPGA, exists and has the connected ports."""
    run_yosys("read_verilog -lib +/xilinx/cells_sim.v +/xilinx/cells_xtra.v; hierarchy -check -top glint_urbana",
              synthesis_sources(folder), folder=folder) # The folder with the memory images.
    return []


def check_fields_alone(*files):
    """Checks the build with the raymarcher and without triangles: it is complete, has the registers of the full build, the bit of
    each block that was asked for, and four memory ports: of CPU and scan-out, and two for frames."""
    output, full = _OUTPUT.with_name("urbana_fields_alone"), VirtualSoC(build_id=0, blocks=OPTIONAL_BLOCKS)
    soc = UrbanaSoC(build_id=0, blocks=("scanout", "raymarch"))
    _elaborate(soc, output)
    full.finalize()
    register_map.check_subset(soc, full)
    found = {"blocks": soc.identity.blocks.status.reset.value, "memory ports": len(soc.sdram.crossbar.masters)}
    expected = {"blocks": 0b101, "memory ports": 4}
    return check_complete(*files, folder=output / "gateware") + [
        f"{name}: expected {expected[name]}, got {number}" for name, number in found.items() if number != expected[name]]


def synthesis_sources(folder):
    """Returns the Verilog files named in the Vivado script in `folder`, in a form that Yosys accepts."""
    verilog, script = folder / "glint_urbana.v", folder / "glint_urbana.tcl"
    for path in (verilog, script):
        if not path.exists():
            raise ToolError(f"{path} is missing; `cargo xtask gateware --board urbana` makes it")
    # LiteX ties the unused outputs of its serializers to 0, which Vivado accepts and Yosys does not.
    open_outputs = folder / "open_outputs.v"
    open_outputs.write_text(re.sub(r"(\.SHIFTOUT\d +)\(1'd0\)", r"\1()", verilog.read_text()))
    sources = [open_outputs if source.endswith(f"/{verilog.name}") else source
               for source in re.findall(r"^read_verilog (?:-v )?\{(.+)\}$", script.read_text(), re.M)]
    if open_outputs not in sources:
        raise ToolError(f"{script} does not read {verilog.name}")
    return sources


CHECKS = {
    "pins as in the table, both ways": check_pins,
    "constraints and script": check_constraints,
    "clocks exact": check_clocks,
    "100 MHz": check_100_mhz,
    "design complete": check_complete,
    "fields alone": check_fields_alone,
}

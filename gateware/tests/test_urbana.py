"""Checks the generated files of the Urbana board against facts that were recorded independently of its platform file."""

import math
import re
import shutil
import tkinter
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import pytest
from litex.soc.integration.builder import Builder

from glint_soc import register_map
from glint_soc.register_map import OPTIONAL_BLOCKS
from glint_soc.urbana import UrbanaSoC
from glint_soc.urbana_platform import SOURCES, VIVADO
from glint_soc.virtual import VirtualSoC

import boards
from resources.size import synthesis_sources
from resources.tools import BUILD, run_yosys

_OUTPUT = BUILD / "urbana"
_GATEWARE = _OUTPUT / "gateware"
_PINS = Path(__file__).with_name("urbana_pins.csv")

pytestmark = pytest.mark.xdist_group("urbana")

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


@pytest.fixture(scope="module", name="board")
def _board():
    """The board elaborated (no BIOS, no vendor tool): its XDC, Verilog and Vivado script as text."""
    return _elaborate(UrbanaSoC(build_id=0, blocks=OPTIONAL_BLOCKS), _OUTPUT)


def _elaborate(soc, output):
    Builder(soc, output_dir=str(output), compile_software=False, compile_gateware=False).build()
    return SimpleNamespace(**{kind: (output / "gateware" / f"glint_urbana.{kind}").read_text() for kind in ("xdc", "v", "tcl")})


def test_pins(board):
    """Checks that the ports of the design have exactly the pins and properties of urbana_pins.csv, and no pin is used twice."""
    found = {}
    for key, value, port in re.findall(r"^set_property (\S+) (\S+) \[get_ports \{(.+)\}\]$", board.xdc, re.M):
        found.setdefault(port, {})[key] = value
    boards.check_pins(found, _PINS, boards.ports(board.v, "glint_urbana"))


def test_constraints(board):
    """Checks that input clock, clock groups and configuration are constrained, and that the script contains part and sources."""
    assert set(_CONSTRAINTS) <= set(board.xdc.splitlines())
    words = ("-part xc7s50csga324-1", "scanout.sv", "read_xdc glint_urbana.xdc", "write_bitstream",
             "synth_design -directive default -control_set_opt_threshold 4 ")
    assert [word for word in words if word not in board.tcl] == []


# The Vivado commands of the script, as procedures that record their arguments in `calls` and read their files from the script's folder.
# `$version` is Vivado's version, `$timing` the text of the timing report.
_VIVADO = """set calls {}
proc version {option} {return $::version}
proc report_timing_summary {args} {if {"-return_string" in $args} {return $::timing}}
proc read_verilog {args} {lappend ::calls "read [lindex $args end]"; close [open [lindex $args end]]}
proc read_xdc {path} {close [open $path]}
proc write_bitstream {args} {lappend ::calls write_bitstream; close [open [lindex $args end] w]}
proc puts {args} {lappend ::calls "says [lindex $args end]"}
proc exit {status} {lappend ::calls "exit $status"; error exited}
proc quit {} {}
proc unknown {args} {}
"""


def _run_script(folder, version, timing):
    """Runs the Vivado script in `folder` with procedures in place of Vivado's commands. Returns the calls in `_VIVADO`."""
    interpreter = tkinter.Tcl()
    interpreter.setvar("version", version)
    interpreter.setvar("timing", timing)
    interpreter.eval(_VIVADO)
    try:
        interpreter.eval(f"cd {{{folder}}}; source glint_urbana.tcl")
    except tkinter.TclError as error:
        assert str(error) == "exited"
    return interpreter.splitlist(interpreter.getvar("calls"))


_MET, _MISSED = "...\nAll user specified timing constraints are met.\n", "...\nTiming constraints are not met.\n"


@pytest.mark.usefixtures("board")
def test_script_in_another_folder(tmp_path, monkeypatch):
    """Checks that a copy of the folder contains all files that the script reads, and that the script writes a bitstream if the timing
    is met."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "moved"
    shutil.copytree(_GATEWARE, folder)
    calls = _run_script(folder, VIVADO, _MET)
    read = [call.removeprefix("read ") for call in calls if call.startswith("read ")]
    assert "glint_urbana.v" in read and f"{SOURCES}/scanout.sv" in read
    assert [path for path in read if Path(path).is_absolute()] == []
    for text in (folder / name for name in ("glint_urbana.tcl", "glint_urbana.v", "glint_urbana.xdc")):
        assert str(_GATEWARE.parents[2]) not in text.read_text(), text.name
    assert calls[-1] == "write_bitstream"
    assert (folder / "glint_urbana.bit").exists()


@pytest.mark.parametrize("version, timing, message", [
    ("2024.2", _MISSED, "glint_urbana: Vivado 2024.2 does not meet the timing, see glint_urbana_timing.rpt: no bitstream is written"),
    ("2019.2.1", _MET, f"glint_urbana: Vivado 2019.2.1: expected {VIVADO} or newer"),
])
@pytest.mark.usefixtures("board")
def test_script_fails_without_a_bitstream(tmp_path, monkeypatch, version, timing, message):
    """Checks that the script fails with a message and leaves no bitstream if the timing is not met, or for an old Vivado."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "built"
    shutil.copytree(_GATEWARE, folder)
    if timing == _MISSED:
        # An earlier build has left a bitstream.
        (folder / "glint_urbana.bit").touch()
    calls = _run_script(folder, version, timing)
    assert calls[-2:] == (f"says {message}", "exit 1")
    assert "write_bitstream" not in calls
    assert not (folder / "glint_urbana.bit").exists()


def test_clock_pin(board):
    """Checks that the clock pin reaches the MMCMs and the PLL, which are not all in its clock region, through a global buffer."""
    wires = dict(re.findall(r"^assign (\w+) = (\w+);$", board.v, re.M))
    instances = re.findall(r"^(\w+) (?:#\(.*?^\) )?\w+\s*\((.*?)^\);", board.v, re.M | re.S)
    pins = [(kind, {pin: _source(wires, net) for pin, net in re.findall(r"\.(\w+)\s*\((\w+)\)", text)}) for kind, text in instances]
    buffered = [pins["O"] for kind, pins in pins if kind == "BUFG" and pins["I"] == "clk100"]
    inputs = [pins["CLKIN1"] for kind, pins in pins if kind in ("MMCME2_ADV", "PLLE2_ADV")]
    assert len(buffered) == 1
    assert inputs == 3 * buffered


def _source(wires, net):
    """Returns the net that drives `net` through assignments."""
    while net in wires:
        net = wires[net]
    return net


def test_clocks(board, megahertz=81.25):
    """Checks that the MMCMs and PLLs give exactly the clocks in `_CLOCKS`, with parameters in the range of the FPGA."""
    found = Counter()
    for kind, text in re.findall(r"^(MMCME2_ADV|PLLE2_ADV) #\((.*?)^\) ", board.v, re.M | re.S):
        parameters = {name: float(value) for name, value in
                      re.findall(r"\.(\w+)\s+\((?:\d+'d)?([\d.]+)\)", text)}
        multiplier = parameters.get("CLKFBOUT_MULT_F", parameters.get("CLKFBOUT_MULT"))
        vco = 1e3 / parameters["CLKIN1_PERIOD"] / parameters["DIVCLK_DIVIDE"] * multiplier
        low, high = (600, 1200) if kind == "MMCME2_ADV" else (800, 1600)
        assert low <= vco <= high, f"MHz of a {kind}"
        assert math.isclose(multiplier * 8, round(multiplier * 8)), f"eighths of a {kind}"
        for name, divide in parameters.items():
            if output := re.fullmatch(r"CLKOUT(\d)_DIVIDE(_F)?", name):
                found[vco / divide, int(parameters[f"CLKOUT{output[1]}_PHASE"])] += 1
    assert found == _CLOCKS[megahertz]


def test_100_mhz():
    """Checks that all constants that depend on the system clock match its frequency, on both boards."""
    urbana, virtual = (board(build_id=0, blocks=OPTIONAL_BLOCKS, sys_clk_freq=100e6) for board in (UrbanaSoC, VirtualSoC))
    board = _elaborate(urbana, _OUTPUT.with_name("urbana_100_mhz"))
    virtual.finalize()
    test_clocks(board, megahertz=100)
    assert [number for number in _NUMBERS_100_MHZ if number not in board.v] == []
    for soc in urbana, virtual:
        assert soc.sdram.controller.settings.timing.tREFI == _REFRESH_100_MHZ
        assert soc.constants["CONFIG_CLOCK_FREQUENCY"] == 100_000_000
        assert soc.identity.clock.status.reset.value == 100_000_000


@pytest.mark.usefixtures("board")
def test_complete():
    """Checks that each instantiated module, or primitive of the FPGA, exists and has the connected ports."""
    _check_complete(_GATEWARE)


def _check_complete(folder):
    run_yosys("read_verilog -lib +/xilinx/cells_sim.v +/xilinx/cells_xtra.v; hierarchy -check -top glint_urbana",
              synthesis_sources(folder), folder=folder) # The folder with the memory images.


def test_fields_alone():
    """Checks the build with the raymarcher and without triangles: it is complete, has the registers of the full build, the enable
    bits of the selected blocks, and four memory ports: one for the CPU, one for scan-out, and two for frames."""
    output, full = _OUTPUT.with_name("urbana_fields_alone"), VirtualSoC(build_id=0, blocks=OPTIONAL_BLOCKS)
    soc = UrbanaSoC(build_id=0, blocks=("scanout", "raymarch"))
    _elaborate(soc, output)
    full.finalize()
    register_map.check_subset(soc, full)
    _check_complete(output / "gateware")
    assert soc.identity.blocks.status.reset.value == 0b101
    assert len(soc.sdram.crossbar.masters) == 4, "memory ports"

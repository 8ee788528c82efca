"""Checks the generated files of the Urbana board against facts that were recorded independently of its platform file."""

import math
import re
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import pytest
from litex.soc.integration.builder import Builder

from glint_soc import register_map
from glint_soc.register_map import OPTIONAL_BLOCKS
from glint_soc.urbana import UrbanaSoC
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
    """Checks the build with the raymarcher and without triangles: it is complete, has the registers of the full build, the bit of
    each block that was asked for, and four memory ports: of CPU and scan-out, and two for frames."""
    output, full = _OUTPUT.with_name("urbana_fields_alone"), VirtualSoC(build_id=0, blocks=OPTIONAL_BLOCKS)
    soc = UrbanaSoC(build_id=0, blocks=("scanout", "raymarch"))
    _elaborate(soc, output)
    full.finalize()
    register_map.check_subset(soc, full)
    _check_complete(output / "gateware")
    assert soc.identity.blocks.status.reset.value == 0b101
    assert len(soc.sdram.crossbar.masters) == 4, "memory ports"

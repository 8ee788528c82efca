"""The RealDigital Urbana (XC7S50-1CSGA324): pins, the Vivado script, and programming."""

import shutil
from pathlib import Path

from litex.build.generic_platform import IOStandard, Misc, Pins, Subsignal
from litex.build.openfpgaloader import OpenFPGALoader
from litex.build.xilinx import Xilinx7SeriesPlatform
from litex.build.xilinx.vivado import XilinxVivadoToolchain

CONTROL_PIN_LOADS = 5
"""Smallest number of flip-flops whose enable or synchronous reset uses the control pins. For fewer flip-flops the synthesis
implements it in LUTs, because each combination of clock, enable and reset needs its own slices of eight flip-flops."""

# Bank 35 contains the buttons and switches, and a differential pair that the board uses as LVDS_25, so the
# supply voltage of the bank is 2.5 V.
_BANK_35 = IOStandard("LVCMOS25")

_io = [
    ("clk100", 0, Pins("N15"), IOStandard("LVCMOS33")),

    ("buttons", 0, Pins("J2 J1 G2 H2"), _BANK_35),
    ("switches", 0, Pins("G1 F2 F1 E2 E1 D2 D1 C2 B2 A4 A5 A6 C7 A7 B7 A8"), _BANK_35),
    ("leds", 0, Pins("C13 C14 D14 D15 D16 F18 E17 D17 C17 B18 A17 B17 C18 D18 E18 G17"), IOStandard("LVCMOS33")),

    # The vendor's displays D0 and D1: digits from left to right, segments a to g and the point.
    ("digits", 0,
        Subsignal("left_digits_n", Pins("G6 H6 C3 B3")),
        Subsignal("left_segments_n", Pins("E6 B4 D5 C5 D7 D6 C4 B5")),
        Subsignal("right_digits_n", Pins("E4 E3 F5 H5")),
        Subsignal("right_segments_n", Pins("F3 G5 J3 H4 F4 H3 E5 J4")),
        _BANK_35),

    # `rx` and `tx` are named from the FPGA's side. The vendor's constraint file names them from the side of the USB bridge.
    ("serial", 0,
        Subsignal("rx", Pins("B16")),
        Subsignal("tx", Pins("A16")),
        IOStandard("LVCMOS33")),

    # An external MPU-6050 motion sensor at PMOD B, pins 2 and 3. Its module has pull-up resistors; the pull-ups of the FPGA keep
    # the bus idle while no module is connected.
    ("i2c", 0,
        Subsignal("sda", Pins("G18")),
        Subsignal("scl", Pins("K14")),
        Misc("PULLUP=TRUE"), IOStandard("LVCMOS33")),

    # An OV5640 or OV7670 on the camera adapter at PMOD A and JAB, which leaves PMOD B to the motion sensor. The adapter does not connect
    # the sensor's reset and power-down pins.
    ("camera", 0,
        Subsignal("d", Pins("J13 F14 J14 F15 E14 H13 E15 H14")),
        Subsignal("pclk", Pins("D10")),
        Subsignal("href", Pins("C12")),
        Subsignal("vsync", Pins("C11")),
        Subsignal("xclk", Pins("D11"), Misc("DRIVE=24")),
        Subsignal("sda", Pins("E16"), Misc("PULLUP=TRUE")),
        Subsignal("scl", Pins("G16"), Misc("PULLUP=TRUE")),
        IOStandard("LVCMOS33")),

    # The clock of the flash has no entry: it is the pin CCLK, reached through the primitive STARTUPE2.
    ("flash", 0,
        Subsignal("cs_n", Pins("M13")),
        Subsignal("dq", Pins("K17 K18 L14 M15"), Misc("PULLUP=TRUE")),
        Subsignal("reset_n", Pins("N13")),
        IOStandard("LVCMOS33")),

    ("hdmi_out", 0,
        Subsignal("clk_p", Pins("U16")), Subsignal("clk_n", Pins("V17")),
        Subsignal("data0_p", Pins("U17")), Subsignal("data0_n", Pins("U18")),
        Subsignal("data1_p", Pins("R16")), Subsignal("data1_n", Pins("R17")),
        Subsignal("data2_p", Pins("R14")), Subsignal("data2_n", Pins("T14")),
        IOStandard("TMDS_33")),

    # The memory is DDR3L, 1 Gbit, 16 bits wide. Its chip select is tied low on the board.
    ("ddram", 0,
        Subsignal("a", Pins("V3 R4 P6 T3 T6 T1 V5 U7 R7 U6 U3 P5 V6"), IOStandard("SSTL135")),
        Subsignal("ba", Pins("V2 V4 R3"), IOStandard("SSTL135")),
        Subsignal("ras_n", Pins("U2"), IOStandard("SSTL135")),
        Subsignal("cas_n", Pins("U1"), IOStandard("SSTL135")),
        Subsignal("we_n", Pins("T2"), IOStandard("SSTL135")),
        Subsignal("dm", Pins("K4 M3"), IOStandard("SSTL135")),
        Subsignal("dq", Pins("K2 M4 K3 L5 L6 M6 L4 K6 N5 M1 P1 N1 R2 N4 P2 M2"),
            IOStandard("SSTL135"), Misc("IN_TERM=UNTUNED_SPLIT_50")),
        Subsignal("dqs_p", Pins("K1 N3"), IOStandard("DIFF_SSTL135"), Misc("IN_TERM=UNTUNED_SPLIT_50")),
        Subsignal("dqs_n", Pins("L1 N2"), IOStandard("DIFF_SSTL135"), Misc("IN_TERM=UNTUNED_SPLIT_50")),
        Subsignal("clk_p", Pins("R5"), IOStandard("DIFF_SSTL135")),
        Subsignal("clk_n", Pins("T4"), IOStandard("DIFF_SSTL135")),
        Subsignal("cke", Pins("T5"), IOStandard("SSTL135")),
        Subsignal("odt", Pins("P7"), IOStandard("SSTL135")),
        Subsignal("reset_n", Pins("M5"), IOStandard("SSTL135")),
        Misc("SLEW=FAST")),
]

SOURCES = "sources"
"""Folder beside the script with copies of the source files."""

VIVADO = "2020.1"
"""Oldest version of Vivado that the script accepts. No version has been tried."""

# Commands before and after the build, with `build_name` as a field. An old bitstream is deleted, so that a failed build leaves none. The
# script looks for the sentence that the report contains if setup, hold and pulse widths of all clocks are met, because
# `get_timing_paths` does not cover pulse widths.
_CHECK_VERSION = f"""set vivado [version -short]
regexp {{{{^\\d+\\.\\d+}}}} $vivado release
if {{{{[package vcompare $release {VIVADO}] < 0}}}} {{{{
    puts stderr "glint_urbana: Vivado $vivado: expected {VIVADO} or newer"
    exit 1
}}}}
file delete -force {{build_name}}.bit"""
_CHECK_TIMING = """if {{[string first "All user specified timing constraints are met" [report_timing_summary -no_detailed_paths -return_string]] < 0}} {{
    puts stderr "{build_name}: Vivado $vivado does not meet the timing, see {build_name}_timing.rpt: no bitstream is written"
    exit 1
}}"""

# The worst paths of the SoC are in the CPU, and nine tenths of their delay is in wires. The CPU fits one clock region, next to the pins of
# the memory, which keeps these wires short. If the region is full, Vivado may place parts of the CPU outside. No version of Vivado has run
# these commands.
_PLACE_CPU = """create_pblock cpu
resize_pblock [get_pblocks cpu] -add CLOCKREGION_X1Y1:CLOCKREGION_X1Y1
set_property IS_SOFT TRUE [get_pblocks cpu]
add_cells_to_pblock [get_pblocks cpu] [get_cells VexRiscv]"""


class _Toolchain(XilinxVivadoToolchain):
    """Writes a script for Vivado. Its folder may be moved to another computer, and it writes a bitstream only if the timing is met."""

    def __init__(self):
        XilinxVivadoToolchain.__init__(self)
        self.project_commands.append(_CHECK_VERSION)
        self.pre_placement_commands.add(_PLACE_CPU)
        self.bitstream_commands.append(_CHECK_TIMING)

    def build_project(self):
        # This function runs in the folder of the script.
        shutil.rmtree(SOURCES, ignore_errors=True)
        Path(SOURCES).mkdir()
        sources = []
        for filename, *kind in self.platform.sources:
            path = Path(filename)
            if path.parent != Path.cwd():
                copy = Path(SOURCES) / path.name
                if copy.exists():
                    raise ValueError(f"{path}: expected sources of different names, found another {path.name}")
                path = shutil.copyfile(path, copy)
            sources.append((path.name if path.parent == Path.cwd() else str(path), *kind))
        self.platform.sources = sources
        XilinxVivadoToolchain.build_project(self)


class Platform(Xilinx7SeriesPlatform):
    """Writes Verilog, constraints and a script for Vivado."""

    def __init__(self):
        Xilinx7SeriesPlatform.__init__(self, "xc7s50csga324-1", _io, toolchain="vivado", name="glint_urbana")
        self.toolchain = _Toolchain()
        for setting in (
            "CFGBVS VCCO",
            "CONFIG_VOLTAGE 3.3",
            "BITSTREAM.CONFIG.SPI_BUSWIDTH 4",
            # MHz. With the default clock of 3 MHz, the configuration takes up to 1.5 s.
            "BITSTREAM.CONFIG.CONFIGRATE 33",
            "BITSTREAM.GENERAL.COMPRESS TRUE",
        ):
            self.add_platform_command(f"set_property {setting} [current_design]")
        self.add_platform_command("set_property INTERNAL_VREF 0.675 [get_iobanks 34]")

    def build(self, *arguments, **options):
        # Up to this number of loads, a control signal becomes logic instead of a control pin. LiteX has no parameter for this threshold,
        # but copies the directive verbatim into the synthesis command.
        directive = f"default -control_set_opt_threshold {CONTROL_PIN_LOADS - 1}"
        return Xilinx7SeriesPlatform.build(self, *arguments, vivado_synth_directive=directive, **options)

    def create_programmer(self):
        """Returns openFPGALoader for the Arty S7, which has the same FPGA and USB bridge. The loader has no entry for this board."""
        return OpenFPGALoader("arty_s7_50")

    def do_finalize(self, fragment):
        Xilinx7SeriesPlatform.do_finalize(self, fragment)
        self.add_period_constraint(self.lookup_request("clk100", loose=True), 1e9 / 100e6)

"""The Radiona ULX3S with an LFE5U-85F, revisions 2 and 3: pins and programming."""

from litex.build.generic_platform import IOStandard, Misc, Pins, Subsignal
from litex.build.lattice import LatticeECP5Platform
from litex.build.openfpgaloader import OpenFPGALoader

_3V3 = IOStandard("LVCMOS33")
_TMDS = (IOStandard("LVCMOS33D"), Misc("DRIVE=4"))

_io = [
    ("clk25", 0, Pins("G2"), _3V3),

    # Fire 1, fire 2, left, right: the power button has the other polarity, and up and down are not used.
    ("buttons", 0, Pins("R1 T1 U1 H16"), Misc("PULLMODE=DOWN"), _3V3),
    ("switches", 0, Pins("E8 D8 D7 E7"), Misc("PULLMODE=DOWN"), _3V3),
    ("leds", 0, Pins("B2 C2 C1 D2 D1 E2 E1 H3"), Misc("DRIVE=4"), _3V3),

    # `rx` and `tx` are named from the FPGA's side. The board's constraint file names them from the side of the USB bridge.
    ("serial", 0,
        Subsignal("rx", Pins("M1"), Misc("PULLMODE=UP")),
        Subsignal("tx", Pins("L4"), Misc("DRIVE=4")),
        _3V3),

    # An external MPU-6050 at the first pair of the pin header, GP0 and GN0. Its module has pull-up resistors; the FPGA's pull-ups keep the
    # bus idle while no module is connected.
    ("i2c", 0,
        Subsignal("sda", Pins("B11")),
        Subsignal("scl", Pins("C11")),
        Misc("PULLMODE=UP"), _3V3),

    # An image sensor at the following pins of the header, GP1 to GN8. Its clock uses a pin that is connected to the FPGA's clock network.
    ("camera", 0,
        Subsignal("pclk", Pins("A10")),
        Subsignal("xclk", Pins("A11"), Misc("DRIVE=4")),
        Subsignal("href", Pins("A9")),
        Subsignal("vsync", Pins("B10")),
        Subsignal("d", Pins("B9 C10 A7 A8 C8 B8 C6 C7")),
        Subsignal("sda", Pins("A6"), Misc("PULLMODE=UP")),
        Subsignal("scl", Pins("B6"), Misc("PULLMODE=UP")),
        Subsignal("reset_n", Pins("A4"), Misc("DRIVE=4")),
        Subsignal("power_down", Pins("A5"), Misc("DRIVE=4")),
        _3V3),

    # Only the positive pin of each pair is listed: the FPGA also drives the negative pin of the pair.
    ("hdmi_out", 0,
        Subsignal("clk_p", Pins("A17"), *_TMDS),
        Subsignal("data0_p", Pins("A16"), *_TMDS),
        Subsignal("data1_p", Pins("A14"), *_TMDS),
        Subsignal("data2_p", Pins("A12"), *_TMDS)),

    ("sdram_clock", 0, Pins("F19"), Misc("SLEWRATE=FAST"), _3V3),
    ("sdram", 0,
        Subsignal("a", Pins("M20 M19 L20 L19 K20 K19 K18 J20 J19 H20 N19 G20 G19")),
        Subsignal("ba", Pins("P19 N20")),
        Subsignal("cs_n", Pins("P20")), Subsignal("cke", Pins("F20")),
        Subsignal("ras_n", Pins("R20")), Subsignal("cas_n", Pins("T19")), Subsignal("we_n", Pins("T20")),
        Subsignal("dm", Pins("U19 E20")),
        Subsignal("dq", Pins("J16 L18 M18 N18 P18 T18 T17 U20 E19 D20 D19 C20 E18 F18 J18 J17")),
        Misc("SLEWRATE=FAST"), _3V3),

    # A high level lets the ESP32 on the board start its own program instead of waiting for a download.
    ("wifi_gpio0", 0, Pins("L2"), _3V3),
]


class Platform(LatticeECP5Platform):
    """Writes Verilog and constraints; `gateware/ecp5` makes a bitstream from these files."""

    default_clk_name = "clk25"
    default_clk_period = 1e9 / 25e6

    def __init__(self):
        LatticeECP5Platform.__init__(self, "LFE5U-85F-6BG381C", _io, toolchain="trellis", name="glint_ulx3s")

    def create_programmer(self):
        """Returns the loader over the board's USB bridge."""
        return OpenFPGALoader("ulx3s")

    def do_finalize(self, fragment):
        LatticeECP5Platform.do_finalize(self, fragment)
        self.add_period_constraint(self.lookup_request("clk25", loose=True), self.default_clk_period)

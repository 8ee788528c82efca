"""The Radiona ULX3S: ECP5 clocks, SDR SDRAM at the system clock, HDMI from the scan-out."""

from litedram.modules import MT48LC16M16
from litedram.phy import GENSDRPHY
from litex.build.io import DDROutput
from litex.gen import LiteXModule
from litex.soc.cores.clock import ECP5PLL
from migen import ClockDomain, ClockSignal, Instance, Signal
from migen.genlib.resetsync import AsyncResetSynchronizer

from .ecp5_hdmi import Ecp5HDMI
from .gesture import PIXEL_CLOCK
from .soc import GlintSoC
from .ulx3s_platform import Platform
from .video import CEA_640X480

SYS_CLK_FREQ = 40e6
"""System clock in Hz, which is also the clock of the memory."""

_CLK25_FREQ = 25e6


class _PLL(ECP5PLL):
    """A PLL that divides the VCO's frequency by at least 2 for each output, including the feedback output, because of the
    frequency limit of outputs."""

    clko_div_range = (2, 128 + 1)


class CRG(LiteXModule):
    """Clocks and resets: `sys` with the clock of the memory, `pix` with its TMDS clock.

    No single PLL can generate 25.2 MHz from 25 MHz, so the PLL of the video is driven by the PLL of the system. `rst` restarts the
    system but neither PLL: the picture goes black and the monitor keeps its lock.
    """

    def __init__(self, platform, sys_clk_freq):
        self.rst = Signal()
        self.cd_sys = ClockDomain()
        self.cd_sys_ps = ClockDomain(reset_less=True)
        self.cd_por = ClockDomain(reset_less=True)
        self.cd_pix = ClockDomain()
        self.cd_pix5x = ClockDomain()

        self.sys_pll = sys_pll = _PLL()
        sys_pll.register_clkin(platform.request("clk25"), _CLK25_FREQ)
        sys_pll.create_clkout(self.cd_sys, sys_clk_freq, margin=0, with_reset=False)
        # The memory samples commands and data a quarter of a clock after they change.
        sys_pll.create_clkout(self.cd_sys_ps, sys_clk_freq, phase=90, margin=0, with_reset=False)
        restart = Signal()
        self.comb += self.cd_por.clk.eq(self.cd_sys.clk)
        self.sync.por += restart.eq(self.rst)
        # A global buffer distributes the reset to its thousands of loads; through ordinary wires the reset would be one of the slowest
        # paths.
        reset = ClockDomain("reset", reset_less=False)
        self.comb += reset.clk.eq(self.cd_sys.clk)
        self.specials += [
            AsyncResetSynchronizer(reset, ~sys_pll.locked | restart),
            Instance("DCCA", i_CLKI=reset.rst, i_CE=1, o_CLKO=self.cd_sys.rst),
        ]
        self.specials += DDROutput(1, 0, platform.request("sdram_clock"), ClockSignal("sys_ps"))

        self.pixel_pll = pixel_pll = _PLL()
        self.comb += pixel_pll.reset.eq(~sys_pll.locked)
        pixel_pll.register_clkin(self.cd_sys.clk, sys_clk_freq)
        pixel_pll.create_clkout(self.cd_pix, CEA_640X480.clk_freq, margin=0)
        pixel_pll.create_clkout(self.cd_pix5x, 5 * CEA_640X480.clk_freq, margin=0)


class Ulx3sSoC(GlintSoC):
    """The SoC with the clocks, SDRAM, video output and pins of the board."""

    # The flash of this board is not set to four data lines, because the FPGA is configured through one line. The board has no
    # digit displays.
    possible_blocks = GlintSoC.possible_blocks - {"flash", "digits"}
    # With the raymarcher, nextpnr takes twice as long, and reaches a lower clock frequency (see docs/boards.md).
    default_blocks = possible_blocks - {"raymarch"}

    def __init__(self, build_id, blocks, sys_clk_freq=SYS_CLK_FREQ, **options):
        platform = Platform()
        GlintSoC.__init__(self, platform, CRG(platform, sys_clk_freq), build_id, blocks, uart_name="serial", sys_clk_freq=sys_clk_freq,
                          mode=CEA_640X480, **options)
        self.sdrphy = GENSDRPHY(platform.request("sdram"), sys_clk_freq)
        self.add_dram(self.sdrphy, MT48LC16M16(sys_clk_freq, "1:1"))
        if "gesture" in self.blocks:
            platform.add_period_constraint(self.gesture.pclk, 1e9 / PIXEL_CLOCK)
        self.comb += platform.request("wifi_gpio0").eq(1)
        if "scanout" in self.blocks:
            self.hdmi = Ecp5HDMI(self.scanout.video, platform.request("hdmi_out"), self.mode.sync_low)

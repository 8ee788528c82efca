"""The RealDigital Urbana: Spartan-7 clocks, DDR3 at 650 MT/s, HDMI from the scan-out."""

from litedram.modules import MT41K64M16
from litedram.phy.s7ddrphy import A7DDRPHY
from litex.gen import LiteXModule
from litex.soc.cores.clock import S7IDELAYCTRL, S7MMCM, S7PLL
from litex.soc.cores.video import VideoS7HDMIPHY
from migen import ClockDomain, Constant, Instance, Signal

from .gesture import PIXEL_CLOCK
from .scanout import VIDEO_LAYOUT
from .soc import SYS_CLK_FREQ, GlintSoC
from .urbana_platform import Platform
from .video import CEA_1280X720

_SPEED_GRADE = -1
_CLK100_FREQ = 100e6
_IDELAY_CLK_FREQ = 200e6


class _PixelMMCM(S7MMCM):
    """An MMCM at 742.5 MHz, ten times the pixel clock, from 100 MHz: /5 and x37.125.

    LiteX's search tries whole multipliers only, and would choose a pixel clock of 74.2857 MHz, 481 ppm too fast.
    """

    def compute_config(self):
        config = {"divclk_divide": 5, "clkfbout_mult": 37.125}
        vco_freq = self.clkin_freq / config["divclk_divide"] * config["clkfbout_mult"]
        for number, (_, freq, phase, _) in self.clkouts.items():
            divide = vco_freq / freq
            if divide != int(divide):
                raise ValueError(f"the pixel MMCM cannot make {freq/1e6} MHz from its {vco_freq/1e6} MHz")
            config[f"clkout{number}_divide"] = int(divide)
            config[f"clkout{number}_phase"] = phase
        return config


class CRG(LiteXModule):
    """Clocks and resets: `sys` with its memory clocks, 200 MHz for the input delays, `pix` with its TMDS clock.

    `rst` restarts the system but not the video clocks: the picture goes black and the monitor keeps its lock.
    """

    def __init__(self, platform, sys_clk_freq):
        self.rst = Signal()
        self.cd_sys = ClockDomain()
        self.cd_sys4x = ClockDomain()
        self.cd_sys4x_dqs = ClockDomain()
        self.cd_idelay = ClockDomain()
        self.cd_pix = ClockDomain()
        self.cd_pix5x = ClockDomain()

        # A clock region has one MMCM, and the pin reaches only the MMCM and the PLL of its own region directly: Vivado rejects a second
        # MMCM at the pin with error [Place 30-575]. A global buffer reaches the MMCMs and PLLs of all regions.
        clk100 = Signal()
        self.specials += Instance("BUFG", i_I=platform.request("clk100"), o_O=clk100)

        self.sys_mmcm = sys_mmcm = S7MMCM(speedgrade=_SPEED_GRADE)
        self.comb += sys_mmcm.reset.eq(self.rst)
        sys_mmcm.register_clkin(clk100, _CLK100_FREQ)
        sys_mmcm.create_clkout(self.cd_sys, sys_clk_freq, margin=0)
        sys_mmcm.create_clkout(self.cd_sys4x, 4 * sys_clk_freq, margin=0)
        sys_mmcm.create_clkout(self.cd_sys4x_dqs, 4 * sys_clk_freq, phase=90, margin=0)
        # The reset of the domain `sys` also resets the generator of the domain's clock, which runs in the domain of the input clock.
        platform.add_false_path_constraints(self.cd_sys.clk, "clk100")

        self.idelay_pll = idelay_pll = S7PLL(speedgrade=_SPEED_GRADE)
        self.comb += idelay_pll.reset.eq(self.rst)
        idelay_pll.register_clkin(clk100, _CLK100_FREQ)
        idelay_pll.create_clkout(self.cd_idelay, _IDELAY_CLK_FREQ, margin=0)
        self.idelayctrl = S7IDELAYCTRL(self.cd_idelay)

        self.pixel_mmcm = pixel_mmcm = _PixelMMCM(speedgrade=_SPEED_GRADE)
        pixel_mmcm.register_clkin(clk100, _CLK100_FREQ)
        pixel_mmcm.create_clkout(self.cd_pix, CEA_1280X720.clk_freq)
        pixel_mmcm.create_clkout(self.cd_pix5x, 5 * CEA_1280X720.clk_freq)

        # Signals between these two clocks pass through a crossing module of rtl/common or two flip-flops of LiteX, or are stable when the
        # other side reads them.
        platform.add_false_path_constraints(self.cd_sys.clk, self.cd_pix.clk)


def _without_write_bitslip(strobe):
    """Returns the write strobe of a register of the PHY, or 0 for the register that shifts write data by a bit.

    The BIOS never writes this register, because this PHY has no calibration of the write latency. Without the strobe, synthesis removes a
    multiplexer of eight inputs for each bit of the write data.
    """
    name, _ = strobe.backtrace[-1]
    return Constant(0) if name == "wdly_dq_bitslip_re" else strobe


class UrbanaSoC(GlintSoC):
    """The SoC with the clocks, DDR3 memory, video output and pins of the board."""

    def __init__(self, build_id, blocks, sys_clk_freq=SYS_CLK_FREQ, **options):
        platform = Platform()
        GlintSoC.__init__(self, platform, CRG(platform, sys_clk_freq), build_id, blocks, uart_name="serial", sys_clk_freq=sys_clk_freq,
                          **options)
        self.ddrphy = A7DDRPHY(
            platform.request("ddram"), memtype="DDR3", nphases=4,
            sys_clk_freq=sys_clk_freq, iodelay_clk_freq=_IDELAY_CLK_FREQ, csr_cdc=_without_write_bitslip)
        # The BIOS does not change the phases of commands, so the controller needs no multiplexer for them.
        self.ddrphy.settings.rdphase = self.ddrphy.settings.rdphase.reset.value
        self.ddrphy.settings.wrphase = self.ddrphy.settings.wrphase.reset.value
        # The termination is set directly, because `add_electrical_settings` stores the value under a name that the initialisation
        # of the memory does not read.
        self.ddrphy.settings.rtt_nom = "40ohm"
        self.add_dram(self.ddrphy, MT41K64M16(sys_clk_freq, "1:4"))
        if "gesture" in self.blocks:
            self._constrain_camera(platform)
        if "scanout" in self.blocks:
            self.hdmi = VideoS7HDMIPHY(platform.request("hdmi_out"), clock_domain="pix")
            self.comb += self.hdmi.sink.valid.eq(1)
            self.comb += [getattr(self.hdmi.sink, name).eq(getattr(self.scanout.video, name))
                          for name, _ in VIDEO_LAYOUT]

    def _constrain_camera(self, platform):
        """Constrains the clock of the image sensor, and the paths between it and `sys`, which all go through crossings of rtl/common.

        The delays of the bits of a pointer of `cdc_fifo` may differ by less than a period of either clock, so the limit is the
        shorter period. It is not known whether the pin can reach the clock network directly. The commands run before the
        placement, because in the XDC they would precede the commands that create the clocks.
        """
        platform.add_period_constraint(self.gesture.pclk, 1e9 / PIXEL_CLOCK)
        limit = round(1e9 / max(PIXEL_CLOCK, self.sys_clk_freq), 2)
        commands = platform.toolchain.pre_placement_commands
        clocks = {"sys": self.crg.cd_sys.clk, "pclk": self.gesture.pclk}
        for start, end in (("sys", "pclk"), ("pclk", "sys")):
            commands.add(f"set_max_delay -datapath_only -from [get_clocks -of [get_nets {{{start}}}]] "
                         f"-to [get_clocks -of [get_nets {{{end}}}]] {limit}", **clocks)
        commands.add("set_property CLOCK_DEDICATED_ROUTE FALSE [get_nets camera_pclk_IBUF]")

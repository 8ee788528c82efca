"""Scan-out, triangle engine and, with `--raymarch`, raymarcher in litex-boards' SoC of the Digilent Arty A7, with video on a Pmod VGA at
JB and JC: `python arty.py --build`. Needs `pip install glint-soc[boards]`. Never tried on hardware."""

import argparse

from litex.build.generic_platform import IOStandard, Pins, Subsignal
from litex.gen import LiteXModule
from litex.soc.cores.clock import S7PLL
from litex.soc.integration.builder import Builder
from litex_boards.targets.digilent_arty import BaseSoC
from migen import ClockDomain

from glint_soc.raymarch import Raymarcher, build
from glint_soc.scanout import Scanout
from glint_soc.triangle import TriangleEngine, memory_ports
from glint_soc.video import CEA_640X480 as MODE

_VGA = [("vga", 0,
         Subsignal("r", Pins("pmodb:0 pmodb:1 pmodb:2 pmodb:3")), Subsignal("b", Pins("pmodb:4 pmodb:5 pmodb:6 pmodb:7")),
         Subsignal("g", Pins("pmodc:0 pmodc:1 pmodc:2 pmodc:3")), Subsignal("hsync", Pins("pmodc:4")), Subsignal("vsync", Pins("pmodc:5")),
         IOStandard("LVCMOS33"))]


class PixelClock(LiteXModule):
    def __init__(self, clock, frequency):
        self.cd_pix, self.pll = ClockDomain("pix"), S7PLL(speedgrade=-1)
        self.pll.register_clkin(clock, 100e6)
        self.pll.create_clkout(self.cd_pix, frequency)


class GlintSoC(BaseSoC):
    def __init__(self, has_raymarcher=False, sys_clk_freq=80e6, **options):
        # The engines bypass a second cache level.
        BaseSoC.__init__(self, variant="a7-100", sys_clk_freq=sys_clk_freq, l2_size=0, cpu_variant="full",
                         integrated_rom_size=0x10000, **options)
        self.pixel_clock = PixelClock(self.crg.pll.clkin, MODE.clk_freq)
        self.platform.add_false_path_constraints(self.crg.cd_sys.clk, self.pixel_clock.cd_pix.clk)

        def port(mode):
            return self.sdram.crossbar.get_port(mode, 128)

        main_ram = self.bus.regions["main_ram"]
        self.scanout = Scanout(self.platform, port("read"), MODE)
        self.triangle = TriangleEngine(self.platform, *memory_ports(port, main_ram), main_ram, MODE.sizes, fields=has_raymarcher)
        if has_raymarcher:
            self.raymarch = Raymarcher(self.platform, build("faces"), self.triangle)
        for name in ("scanout", "triangle", *(["raymarch"] if has_raymarcher else [])):
            self.irq.add(name)
        self.platform.add_extension(_VGA)
        pads, video = self.platform.request("vga"), self.scanout.video
        self.comb += [pads.hsync.eq(~video.hsync), pads.vsync.eq(~video.vsync)]
        self.comb += [getattr(pads, colour).eq(getattr(video, colour)[4:]) for colour in "rgb"]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", action="store_true", help="build the bitstream, with Vivado")
    parser.add_argument("--raymarch", action="store_true", help="add the raymarcher")
    arguments = parser.parse_args()
    Builder(GlintSoC(arguments.raymarch), csr_csv="csr.csv", csr_json="csr.json").build(run=arguments.build)

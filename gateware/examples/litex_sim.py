"""Scan-out, triangle engine and raymarcher in an ordinary LiteX SoC with LiteDRAM and its memory model, simulated by Verilator:
`python litex_sim.py FOLDER`. The bus master is the test bench, in place of a processor."""

import sys
from pathlib import Path

from litedram.modules import MT41K64M16
from litedram.phy.model import SDRAMPHYModel, get_sdram_phy_settings
from litex.build.generic_platform import GenericPlatform, Pins, Subsignal
from litex.build.sim.common import sim_special_overrides
from litex.soc.integration.soc_core import SoCCore
from litex.soc.interconnect import wishbone

from glint_soc import generate
from glint_soc.raymarch import Raymarcher, build
from glint_soc.scanout import VIDEO_LAYOUT, Scanout
from glint_soc.simulate import simulate
from glint_soc.triangle import TriangleEngine, memory_ports
from glint_soc.video import VideoMode

CLOCK, NAME = 100e6, "litex_sim"
# A small screen makes the simulation short.
MODE = VideoMode(clk_freq=25e6, pixels=(320, 8, 8, 8), lines=(180, 2, 2, 2))


class SimSoC(SoCCore):
    def __init__(self, cpu_type=None, has_raymarcher=True, **options):
        host = wishbone.Interface(data_width=32, address_width=32, addressing="word")
        pins = [(name, 0, Pins(1)) for name in ("clk", "rst", "pix_clk", "pix_rst")]
        video = ("video", 0, *(Subsignal(name, Pins(bits)) for name, bits in VIDEO_LAYOUT))
        platform = GenericPlatform("", [*pins, video, *host.get_ios("registers")], name=NAME)
        self.crg = generate.Clocks(*((name, *map(platform.request, pins)) for name, pins in (
            ("sys", ("clk", "rst")), ("pix", ("pix_clk", "pix_rst")))))
        SoCCore.__init__(self, platform, CLOCK, cpu_type=cpu_type, with_uart=False, with_timer=False, **options)
        self.comb += host.connect_to_pads(platform.request("registers"), mode="slave")
        self.bus.add_master("host", host)
        module = MT41K64M16(CLOCK, "1:4")
        self.ddrphy = SDRAMPHYModel(module, get_sdram_phy_settings(module.memtype, 16, CLOCK), CLOCK)
        self.add_sdram("sdram", self.ddrphy, module, l2_cache_size=0)

        def port(mode):
            return self.sdram.crossbar.get_port(mode, 128)

        main_ram = self.bus.regions["main_ram"]
        self.scanout = Scanout(platform, port("read"), MODE)
        self.triangle = TriangleEngine(platform, *memory_ports(port, main_ram), main_ram, MODE.sizes, fields=has_raymarcher)
        if has_raymarcher:
            self.raymarch = Raymarcher(platform, build("faces"), self.triangle)
        pads = platform.request("video")
        self.comb += [getattr(pads, name).eq(getattr(self.scanout.video, name)) for name, _ in VIDEO_LAYOUT]


if __name__ == "__main__":
    soc, folder = SimSoC(), Path(sys.argv[1])
    soc.finalize()
    core = {"name": NAME, "clock": CLOCK / 1e6, "registers": "wishbone", "memory": {"bus": "host", "origin": soc.mem_map["main_ram"]},
            "blocks": {"scanout": {}, "triangle": {}, "raymarch": {"fields": "faces"}}}
    generate.write(soc, generate.verilog(soc, NAME, special_overrides=sim_special_overrides), core, MODE, folder)
    sys.exit(simulate(folder, NAME))

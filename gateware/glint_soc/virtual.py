"""The virtual board: the SoC with plain pins for a harness, and LiteDRAM's model of the DDR3 memory."""

import os

from litedram.modules import MT41K64M16
from litedram.phy.model import SDRAMPHYModel
from litex.build.generic_platform import GenericPlatform, Pins, Subsignal
from litex.build.sim.common import sim_special_overrides
from litex.gen import LiteXModule
from migen import ClockDomain, Signal
from migen.fhdl.specials import Memory
from migen.genlib.resetsync import AsyncResetSynchronizer

from .soc import SYS_CLK_FREQ, GlintSoC

_io = [
    ("sys_clk", 0, Pins(1)),
    ("pix_clk", 0, Pins(1)),
    # A byte stream instead of a serial line: `source` leaves the SoC, `sink` enters it.
    ("serial", 0,
        Subsignal("source_valid", Pins(1)), Subsignal("source_ready", Pins(1)), Subsignal("source_data", Pins(8)),
        Subsignal("sink_valid", Pins(1)), Subsignal("sink_ready", Pins(1)), Subsignal("sink_data", Pins(8))),
    # Open drain: an output of 0 pulls the wire low; an input is the state of the wire.
    ("i2c", 0,
        Subsignal("scl_out", Pins(1)), Subsignal("scl_in", Pins(1)),
        Subsignal("sda_out", Pins(1)), Subsignal("sda_in", Pins(1))),
    ("buttons", 0, Pins(4)),
    ("switches", 0, Pins(16)),
    ("leds", 0, Pins(16)),
    ("vga", 0,
        Subsignal("hsync", Pins(1)), Subsignal("vsync", Pins(1)), Subsignal("de", Pins(1)),
        Subsignal("r", Pins(8)), Subsignal("g", Pins(8)), Subsignal("b", Pins(8))),
]


class Platform(GenericPlatform):
    """Writes Verilog and the ROM image; Verilator takes it from there."""

    def __init__(self):
        GenericPlatform.__init__(self, device="virtual", io=list(_io), name="glint_virtual")

    def build(self, fragment, build_dir, build_name, **_):
        os.makedirs(build_dir, exist_ok=True)
        self.finalize(fragment)
        design = self.get_verilog(fragment, name=build_name, special_overrides=sim_special_overrides)
        if design.data_files:
            raise ValueError(f"a memory is initialized from a file, which ties the build to a path: {design.data_files}")
        # The banner has the time of the build: without it the same SoC gives the same file.
        lines = design.main_source.splitlines(keepends=True)
        with open(os.path.join(build_dir, f"{build_name}.v"), "w") as verilog:
            verilog.writelines(line for line in lines if not line.startswith("// Date "))
        with open(os.path.join(build_dir, f"{build_name}.f"), "w") as file_list:
            for path, *_ in self.sources:
                file_list.write(f"{path}\n")
            for path in self.verilog_include_paths:
                file_list.write(f"+incdir+{path}\n")
        return design.ns


class CRG(LiteXModule):
    """Both clocks come from the harness; reset is asserted at power on and by the `ctrl` peripheral."""

    def __init__(self, platform):
        self.rst = Signal()
        self.cd_sys = ClockDomain()
        self.cd_pix = ClockDomain()
        self.cd_por = ClockDomain(reset_less=True)

        # # #

        power_on = Signal(reset=1)
        self.comb += [
            self.cd_sys.clk.eq(platform.request("sys_clk")),
            self.cd_por.clk.eq(self.cd_sys.clk),
            self.cd_pix.clk.eq(platform.request("pix_clk")),
            self.cd_sys.rst.eq(power_on),
        ]
        self.sync.por += power_on.eq(self.rst)
        self.specials += AsyncResetSynchronizer(self.cd_pix, power_on)


class VirtualSoC(GlintSoC):
    """The SoC as the virtual board runs it."""

    def __init__(self, build_id, blocks):
        platform = Platform()
        GlintSoC.__init__(self, platform, CRG(platform), build_id, blocks, uart_name="sim")
        self.ddrphy = SDRAMPHYModel(
            module=MT41K64M16(SYS_CLK_FREQ, "1:4"), data_width=16, clk_freq=SYS_CLK_FREQ)
        self._name_banks()
        # Loaded by the harness: `$readmemh` would tie the build to a path.
        self.rom.mem.init = None
        self.sram.mem.init = None
        self.add_dram(self.ddrphy)
        # The BIOS tests 2 MiB unless told otherwise: minutes here.
        self.add_constant("MEMTEST_DATA_SIZE", 8 * 1024)
        self.add_constant("MEMTEST_ADDR_SIZE", 8 * 1024)
        # The pins are there in every build, so that one harness fits all.
        pads = platform.request("vga")
        if "scanout" in self.blocks:
            self.comb += [getattr(pads, name).eq(getattr(self.scanout.video, name))
                          for name in ("hsync", "vsync", "de", "r", "g", "b")]

    def _name_banks(self):
        """Gives the memory of each DDR3 bank a name that the harness can rely on."""
        # Not get_fragment(): a module that has been asked for its fragment is left out of its parent's.
        banks = [special for _, module in self.ddrphy._submodules for special in module._fragment.specials
                 if isinstance(special, Memory)]
        for number, memory in enumerate(sorted(banks, key=lambda memory: memory.duid)):
            memory.name_override = f"ddr3_bank{number}"

    def init_rom(self, name, contents=(), auto_size=True):
        """Leaves the ROM empty and at its full size: the harness loads the BIOS or another program."""

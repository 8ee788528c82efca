"""The SoC as a block for place and route, with plain pins instead of pads and clocks, and without the memory's PHY."""

from pathlib import Path

from litedram.modules import MT41K64M16
from litedram.phy.dfi import Interface
from litedram.phy.model import get_sdram_phy_settings
from litex.build.generic_platform import Pins, Subsignal
from litex.build.sim.common import sim_special_overrides
from litex.gen import LiteXModule

from glint_soc.raymarch import build
from glint_soc.virtual import PinSoC

MACHINES = {"soc_core": (), "soc": PinSoC.default_blocks}
"""The optional blocks of each machine: the computer alone, and the default build for the Urbana."""

TOP = "glint_machine"


class _DfiPins(LiteXModule):
    """The DFI interface to the memory's PHY as pins, with the phases and latencies of the Urbana's PHY."""

    def __init__(self, platform, clk_freq):
        self.module = module = MT41K64M16(clk_freq, "1:4")
        self.settings = settings = get_sdram_phy_settings(module.memtype, 16, clk_freq)
        geometry = module.geom_settings
        self.dfi = Interface(geometry.addressbits, geometry.bankbits, settings.nranks, settings.dfi_databits, settings.nphases)

        for number, phase in enumerate(self.dfi.phases):
            signals = [(name, getattr(phase, name)) for name, *_ in phase.layout]
            platform.add_extension([("dfi", number, *(Subsignal(name, Pins(len(signal))) for name, signal in signals))])
            pads = platform.request("dfi", number)
            for name, signal in signals:
                pad = getattr(pads, name)
                self.comb += signal.eq(pad) if name.startswith("rddata") and name != "rddata_en" else pad.eq(signal)


def write(name, folder):
    """Writes the Verilog of a machine to `folder`. Returns all its source files."""
    soc = PinSoC(0, MACHINES[name], fields=build("faces"))
    # Arbitrary contents. If all words were equal, Yosys would remove the ROM.
    soc.rom.mem.init = [0x9E3779B9 * (word + 1) % 2**32 for word in range(soc.rom.mem.depth)]
    soc.add_memory(_DfiPins(soc.platform, soc.sys_clk_freq))
    soc.finalize()
    soc.platform.finalize(soc)
    design = soc.platform.get_verilog(soc, name=TOP, special_overrides=sim_special_overrides)
    files = {f"{TOP}.v": design.main_source, **design.data_files}
    for file, text in files.items():
        (folder / file).write_text(text)
    return [folder / f"{TOP}.v", *(Path(path) for path, *_ in soc.platform.sources)]

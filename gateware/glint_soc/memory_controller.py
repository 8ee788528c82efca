"""Memory controller: LiteDRAM's controller with replacements for bank machines, multiplexer, refresher and crossbar, which have shorter
paths."""

from litedram.common import LiteDRAMInterface, burst_lengths
from litedram.core.controller import ControllerSettings
from litedram.core.multiplexer import Multiplexer
from litedram.phy import dfi
from litex.gen import LiteXModule
from migen import log2_int

from .memory_bank import MemoryBank
from .memory_crossbar import MemoryCrossbar
from .memory_injector import MemoryInjector
from .memory_multiplexer import MemoryMultiplexer
from .memory_refresh import MemoryRefresher


class _Controller(LiteXModule):
    """Replaces `LiteDRAMController`. It has those members of that class that LiteX, the crossbar and the BIOS use."""

    def __init__(self, phy, module, clk_freq, settings):
        geometry, burst = module.geom_settings, burst_lengths[phy.settings.memtype]
        self.settings = settings
        settings.phy, settings.geom, settings.timing = phy.settings, geometry, module.timing_settings
        alignment = log2_int(burst)
        self.interface = LiteDRAMInterface(alignment, settings)
        self.dfi = dfi.Interface(geometry.addressbits, geometry.bankbits, phy.settings.nranks, phy.settings.dfi_databits,
                                 phy.settings.nphases)

        self.refresher = MemoryRefresher(settings, clk_freq)
        self.banks = [MemoryBank(number, self.interface.address_width, alignment, settings)
                      for number in range(2**geometry.bankbits)]
        for number, bank in enumerate(self.banks):
            self.submodules += bank
            self.comb += getattr(self.interface, f"bank{number}").connect(bank.req)
        multiplexer = MemoryMultiplexer if phy.settings.nphases == 1 else Multiplexer
        self.multiplexer = multiplexer(settings, self.banks, self.refresher, self.dfi, self.interface)


class MemoryController(LiteXModule):
    """Replaces `LiteDRAMCore`: the controller and crossbar of the memory `module` behind `phy`, and the registers through which
    the BIOS initialises the memory.

    Read and write runs are limited to 64 and 128 clocks instead of LiteDRAM's 32 and 16, because each switch between reads and
    writes takes a dozen clocks.
    """

    def __init__(self, phy, module, clk_freq):
        if phy.settings.nranks != 1:
            raise ValueError(f"{phy.settings.nranks} ranks of memory: expected 1")
        geometry = module.geom_settings
        self.dfii = MemoryInjector(geometry.addressbits, geometry.bankbits, phy.settings.dfi_databits, phy.settings.nphases)
        self.controller = _Controller(phy, module, clk_freq,
                                      ControllerSettings(read_time=64, write_time=128, cmd_buffer_depth=8))
        self.crossbar = MemoryCrossbar(self.controller.interface, self.dfii)
        self.comb += [
            self.dfii.master.connect(phy.dfi),
            self.controller.dfi.connect(self.dfii.slave),
        ]

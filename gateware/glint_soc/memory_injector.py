"""Commands of the CPU to the memory, for its initialisation."""

from litedram.dfii import PhaseInjector
from litedram.phy.dfi import Interface
from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStorage
from migen import Cat, If, Signal
from migen.genlib.record import DIR_M_TO_S


class MemoryInjector(LiteXModule):
    """Replaces LiteDRAM's `DFIInjector`, whose registers it has: `master`, the PHY, gets the commands of `slave`, the controller, or those
    of the registers.

    LiteDRAM selects data in both directions too, and masks those that are not selected. Here data of reads go to both sides, of which one
    has the valid bit. Data of writes come from `slave` alone: the crossbar, which selects a port's data anyway, sends `words` while
    `injects` is high.
    """

    def __init__(self, addressbits, bankbits, databits, nphases):
        layout = addressbits, bankbits, 1, databits, nphases
        self.slave, self.master, injected = Interface(*layout), Interface(*layout), Interface(*layout)
        self._control = CSRStorage(fields=[
            CSRField("sel", size=1, values=[
                ("``0b0``", "Software (CPU) control."),
                ("``0b1``", "Hardware control (default)."),
            ], reset=0b1),
            CSRField("cke", size=1, description="DFI clock enable bus"),
            CSRField("odt", size=1, description="DFI on-die termination bus"),
            CSRField("reset_n", size=1, description="DFI clock reset bus"),
        ], description="Control DFI signals common to all phases")
        injectors = [PhaseInjector(phase) for phase in injected.phases]
        for number, injector in enumerate(injectors):
            setattr(self, f"pi{number}", injector)

        # # #

        control = self._control.fields
        self.injects, self.words = Signal(), Signal(databits * nphases)
        self.comb += [self.injects.eq(~control.sel), self.words.eq(Cat(*(phase.wrdata for phase in injected.phases)))]
        for given, own, phase in zip(self.slave.phases, injected.phases, self.master.phases, strict=True):
            self.comb += [
                *(getattr(own, name).eq(getattr(control, name)) for name in ("cke", "odt", "reset_n")),
                phase.wrdata.eq(given.wrdata),
                phase.wrdata_mask.eq(given.wrdata_mask),
                *(If(control.sel, getattr(phase, name).eq(getattr(given, name))).Else(getattr(phase, name).eq(getattr(own, name)))
                  for name, _, direction in phase.layout if direction == DIR_M_TO_S and name not in ("wrdata", "wrdata_mask")),
                *(side.rddata.eq(phase.rddata) for side in (given, own)),
                given.rddata_valid.eq(phase.rddata_valid & control.sel),
                own.rddata_valid.eq(phase.rddata_valid & ~control.sel),
            ]

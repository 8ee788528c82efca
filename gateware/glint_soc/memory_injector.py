"""Memory commands of the CPU, for the initialisation of the memory."""

from litedram.dfii import PhaseInjector
from litedram.phy.dfi import Interface
from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStorage
from migen import Cat, If, Signal
from migen.genlib.record import DIR_M_TO_S


class MemoryInjector(LiteXModule):
    """Replaces LiteDRAM's `DFIInjector`, and has the same registers: `master`, the PHY, receives the commands of `slave`, the controller,
    or of the registers.

    LiteDRAM's module also multiplexes the data in both directions, and masks the data that are not selected. In this module read data go
    to both sides, and only the selected side receives the valid bit. Write data come only from `slave`: while `injects` is high, the
    crossbar, which selects a port's data anyway, sends `words` instead.
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

"""Bit-banged I2C master that sees both wires."""

from litex.soc.cores.bitbang import I2CMaster
from litex.soc.interconnect.csr import CSRField, CSRStatus
from migen.fhdl.specials import Tristate


class OpenDrainI2C(I2CMaster):
    """LiteX's I2C master, with SCL readable as well, so that firmware notices clock stretching and a stuck bus.

    Register `w` drives, register `r` reads the wires. A wire is pulled low or released, never driven high.
    """

    def __init__(self, pads):
        I2CMaster.__init__(self, pads, connect_pads=False)
        self._r = CSRStatus(fields=[
            CSRField("sda", size=1, offset=0, description="State of the SDA wire."),
            CSRField("scl", size=1, offset=1, description="State of the SCL wire.")],
            name="r")
        self.connect(pads)

    def connect(self, pads):
        pull_scl = ~self._w.fields.scl
        pull_sda = self._w.fields.oe & ~self._w.fields.sda
        if hasattr(pads, "scl_in"):
            self.comb += [
                pads.scl_out.eq(~pull_scl),
                pads.sda_out.eq(~pull_sda),
                self._r.fields.scl.eq(pads.scl_in),
                self._r.fields.sda.eq(pads.sda_in),
            ]
        else:
            self.specials += [
                Tristate(pads.scl, o=0, oe=pull_scl, i=self._r.fields.scl),
                Tristate(pads.sda, o=0, oe=pull_sda, i=self._r.fields.sda),
            ]

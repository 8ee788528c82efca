"""Registers that only the gateware reads."""

from litex.soc.interconnect.csr import CSR, CSRStorage
from migen import If


class Parameter(CSRStorage):
    """A register of up to 32 bits that the CPU writes and that reads as 0.

    Reading back would cost a LUT for every three bits in the multiplexer of the block's registers. The content is not reset:
    software writes it before the gateware uses it.
    """

    def __init__(self, *arguments, description, **options):
        super().__init__(*arguments, description=f"{description} Reads as 0.", reset_less=True, **options)

    def do_finalize(self, busword, ordering):
        if self.size > busword:
            raise ValueError(f"{self.name}: {self.size} bits, expected at most {busword}")
        register = CSR(self.size, self.name)
        self.simple_csrs.append(register)
        self.sync += [If(register.re, self.storage.eq(register.r)), self.re.eq(register.re)]

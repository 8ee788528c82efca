"""What the joint memory ports of different buses have in common: the engines' native LiteDRAM ports on one side, and errors."""

from functools import reduce
from operator import or_

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRStatus
from migen import Cat, If, Replicate, Signal, log2_int


class MemoryPorts(LiteXModule):
    """Joins `ports`, native LiteDRAM ports of one width that read or write, to a single port of a memory whose first word is at the byte
    address `origin`, a multiple of the memory's size.

    Bit k of `pending` is high while a word that writer k has sent may not be in memory yet. `error` is high in each clock in which memory
    answers with an error; the register `errors` counts these clocks.
    """

    def __init__(self, ports, origin):
        self._bits = ports[0].data_width
        for port in ports:
            if port.data_width != self._bits or port.mode not in ("read", "write"):
                raise ValueError(f"expected ports of {self._bits} bits that read or write, got {port.data_width} bits, {port.mode}")
        self._readers = [port for port in ports if port.mode == "read"]
        self._writers = [port for port in ports if port.mode == "write"]
        self._origin = origin
        self.pending = Signal(max(len(self._writers), 1))
        self.error = Signal()
        self._errors = CSRStatus(32, name="errors", description="Accesses that memory answered with an error, modulo 2^32.")
        self.sync += If(self.error, self._errors.status.eq(self._errors.status + 1))

    def _address(self, port):
        """Returns the byte address of a port's command."""
        return Cat(Signal(log2_int(self._bits // 8)), port.cmd.addr) | self._origin

    @staticmethod
    def _selected(turn, values):
        """Returns the element of `values` at the index of the set bit of `turn`."""
        return reduce(or_, (Replicate(mine, len(value)) & value for mine, value in zip(turn, values)))

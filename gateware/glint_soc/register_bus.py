"""Register banks and their bridge on the CPU's bus, with one more clock of latency than LiteX's, for the address decoder."""

from litex.soc.interconnect.csr_bus import CSRBank, Interface
from litex.soc.interconnect.wishbone import Wishbone2CSR
from migen import Cat, ClockDomainsRenamer, NextState, Signal, log2_int


class RegisterBank(CSRBank):
    """A bank of registers that a flip-flop selects.

    In LiteX's bank, the whole address of the bus selects a register. On its way from the bridge to the block, that takes longer than
    anything else in a large FPGA. Here each bank compares the number of its window, and stores the result with the rest of the
    access:

        bus ─▶ is this the window? ─▶ flip-flops ─▶ LiteX's bank ─▶ data

    Data of a read come two clocks after the access, and a write has its effect one clock later than in LiteX. `addressed` is high while
    `bus` shows an address of the bank. A bank is in the clock domain `clock_domain` of its registers, if they have this attribute.
    """

    def __init__(self, description, address=0, bus=None, paging=0x800, ordering="big"):
        access, selected = Interface.like(bus), Signal()
        CSRBank.__init__(self, description, 1, access, paging, ordering)
        self.bus, self.addressed = bus, Signal()

        # # #

        number = Signal(log2_int(paging // 4))
        self.comb += [
            self.addressed.eq(bus.adr[len(number):] == address),
            access.adr.eq(Cat(number, selected)),
            bus.dat_r.eq(access.dat_r),
        ]
        self.sync += [
            selected.eq(self.addressed),
            number.eq(bus.adr),
            access.dat_w.eq(bus.dat_w),
            access.we.eq(bus.we),
            access.re.eq(bus.re),
        ]
        if domain := getattr(description[0], "clock_domain", None):
            ClockDomainsRenamer(domain)(self)


class RegisterBridge(Wishbone2CSR):
    """LiteX's bridge, modified for banks whose data come one clock later."""

    def __init__(self, bus_wishbone=None, bus_csr=None, register=True):
        if not register:
            raise ValueError("expected a bridge with registers")
        Wishbone2CSR.__init__(self, bus_wishbone, bus_csr, register)
        self.fsm.act("WRITE-READ", NextState("SELECTED"))
        self.fsm.act("SELECTED", NextState("ACK"))

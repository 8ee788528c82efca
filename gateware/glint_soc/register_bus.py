"""Register banks and their bridge to the CPU's bus. Each bank registers its address and its selection."""

from litex.gen import LiteXModule
from litex.soc.interconnect import wishbone
from litex.soc.interconnect.csr_bus import CSRBank, Interface
from migen import FSM, Cat, ClockDomainsRenamer, If, NextState, Signal, log2_int


class RegisterBank(CSRBank):
    """A bank of registers whose selection is stored in a flip-flop.

    In LiteX's bank, the whole bus address selects a register. In a large FPGA this path, from the bridge to the block, is the
    longest path. Here each bank compares the window number with its own, and stores the result together with the address within the
    window:

        bus ─▶ is this the window? ─▶ flip-flops ─▶ LiteX's bank ─▶ data

    Read data are valid two clocks after the access. A write takes effect one clock later than in LiteX, so the bus must hold the written
    data for one more clock. `addressed` is high while `bus` shows an access to the bank. If the registers have the attribute
    `clock_domain`, the bank is in that clock domain.
    """

    def __init__(self, description, address=0, bus=None, paging=0x800, ordering="big"):
        access, selected = Interface.like(bus), Signal()
        CSRBank.__init__(self, description, 1, access, paging, ordering)
        self.bus, self.addressed = bus, Signal()

        number, in_window = Signal(log2_int(paging // 4)), Signal()
        self.comb += [
            in_window.eq(bus.adr[len(number):] == address),
            self.addressed.eq(in_window & (bus.re | bus.we)),
            access.adr.eq(Cat(number, selected)),
            access.dat_w.eq(bus.dat_w),
            bus.dat_r.eq(access.dat_r),
        ]
        self.sync += [
            selected.eq(in_window),
            number.eq(bus.adr),
            access.we.eq(bus.we),
            access.re.eq(bus.re),
        ]
        if domain := getattr(description[0], "clock_domain", None):
            ClockDomainsRenamer(domain)(self)


class RegisterBridge(LiteXModule):
    """Replaces LiteX's bridge for `RegisterBank`s: a Wishbone slave that accesses the bus of the banks. The Wishbone request must come
    from flip-flops.

        clock   0        1         2
        csr     access   address, written data stay
        bank             effect    data of a read
        wishbone                   acknowledgement
    """

    def __init__(self, bus_wishbone=None, bus_csr=None, register=True):
        self.wishbone, self.csr = bus_wishbone or wishbone.Interface(), bus_csr or Interface(data_width=32)

        self.comb += [
            self.csr.adr.eq(self.wishbone.adr),
            self.csr.dat_w.eq(self.wishbone.dat_w),
            self.wishbone.dat_r.eq(self.csr.dat_r),
        ]
        self.fsm = fsm = FSM()
        fsm.act("ACCESS",
            If(self.wishbone.cyc & self.wishbone.stb,
                self.csr.re.eq(~self.wishbone.we & (self.wishbone.sel != 0)),
                self.csr.we.eq(self.wishbone.we & (self.wishbone.sel != 0)),
                NextState("EFFECT"),
            )
        )
        fsm.act("EFFECT", NextState("DATA"))
        fsm.act("DATA",
            self.wishbone.ack.eq(1),
            NextState("ACCESS"),
        )

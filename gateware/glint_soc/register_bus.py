"""Register banks and their bridge on the CPU's bus, with flip-flops at each bank for the address decoder."""

from litex.gen import LiteXModule
from litex.soc.interconnect import wishbone
from litex.soc.interconnect.csr_bus import CSRBank, Interface
from migen import FSM, Cat, ClockDomainsRenamer, If, NextState, Signal, log2_int


class RegisterBank(CSRBank):
    """A bank of registers that a flip-flop selects.

    In LiteX's bank, the whole address of the bus selects a register. On its way from the bridge to the block, that takes longer than
    anything else in a large FPGA. Here each bank compares the number of its window, and stores the result with the address in
    the window:

        bus ─▶ is this the window? ─▶ flip-flops ─▶ LiteX's bank ─▶ data

    Data of a read come two clocks after the access, and a write has its effect one clock later than in LiteX: the bus must still
    show the written data then. `addressed` is high while `bus` shows an access to the bank. A bank is in the clock domain `clock_domain` of its
    registers, if they have this attribute.
    """

    def __init__(self, description, address=0, bus=None, paging=0x800, ordering="big"):
        access, selected = Interface.like(bus), Signal()
        CSRBank.__init__(self, description, 1, access, paging, ordering)
        self.bus, self.addressed = bus, Signal()

        # # #

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
    """Replaces LiteX's bridge, for banks of this class: a Wishbone slave whose request comes from flip-flops, and the bus of the banks.

        clock   0        1         2
        csr     access   address, written data stay
        bank             effect    data of a read
        wishbone                   acknowledgement
    """

    def __init__(self, bus_wishbone=None, bus_csr=None, register=True):
        self.wishbone, self.csr = bus_wishbone or wishbone.Interface(), bus_csr or Interface(data_width=32)

        # # #

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

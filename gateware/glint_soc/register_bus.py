"""Bridge from the CPU's bus to LiteX's register banks, with a stage before each bank that registers the bank's address and selection."""

from litex.gen import LiteXModule
from litex.soc.interconnect import wishbone
from litex.soc.interconnect.csr_bus import Interface, InterconnectShared
from migen import FSM, Cat, ClockDomainsRenamer, If, Mux, NextState, Signal, log2_int

from .register_map import CSR_PAGING


class RegisterStage(LiteXModule):
    """Stands before a register bank of LiteX, and stores the bank's selection in a flip-flop.

    In LiteX's bank, the whole bus address selects a register. In a large FPGA this path, from the bridge to the block, is the
    longest path. Here each bank compares the window number with its own, and stores the result together with the address within the
    window:

        bus ─▶ is this the window? ─▶ flip-flops ─▶ LiteX's bank ─▶ data

    Read data are valid two clocks after the access. A write takes effect one clock later than in LiteX, so the bus must hold the written
    data for one more clock. `addressed` is high while `bus` shows an access to the bank.
    """

    def __init__(self, bank, window, paging=CSR_PAGING):
        self.bus, self.addressed = Interface.like(bank.bus), Signal()

        number, in_window, selected = Signal(log2_int(paging // 4)), Signal(), Signal()
        self.comb += [
            in_window.eq(self.bus.adr[len(number):] == window),
            self.addressed.eq(in_window & (self.bus.re | self.bus.we)),
            # Synthesis reduces the bank's comparison with its window to `selected`: all other bits are constant.
            bank.bus.adr.eq(Cat(number, Mux(selected, window, window ^ 1))),
            bank.bus.dat_w.eq(self.bus.dat_w),
            self.bus.dat_r.eq(bank.bus.dat_r),
        ]
        self.sync += [
            # Only accesses select the bank. The bus also shows addresses of memory, whose lower bits can be those of the window: if the
            # clock of the bank stopped then, its data would stay on the bus.
            selected.eq(self.addressed),
            number.eq(self.bus.adr),
            bank.bus.we.eq(self.bus.we),
            bank.bus.re.eq(self.bus.re),
        ]


class RegisterBridge(LiteXModule):
    """Bridge for `RegisterStage`s: a Wishbone slave that accesses the bus of the banks. The Wishbone request must come from flip-flops.

        clock   0        1         2
        csr     access   address, written data stay
        bank             effect    data of a read
        wishbone                   acknowledgement
    """

    def __init__(self, bus_wishbone, bus_csr):
        self.wishbone, self.csr = bus_wishbone, bus_csr

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


class RegisterBus(LiteXModule):
    """The bridge and the stages of a SoC, in place of LiteX's bridge and of its interconnect between bridge and banks.

    `banks` is a function that returns the banks of LiteX's `CSRBankArray`. LiteX makes them when it finalizes the SoC, just before it
    finalizes its submodules. This module must be the SoC's first submodule, because it changes banks and parameters that are not yet
    finalized. It connects the memories of `PassParameters` with the bus, which takes less logic than the strobes of the registers.
    Registers with the attribute `clock_domain` have their bank in that domain, and `accessed` of such a register is set while the bus
    shows an access to the bank.
    """

    def __init__(self, banks):
        self._banks = banks
        self.bridge = RegisterBridge(
            wishbone.Interface(data_width=32, address_width=32, addressing="word"), Interface(data_width=32))

    def do_finalize(self):
        stages = []
        for _, registers, window, bank in self._banks():
            if bank.get_fragment_called:
                raise ValueError("the banks are finalized: expected RegisterBus as the first submodule of the SoC")
            stage = RegisterStage(bank, window)
            for parameters in {register.memory: None for register in registers if getattr(register, "memory", None)}:
                parameters.connect(stage, bank.simple_csrs)
            if domain := getattr(registers[0], "clock_domain", None):
                self.comb += registers[0].accessed.eq(stage.addressed)
                for part in (bank, stage):
                    ClockDomainsRenamer(domain)(part)
            self.submodules += stage
            stages.append(stage)
        self.interconnect = InterconnectShared([self.bridge.csr], [stage.bus for stage in stages])

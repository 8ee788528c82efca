"""Memory crossbar: shares LiteDRAM's controller among the ports, one command per clock."""

from functools import reduce
from operator import or_

from litedram.core.crossbar import LiteDRAMCrossbar
from migen import Array, Cat, If, Mux, Replicate, Signal

from .delay import delayed
from .round_robin import RoundRobin


def _select(index, values):
    """Returns element `index` of `values` through a tree of multiplexers, because synthesis needs more LUTs for a selection with
    many cases."""
    half = 2 ** (len(values) - 1).bit_length() // 2
    if len(values) == 1:
        return values[0]
    return Mux(index[half.bit_length() - 1], _select(index, values[half:]), _select(index, values[:half]))


class MemoryCrossbar(LiteDRAMCrossbar):
    """Replaces LiteDRAM's crossbar, and has the same interface for ports (`get_port`).

    LiteDRAM's crossbar has, for each bank, an arbiter and a multiplexer of all ports. Because memory accepts only one command
    per clock, this crossbar has a single arbiter, which passes one command per clock to the queues of the bank machines:

        ports ─▶ requests ─▶ turn ─▶ command ─▶ queues of the bank machines
                    ▲                                     │
                    └── bank and number of the commands ◀─┤ done
                        of each port                      │
        ports ◀── delays as long as those of the data ◀───┘

    The data of a port are in the order of its commands. A port therefore uses one bank at a time, and a bank serves one port at
    a time. A port keeps its bank until all its commands are done and it has no further command for this bank, as in LiteDRAM;
    then it may change to another bank. A bank executes its commands in the order in which they were taken from the ports.

    Latency from a port to the queue: 0 clocks, or one clock for a port that has just begun to request. `cmd.ready` depends
    combinationally on `cmd.addr` and on registers.

    While `injects` of the optional `injector` is high, its `words` are written instead of the ports' data.
    """

    def __init__(self, controller, injector=None):
        LiteDRAMCrossbar.__init__(self, controller)
        self.injector = injector

    def do_finalize(self):
        controller, ports = self.controller, self.masters
        settings = controller.settings
        if settings.address_mapping != "ROW_BANK_COL" or self.nranks != 1:
            raise ValueError("expected one rank of memory and addresses ROW_BANK_COL")
        column_bits = settings.geom.colbits - controller.address_align
        banks = [getattr(controller, f"bank{number}") for number in range(self.nbanks)]
        # Largest number of pending commands of a port; the queue of a bank holds all of them. The smaller this number, the shorter the
        # wait of a port before it changes to another bank; a command takes at least four clocks from its port to its completion.
        most = 5
        if most > self.cmd_buffer_depth:
            raise ValueError(f"expected queues of {most} commands, got {self.cmd_buffer_depth}")

        # The bank whose command completes in this clock. LiteDRAM's multiplexer completes at most one command per clock.
        done, done_read, done_write = Signal(self.bank_bits), Signal(), Signal()
        self.comb += [
            done.eq(reduce(or_, (Mux(bank.rdata_valid | bank.wdata_ready, number, 0) for number, bank in enumerate(banks)))),
            done_read.eq(reduce(or_, (bank.rdata_valid for bank in banks))),
            done_write.eq(reduce(or_, (bank.wdata_ready for bank in banks))),
        ]

        # The banks that ports own, and the port selected by the arbiter.
        owned = Signal(self.nbanks)
        self.submodules.turns = turns = RoundRobin(len(ports))
        turn = turns.turn
        wanted, allowed, answered, released = [], [], [], []
        for number, port in enumerate(ports):
            # The bank that the port owns. Bit n of `level` is set while the port has more than n pending commands for its bank.
            owner, place, level = Signal(), Signal(self.bank_bits), Signal(most)
            bank, stays, may, taken, ended, leaves = Signal(self.bank_bits), Signal(), Signal(), Signal(), Signal(), Signal()
            self.comb += [
                bank.eq(port.get_bank_address(self.bank_bits, column_bits)),
                stays.eq(owner & (place == bank)),
                may.eq(Mux(stays, ~level[-1], ~level[0] & ~Array(owned[i] for i in range(self.nbanks))[bank])),
                port.cmd.ready.eq(turn[number] & may),
                taken.eq(port.cmd.valid & port.cmd.ready),
                ended.eq(level[0] & (place == done) & (done_read | done_write)),
                # The port releases the bank when it has no command for it.
                leaves.eq(owner & ~level[0] & ~(port.cmd.valid & stays)),
            ]
            # Written without clock enables: flip-flops with different enables cannot share a slice of the FPGA.
            grown, shrunk = Cat(1, level[:-1]), Cat(level[1:], 0)
            self.sync += [
                If(taken, place.eq(bank)),
                owner.eq(taken | (owner & ~leaves)),
                level.eq((level | (grown & Replicate(taken & ~ended, most))) & (shrunk | ~Replicate(ended & ~taken, most))),
            ]
            wanted.append(bank)
            allowed.append(port.cmd.valid & may)
            answered.append(ended)
            released.append(Mux(leaves, 1 << place, 0))

        # Passes the command of the selected port. The arbiter then selects the next port with a permitted command whose bank the passed
        # command does not take.
        def selected(values):
            """Returns the value of the selected port."""
            return reduce(or_, (Replicate(mine, len(value)) & value for mine, value in zip(turn, values, strict=True)))

        valid, bank = Signal(), Signal(self.bank_bits)
        passed, is_write, address = Signal(self.nbanks), Signal(), Signal(self.rca_bits)
        self.comb += [
            turns.wants.eq(Cat(*(may & ~(valid & (bank == other)) for may, other in zip(allowed, wanted)))),
            valid.eq(selected(allowed)),
            bank.eq(selected(wanted)),
            passed.eq(Mux(valid, 1 << bank, 0)),
            is_write.eq(selected([port.cmd.we for port in ports])),
            address.eq(selected([port.get_row_column_address(self.bank_bits, self.rca_bits, column_bits) for port in ports])),
        ]
        self.sync += owned.eq((owned & ~reduce(or_, released)) | passed)
        for number, machine in enumerate(banks):
            self.comb += [machine.valid.eq(passed[number]), machine.we.eq(is_write), machine.addr.eq(address)]

        writers, writer = [], 0
        for port, ended in zip(ports, answered):
            if port.mode != "write":
                self.comb += port.rdata.valid.eq(delayed(self, ended & done_read, self.read_latency))
                self.comb += port.rdata.data.eq(controller.rdata)
            if port.mode != "read":
                self.comb += port.wdata.ready.eq(delayed(self, ended & done_write, self.write_latency))
                writer |= Mux(ended, len(writers), 0)
                writers.append(port)
        # Memory ignores data and strobes outside of writes, so those of any port may be selected then.
        writer = delayed(self, writer, self.write_latency)
        words, strobes = ([getattr(port.wdata, name) for port in writers] for name in ("data", "we"))
        if self.injector:
            words, strobes = [*words, self.injector.words], [*strobes, Replicate(1, len(controller.wdata_we))]
            writer = Mux(self.injector.injects, len(writers), writer)
        chosen = Signal(max=max(len(words), 2))
        self.comb += [
            chosen.eq(writer),
            controller.wdata.eq(_select(chosen, words)),
            controller.wdata_we.eq(_select(chosen, strobes)),
        ]

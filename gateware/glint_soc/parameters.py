"""Parameter registers that only the gateware reads."""

from functools import reduce
from itertools import pairwise
from operator import or_

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSR, CSRStorage
from migen import READ_FIRST, Case, Cat, Constant, If, Memory, Mux, Signal

from .register_map import CSR_PAGING


_LOADS = 128
"""Largest number of flip-flops per enable."""


class Parameter(CSRStorage):
    """A register of up to 32 bits that the CPU writes and that reads as 0.

    Read access would take a LUT for every three bits in the read multiplexer of the block. The content has no reset:
    software writes it before the gateware uses it.
    """

    def __init__(self, *arguments, description, **options):
        super().__init__(*arguments, description=f"{description} Reads as 0.", reset_less=True, **options)
        self.register = CSR(self.size, self.name)
        # The `PassParameters` whose memory stores the register, and which then drives `storage`.
        self.memory = None

    def do_finalize(self, busword, ordering):
        if self.size > busword:
            raise ValueError(f"{self.name}: {self.size} bits, expected at most {busword}")
        register = self.register
        self.simple_csrs.append(register)
        if self.memory is None:
            self.sync += [If(register.re, self.storage.eq(register.r)), self.re.eq(register.re)]


def without_reading(storage):
    """Returns a replacement for a `CSRStorage` of a LiteX core. The replacement has the same content and address, but reads as
    0."""
    register = Parameter(storage.size, name=storage.name, description=f"{storage.description.removesuffix('.')}.")
    register.storage, register.re = storage.storage, storage.re
    if hasattr(storage, "fields"):
        register.fields = storage.fields
    # LiteX sorts the registers of a core by these numbers.
    register.duid = storage.duid
    return register


def driven_bits(module, register, bits, lowest=0):
    """Returns a signal for `bits` bits of a `CSRStatus` of `module`, from bit `lowest` on. The register's other bits are 0: if an instance
    drove only a part of the register, they would have no driver, and other simulators would read an undefined value."""
    driven = Signal(bits, name=f"{register.name}_bits")
    module.comb += register.status.eq(Cat(Constant(0, lowest), driven) if lowest else driven)
    return driven


class PassParameters(LiteXModule):
    """The parameters of the passes of a block: registers that software may write at any time, and copies that are constant during a pass.

    Each of `passes` lists the `Parameter`s of one pass. `load[k]` (one clock) requests the copies of pass k. `loading[k]` is high
    from the next clock until they are complete: one register is copied in a clock, one pass after another. `copies[k]` maps the
    registers of pass k to their copies, because a register of several passes has a copy in each of them. `storage` of a register
    is its copy in the first of its passes.

    The registers are words of a block RAM. In any SoC, their strobes write it, one clock after an access to the register. A SoC may
    instead call `connect` before this module is finalized. The copies of a pass are a chain with a common
    enable, which is duplicated so that each duplicate drives at most `_LOADS` flip-flops. The widest copy is next to the memory, so
    the chain needs no flip-flops other than the bits of the copies.

        registers ─▶ words ─▶ widest copy ─▶ … ─▶ narrowest copy
    """

    def __init__(self, *passes):
        chains = [sorted(registers, key=lambda register: register.size) for registers in passes]
        self.load, self.loading = Signal(len(chains)), Signal(len(chains))
        self.copies = []
        for chain in chains:
            self.copies.append({register: Signal(register.size, name=f"{register.name}_copy", reset_less=True)
                                if register.memory else register.storage for register in chain})
            for register in chain:
                register.memory = self

        words = Memory(32, CSR_PAGING // 4)
        self._write, self._read = words.get_port(write_capable=True), words.get_port(mode=READ_FIRST)
        self.specials += words, self._write, self._read

        # `turn` is the index in `order` of the word that is being read. The word moves into its chain one clock later.
        self._order = [register for chain in chains for register in chain]
        self._turn = turn = Signal(max=len(self._order))
        waiting, reading, moving = (Signal(len(chains)) for _ in range(3))
        ends = [sum(map(len, chains[:k + 1])) for k in range(len(chains))]
        is_last = reduce(or_, [turn == end - 1 for end in ends])
        step = If(reading != 0, turn.eq(turn + 1), If(is_last, reading.eq(0)))
        for k, (chain, end) in enumerate(zip(chains, ends, strict=True)):
            step = step.Elif(waiting[k], turn.eq(end - len(chain)), reading[k].eq(1), waiting[k].eq(self.load[k]))
        self.comb += self.loading.eq(waiting | reading | moving)
        self.sync += [waiting.eq(waiting | self.load), step, moving.eq(reading)]
        for k, copies in enumerate(self.copies):
            loads = _LOADS
            for copy, wider in pairwise([*copies.values(), self._read.dat_r]):
                if loads + len(copy) > _LOADS:
                    # A duplicate of `moving[k]`. It depends on itself, because synthesis would otherwise merge flip-flops with equal
                    # inputs.
                    moves, loads = Signal(name=f"moves_{k}", reset_less=True, attr={"keep"}), 0
                    self.sync += moves.eq(reading[k] & (moves | ~moving[k]))
                loads += len(copy)
                self.sync += If(moves, copy.eq(wider))

        self._is_connected = False

    def connect(self, stage, registers):
        """Connects the memory with the bus of `stage`, a `RegisterStage`, instead of the strobes of the registers: a word for each of
        `registers`, those of the bank behind the stage. This takes less logic, because the address on the bus is that of the word."""
        self._is_connected = True
        self._connect([registers.index(register.register) for register in self._order],
                      stage.bus.adr, stage.bus.dat_w, stage.bus.we & stage.addressed)

    def do_finalize(self):
        if self._is_connected:
            return
        # Flip-flops shorten the path from the bus. Strobes of LiteX's banks are combinational.
        registers = list(dict.fromkeys(self._order))
        number, data, writes = Signal(max=len(registers)), Signal(32), Signal()
        strobes = [register.register.re for register in registers]
        self.sync += [
            number.eq(reduce(or_, (Mux(strobe, place, 0) for place, strobe in enumerate(strobes)))),
            # Every register of a bank shows the same written data.
            data.eq(max(registers, key=lambda register: register.size).register.r),
            writes.eq(reduce(or_, strobes)),
        ]
        self._connect([registers.index(register) for register in self._order], number, data, writes)

    def _connect(self, numbers, address, data, writes):
        """Connects the ports of the memory. `numbers` are the addresses of the words of `_order`."""
        self.comb += [
            self._write.adr.eq(address),
            self._write.dat_w.eq(data),
            self._write.we.eq(writes),
            Case(self._turn, {turn: self._read.adr.eq(number) for turn, number in enumerate(numbers)}),
        ]

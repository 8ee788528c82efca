"""Parameter registers that only the gateware reads."""

from functools import reduce
from itertools import pairwise
from operator import or_

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSR, CSRStorage
from migen import READ_FIRST, Case, If, Memory, Signal

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
        # Whether the register is stored in the memory of a `PassParameters` object, which then drives `storage`.
        self.in_memory = False

    def do_finalize(self, busword, ordering):
        if self.size > busword:
            raise ValueError(f"{self.name}: {self.size} bits, expected at most {busword}")
        register = CSR(self.size, self.name)
        self.simple_csrs.append(register)
        if not self.in_memory:
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


class PassParameters(LiteXModule):
    """The parameters of the passes of a block: registers that software may write at any time, and copies that are constant during a pass.

    Each of `passes` lists the `Parameter`s of one pass. `load[k]` (one clock) requests the copies of pass k. `loading[k]` is high
    from the next clock until they are complete: one register is copied in a clock, one pass after another. `copies[k]` maps the
    registers of pass k to their copies, because a register of several passes has a copy in each of them. `storage` of a register
    is its copy in the first of its passes.

    The registers are words of a block RAM as large as the block's window of the bus. The copies of a pass are a chain with a common
    enable, which is duplicated so that each duplicate drives at most `_LOADS` flip-flops. The widest copy is next to the memory, so
    the chain needs no flip-flops other than the bits of the copies.

        bus ─▶ words ─▶ widest copy ─▶ … ─▶ narrowest copy
    """

    def __init__(self, *passes):
        chains = [sorted(registers, key=lambda register: register.size) for registers in passes]
        self.load, self.loading = Signal(len(chains)), Signal(len(chains))
        self.copies = []
        for chain in chains:
            self.copies.append({register: Signal(register.size, name=f"{register.name}_copy", reset_less=True)
                                if register.in_memory else register.storage for register in chain})
            for register in chain:
                register.in_memory = True

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

    def connect(self, bank):
        """Returns the statements that connect the memory with the block's register bank."""
        address, bus = self._write.adr, bank.bus
        numbers = [bank.simple_csrs.index(register.simple_csrs[0]) for register in self._order]
        return [
            address.eq(bus.adr),
            self._write.dat_w.eq(bus.dat_w),
            self._write.we.eq(bus.we & bank.addressed),
            Case(self._turn, {turn: self._read.adr.eq(number) for turn, number in enumerate(numbers)}),
        ]

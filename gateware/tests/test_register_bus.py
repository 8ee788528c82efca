"""Test of the stages before register banks and of their bridge: accesses of the CPU's bus to two banks, one after the other."""

import random

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRStatus, CSRStorage
from litex.soc.interconnect.csr_bus import CSRBank, Interface

from glint_soc.register_bus import RegisterBus
from glint_soc.register_map import CSR_PAGING
from memory_bench import access
from simulation import run_simulation

# Windows of the two banks. LiteX's bridge leaves the address 0, in the first window, between accesses.
_WINDOWS = (0, 9)
_REGISTERS = 5


class _Soc(LiteXModule):
    """A bridge, stages and two banks, each with registers that the CPU writes and a register that counts the writes to the first of them."""

    def __init__(self):
        self.registers, banks = [], []
        self.register_bus = RegisterBus(lambda: banks)
        self.bus = self.register_bus.bridge.wishbone
        for window in _WINDOWS:
            storages = [CSRStorage(32, name=f"storage{number}") for number in range(_REGISTERS)]
            writes = CSRStatus(32, name="writes", description="")
            self.sync += writes.status.eq(writes.status + storages[0].re)
            self.registers.append(storages)
            bank = CSRBank([*storages, writes], window, Interface(data_width=32), CSR_PAGING)
            self.submodules += bank
            banks.append((f"bank{window}", [*storages, writes], window, bank))


def test_accesses():
    """Checks that each write reaches only its register, once, and that a read returns the last written value."""
    rng = random.Random(1)
    soc = _Soc()
    written = [[0] * _REGISTERS for _ in _WINDOWS]
    writes, problems = [0, 0], []

    def at(bank, number, value=None):
        found, = yield from access(soc.bus, _WINDOWS[bank] * CSR_PAGING // 4 + number, data=value)
        for _ in range(rng.randrange(3)):
            yield
        return found

    def accesses():
        for _ in range(300):
            bank, number = rng.randrange(2), rng.randrange(_REGISTERS + 1)
            if number < _REGISTERS and rng.randrange(2):
                written[bank][number] = rng.getrandbits(32)
                writes[bank] += number == 0
                yield from at(bank, number, written[bank][number])
                continue
            expected = written[bank][number] if number < _REGISTERS else writes[bank]
            if (found := (yield from at(bank, number))) != expected:
                problems.append(f"register {number} of bank {bank}: expected {expected:#x}, got {found:#x}")

    run_simulation(soc, accesses())
    assert not problems


def test_addresses_of_memory():
    """Checks that an address without an access, as the bus shows it during accesses to memory, puts no data on the bus."""
    soc = _Soc()
    found = []

    def accesses():
        address = _WINDOWS[1] * CSR_PAGING // 4
        yield from access(soc.bus, address, data=0x1234)
        yield soc.bus.adr.eq(address)
        for _ in range(8):
            yield
            found.append((yield soc.register_bus.bridge.csr.dat_r))

    run_simulation(soc, accesses())
    # The written register may still be on the bus for a clock after the access.
    assert not any(found[1:]), found

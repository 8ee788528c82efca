"""The DDR3 memory of the virtual board, with its PHY, as LiteDRAM's controller sees both."""

from litedram.phy.dfi import Interface
from litedram.phy.model import get_sdram_phy_settings
from litex.gen import LiteXModule
from migen import Cat, If, Memory, Mux, Signal, log2_int

from .delay import delayed

# Commands by their levels of ras_n, cas_n and we_n, ras_n in the lowest bit.
_ACTIVATE, _READ, _WRITE = 0b110, 0b101, 0b001


class MemoryModel(LiteXModule):
    """Memory behind the DFI port `dfi`, with the phases and latencies of LiteDRAM's PHY model.

    LiteDRAM's model has a separate memory and data path for each bank. This model has a single memory, which makes the simulation faster,
    with the words in the order of their addresses: row, bank, column. It makes two assumptions about the controller: a cycle has at most
    one command of each kind, and the row of a bank is open when the bank is read or written.
    """

    def __init__(self, module, data_width, clk_freq):
        self.module = module
        self.settings = settings = get_sdram_phy_settings(module.memtype, data_width, clk_freq)
        geometry = module.geom_settings
        self.dfi = Interface(geometry.addressbits, geometry.bankbits, settings.nranks, settings.dfi_databits, settings.nphases)

        phases = self.dfi.phases
        width = settings.dfi_databits*settings.nphases
        columns_of_word = log2_int(width//data_width)
        activate, activated_bank, activated_row = self._command(_ACTIVATE)
        read, read_bank, read_column = self._command(_READ)
        write, write_bank, write_column = self._command(_WRITE)

        rows = Memory(geometry.rowbits, 2**geometry.bankbits)
        opening = rows.get_port(write_capable=True)
        self.specials += rows, opening
        self.comb += [opening.adr.eq(activated_bank), opening.dat_w.eq(activated_row), opening.we.eq(activate)]

        def address(bank, column):
            """Returns the address of a word in the open row of its bank."""
            row = rows.get_port(async_read=True)
            self.specials += row
            self.comb += row.adr.eq(bank)
            return Cat(column[columns_of_word:geometry.colbits], bank, row.dat_r)

        # The harness finds the memory by its name.
        memory = Memory(width, 2**(geometry.rowbits + geometry.bankbits + geometry.colbits - columns_of_word), name="ddr3")
        reading, before, writing = memory.get_port(async_read=True), memory.get_port(async_read=True), memory.get_port(write_capable=True)
        self.specials += memory, reading, before, writing

        # Read data are output `read_latency` cycles after the command; write data come `write_latency` cycles after the command.
        data, place = Signal(width), Signal(len(writing.adr))
        self.comb += [
            reading.adr.eq(address(read_bank, read_column)),
            If(read, data.eq(reading.dat_r)),
            Cat(*(phase.rddata for phase in phases)).eq(delayed(self, data, settings.read_latency)),
            Cat(*(phase.rddata_valid for phase in phases)).eq(delayed(self, read, settings.read_latency)),
            place.eq(address(write_bank, write_column)),
            writing.we.eq(delayed(self, write, settings.write_latency)),
            writing.adr.eq(delayed(self, place, settings.write_latency)),
            before.adr.eq(writing.adr),
        ]
        # Writes whole words, because the simulation checks each write enable in each cycle.
        new = Cat(*(phase.wrdata for phase in phases))
        is_kept = Cat(*(phase.wrdata_mask for phase in phases))
        merged = (Mux(is_kept[i], before.dat_r[8*i:8*(i + 1)], new[8*i:8*(i + 1)]) for i in range(width//8))
        self.comb += If(writing.we, writing.dat_w.eq(Cat(*merged)))

    def _command(self, levels):
        """Returns whether a phase issues the command with these levels, and the bank and address of the command."""
        phases = self.dfi.phases
        issued, bank, address = Signal(), Signal.like(phases[0].bank), Signal.like(phases[0].address)
        for phase in phases:
            self.comb += If(~phase.cs_n & (Cat(phase.ras_n, phase.cas_n, phase.we_n) == levels),
                issued.eq(1), bank.eq(phase.bank), address.eq(phase.address))
        return issued, bank, address

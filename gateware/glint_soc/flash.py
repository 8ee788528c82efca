"""SPI flash as memory-mapped, read-only memory of the CPU (rtl/flash)."""

from litex.gen import LiteXModule
from litex.soc.interconnect import wishbone
from migen import ClockSignal, If, Instance, ResetSignal, Signal, log2_int
from migen.fhdl.specials import Tristate

from .constants import FLASH_BYTES
from .rtl import add_sources


class FlashReader(LiteXModule):
    """Wishbone slave that reads words of the flash on `pads`. Writes have no effect.

    `pads` has `cs_n` and one of two sets of pins. On a 7-series FPGA that is configured from this flash these are `reset_n` and the
    four data lines `dq`; on the virtual board, the clock and separate data lines for each direction. Lines that do not carry a bit are
    driven or pulled high: a flash that is not yet switched to four data lines interprets a low level on them as hold or as write
    protection.
    """

    def __init__(self, platform, pads):
        self.bus = bus = wishbone.Interface(data_width=32, address_width=32, addressing="word")

        address_bits = log2_int(FLASH_BYTES // 4)
        done, sclk, command, sending, lines = Signal(), Signal(), Signal(), Signal(), Signal(4)
        self.comb += bus.ack.eq(done & bus.cyc & bus.stb)
        self.specials += Instance("flash_reader", name="flash_core",
            p_ADDRESS_BITS = address_bits,
            i_clk     = ClockSignal("sys"),
            i_rst     = ResetSignal("sys"),
            i_request = bus.cyc & bus.stb,
            i_address = bus.adr[:address_bits],
            o_done    = done,
            o_data    = bus.dat_r,
            o_cs_n    = pads.cs_n,
            o_sclk    = sclk,
            o_command = command,
            o_sending = sending,
            i_lines   = lines,
        )
        add_sources(platform, "flash_reader")
        if hasattr(pads, "clk"):
            self.comb += [
                pads.clk.eq(sclk),
                lines.eq(pads.dq_in),
                pads.dq_out.eq(0b1111),
                If(sending, pads.dq_out[0].eq(command)),
            ]
        else:
            # Otherwise the unused pin would reset the flash.
            self.comb += pads.reset_n.eq(1)
            self.specials += [
                *(Tristate(pads.dq[k], o=command if k == 0 else 1, oe=sending, i=lines[k]) for k in range(4)),
                # The clock pin is the configuration clock CCLK.
                Instance("STARTUPE2",
                    i_CLK       = 0,
                    i_GSR       = 0,
                    i_GTS       = 0,
                    i_KEYCLEARB = 0,
                    i_PACK      = 0,
                    i_USRCCLKO  = sclk,
                    i_USRCCLKTS = 0,
                    i_USRDONEO  = 1,
                    i_USRDONETS = 1,
                ),
            ]

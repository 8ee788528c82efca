"""HDMI from general-purpose outputs of an ECP5: TMDS channels of ten bits per pixel, serialized by registers and DDR outputs."""

from litex.build.io import DDROutput
from litex.gen import ClockDomainsRenamer, LiteXModule
from litex.soc.cores.code_tmds import TMDSEncoder
from migen import Cat, ClockSignal, If, Signal


class Serializer(LiteXModule):
    """Sends ten-bit `words`, one per clock of the domain `pix`, as `pairs` of bits, one pair per clock of `pix5x`, the lowest bits first.

    `pix5x` has five times the frequency of `pix` and comes from the same PLL. LiteX's serializer has a FIFO and a gearbox, whose
    paths are too long for `pix5x` in a full FPGA.

         pix:  words, stable for five clocks of pix5x ───────┐
               toggle ──▶ edge detection ──▶ load ──▶ shift registers ──▶ pairs
    """

    def __init__(self, words):
        self.pairs = []
        # `toggle` changes when new words begin. `load` is high in the second clock after a change, far from the next change.
        toggle, seen, load = Signal(), Signal(2), Signal()
        self.sync.pix += toggle.eq(~toggle)
        self.sync.pix5x += [seen.eq(Cat(toggle, seen[0])), load.eq(seen[0] ^ seen[1])]
        for word in words:
            # Each channel has its own shift register, because the output pins are far apart and far from the other logic.
            bits, pair = Signal(10), Signal(2)
            self.sync.pix5x += [If(load, bits.eq(word)).Else(bits.eq(bits[2:])), pair.eq(bits[:2])]
            self.pairs.append(pair)


class Ecp5HDMI(LiteXModule):
    """Sends `video` (`VIDEO_LAYOUT` of the scan-out), one pixel per clock of the domain `pix`, to `pads`, the positive pins of the
    TMDS pairs. `sync_low` inverts both syncs."""

    def __init__(self, video, pads, sync_low):
        syncs = Cat(*(~signal if sync_low else signal for signal in (video.hsync, video.vsync)))
        words = []
        for colour, control in (("b", syncs), ("g", 0), ("r", 0)):
            encoder = ClockDomainsRenamer("pix")(TMDSEncoder())
            self.add_module(name=f"{colour}_encoder", module=encoder)
            self.comb += [encoder.d.eq(getattr(video, colour)), encoder.c.eq(control), encoder.de.eq(video.de)]
            words.append(encoder.out)
        self.serializer = Serializer(words)
        for channel, pair in enumerate(self.serializer.pairs):
            self.specials += DDROutput(pair[0], pair[1], getattr(pads, f"data{channel}_p"), ClockSignal("pix5x"))
        self.specials += DDROutput(1, 0, pads.clk_p, ClockSignal("pix"))

"""Register block of the scan-out (rtl/scanout): shows a frame in memory as video."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import ClockSignal, Instance, Record, ResetSignal, Signal

from .counters import Counters
from .parameters import driven_bits
from .rtl import add_sources

IDENT = int.from_bytes(b"SCAN", "big")

VIDEO_LAYOUT = [("hsync", 1), ("vsync", 1), ("de", 1), ("r", 8), ("g", 8), ("b", 8)]

# Number of address bits of a 16-byte word in the CPU's 32-bit address space. The memory port uses only the lowest of them.
_WORD_ADDRESS_BITS = 28


class Scanout(LiteXModule):
    """Reads the front RGB565 frame through `port`, a native 128-bit LiteDRAM read port in the domain `sys`.

    `video` (`VIDEO_LAYOUT`) is the output, one pixel per clock of the domain `pix`, with the timing of `mode` (a `VideoMode`), both
    syncs active high. It runs as soon as that domain leaves reset, and is black until the scan-out is enabled.
    """

    def __init__(self, platform, port, mode):
        if port.data_width != 128:
            raise ValueError(f"scan-out needs a memory port of 128 bits, got {port.data_width}")
        self.video = Record(VIDEO_LAYOUT)
        self.constants = {
            "screen_width": (mode.width, "Pixels of a line of the screen."),
            "screen_height": (mode.height, "Lines of the screen."),
            "frame_ticks": (mode.frame_ticks, "Ticks of the pixel clock in a frame, with its blanking."),
            "pixel_clock": (int(mode.clk_freq), "Frequency of the pixel clock in Hz."),
        }

        self._ident = CSRStatus(32, name="ident", reset=IDENT, description="`SCAN` in ASCII; 0 where the block is absent.")
        self._caps = CSRStatus(name="caps", fields=[
            CSRField("width", size=12, offset=0, reset=mode.width, description="Pixels of an output line."),
            CSRField("height", size=12, offset=12, reset=mode.height, description="Lines of an output frame."),
            CSRField("scales", size=3, offset=24, reset=mode.scales,
                     description="Bit k is set if the scale 2^k is supported."),
        ], description="Capabilities of this build.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("enable", description="1: show the frame. 0: show a black picture; the syncs continue. Latched at vblank."),
        ], description="Operation.")
        self._status = CSRStatus(name="status", fields=[
            CSRField("enabled", offset=0, description="The frame is shown: `enable` as latched at the last vblank."),
            CSRField("fetching", offset=1, description="A source line is read from memory."),
            CSRField("scale", size=3, offset=4, description="Scale, as latched at the last vblank."),
            CSRField("error", size=2, offset=8, values=[
                ("0", "none", "no error"),
                ("1", "scale", "`scale` was not 1, 2 or 4 at the last vblank; the previous scale stays"),
                ("2", "underflow", "a line was late in the last frame, see `underflow_count`"),
            ], description="Error of the last frame, updated at each vblank."),
        ], description="State.")
        self.ev = EventManager()
        self.ev.vblank = EventSourcePulse(
            name="vblank", description="Start of vertical blanking: `fb_next`, `scale` and `control` are latched.")
        self.ev.finalize()
        self._fb_next = CSRStorage(32, name="fb_next", description="Byte address of the frame to show next, a multiple of "
            "16 (the low four bits are ignored): (width/scale) x (height/scale) pixels of RGB565, row by row. Latched at "
            "vblank for the whole next frame.")
        self._scale = CSRStorage(3, reset=4, name="scale", description="Enlargement: a pixel of the frame is shown as a square of "
            "scale x scale pixels: `width` of `caps` divided by the width of the frame. Latched at vblank.")
        self._fb_current = CSRStatus(32, name="fb_current", description="Byte address of the frame that is shown, or, in "
            "vertical blanking, of the next frame. A frame buffer that is neither this nor `fb_next` is free for drawing.")
        self._frame_count = CSRStatus(32, name="frame_count", description="Vertical blankings since reset, modulo 2^32.")
        self._underflow_count = CSRStatus(32, name="underflow_count", description="Source lines that arrived too late from memory, "
            "modulo 2^32. The previous line is shown again, or black in the first line.")
        # A reset clears the two counters above, but not the following counters.
        self.growing = Counters(self, {
            "cycles_busy": "Clock cycles of line fetches.",
            "cycles_stalled": "Clock cycles in which memory refused a command.",
            "items_in": "Words of 16 bytes read from memory.",
            "items_out": "Source lines fetched.",
        })
        self.counters = ["frame_count", "underflow_count", *self.growing.registers]

        enabled, fetching, error = Signal(), Signal(), Signal(2)
        scale_current = Signal(3)
        cmd_addr = Signal(_WORD_ADDRESS_BITS)
        self.comb += [
            self._status.fields.enabled.eq(enabled),
            self._status.fields.fetching.eq(fetching),
            self._status.fields.scale.eq(scale_current),
            self._status.fields.error.eq(error),
            port.cmd.we.eq(0),
            port.cmd.addr.eq(cmd_addr),
            port.rdata.ready.eq(1),
            self.growing.events["cycles_busy"].eq(fetching),
        ]
        self.specials += Instance("scanout", name="scanout_core",
            p_ADDRESS_BITS    = _WORD_ADDRESS_BITS,
            **mode.parameters(),
            i_sys_clk         = ClockSignal("sys"),
            i_sys_rst         = ResetSignal("sys"),
            i_pix_clk         = ClockSignal("pix"),
            i_pix_rst         = ResetSignal("pix"),
            i_enable          = self._control.fields.enable,
            i_scale           = self._scale.storage,
            i_frame_base      = self._fb_next.storage[4:],
            o_enabled         = enabled,
            o_scale_current   = scale_current,
            o_frame_current   = driven_bits(self, self._fb_current, _WORD_ADDRESS_BITS, 4),
            o_fetching        = fetching,
            o_error           = error,
            o_vblank          = self.ev.vblank.trigger,
            o_frames          = self._frame_count.status,
            o_underflows      = self._underflow_count.status,
            o_stalled         = self.growing.events["cycles_stalled"],
            o_word_came       = self.growing.events["items_in"],
            o_line_ended      = self.growing.events["items_out"],
            o_cmd_valid       = port.cmd.valid,
            i_cmd_ready       = port.cmd.ready,
            o_cmd_addr        = cmd_addr,
            i_rdata_valid     = port.rdata.valid,
            i_rdata           = port.rdata.data,
            **{f"o_video_{name}": getattr(self.video, name) for name, _ in VIDEO_LAYOUT},
        )
        add_sources(platform, "scanout")

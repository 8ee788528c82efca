"""Register block of the gesture engine (rtl/gesture): finds a hand in the frames of an image sensor by its colour."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import ClockSignal, Instance, ResetSignal, Signal
from migen.fhdl.specials import Tristate

from .clock_control import ClockControl
from .counters import Counters
from .packed import Enumeration, Package, Struct
from .parameters import Parameter
from .rtl import add_sources

IDENT = int.from_bytes(b"GEST", "big")

MAX_WIDTH, MAX_HEIGHT = 1280, 720

CAMERA_CLOCK = 25e6
"""Largest frequency of the sensor's input clock in Hz. The OV5640 takes up to 27 MHz, the OV7670 more."""

PIXEL_CLOCK = 66e6
"""Largest frequency of the sensor's clock PCLK in Hz, for the boards' constraints. 640x480 at 60 Hz takes some 49 MHz."""

SNAPSHOT_WORDS = 2048

_PRODUCT_BITS = 40
"""Bits of the sums of products."""

CHANNELS = Enumeration("channel", "Channels of a pixel, 8 bits each.", {
    "red": "red",
    "green": "green",
    "blue": "blue",
    "luma": "luma, 0.299 red + 0.587 green + 0.114 blue",
    "cr": "chroma towards red, 128 for grey",
    "cb": "chroma towards blue, 128 for grey",
})

FAULTS = Enumeration("fault", "Faults of a frame.", {
    "none": "the frame was whole",
    "pixels": "a line was too short or too long",
    "byte": "a line had an odd number of bytes",
    "lines": "the frame had too few or too many lines",
    "cut": "VSYNC came inside a line",
    "lost": "pixels came faster than the engine takes them",
    "stopped": "the sensor's clock stopped",
})


def _range(name, text, unit):
    return Parameter(name=name, fields=[
        CSRField("first", size=11, offset=0, description=f"First {unit}."),
        CSRField("last", size=11, offset=16, description=f"Last {unit}, which belongs to the region."),
    ], description=text)


def _window(name, channel):
    return Parameter(name=name, fields=[
        CSRField("lower", size=8, offset=0, description="Least value in the window."),
        CSRField("upper", size=8, offset=8, description="Greatest value in the window."),
        CSRField("channel", size=CHANNELS.bits, offset=16, values=CHANNELS.values, description="Channel of the pixel."),
    ], description=f"{channel} window of the hand's colour: a pixel is marked if its channels are in both windows.")


def clock_divider(sys_clk_freq):
    """Returns the even number by which the system clock is divided for the image sensor."""
    return 2 * -int(-sys_clk_freq // (2 * CAMERA_CLOCK))


class GestureEngine(LiteXModule):
    """Takes the frames of the image sensor on `pads`. `moments` builds the sums of products.

    `pads` has `pclk`, `href`, `vsync`, `d` and `xclk`; `reset_n` and `power_down` where the adapter has them; and the wires of the
    camera's bus, as `scl` and `sda` or for a harness as `scl_in`, `scl_out`, `sda_in`, `sda_out`.
    """

    def __init__(self, platform, pads, sys_clk_freq, moments=False):
        divider = clock_divider(sys_clk_freq)
        # The boards constrain the sensor's clock.
        self.pclk = pads.pclk

        self._ident = CSRStatus(32, name="ident", reset=IDENT, description="`GEST` in ASCII; 0 where the block is absent.")
        self._caps = CSRStatus(name="caps", fields=[
            CSRField("width", size=11, offset=0, reset=MAX_WIDTH, description="Most pixels of a line."),
            CSRField("height", size=10, offset=12, reset=MAX_HEIGHT, description="Most lines of a frame."),
            CSRField("clock_divider", size=4, offset=24, reset=divider, description="The sensor's input clock is the system clock "
                     "divided by this."),
            CSRField("moments", offset=28, reset=int(moments), description="The sums of products are built."),
        ], description="Capabilities of this build.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("enable", offset=0, description="Take frames. The first one begins at the next VSYNC."),
            CSRField("vsync_low", offset=1, description="VSYNC is low between frames, and high during a frame."),
            CSRField("href_low", offset=2, description="HREF is low during a line."),
            CSRField("swap", offset=3, description="The first byte of a pixel is the low one."),
            CSRField("falling", offset=4, description="Sample the pins at the falling edge of the sensor's clock."),
        ], description="Operation. Software changes the fields other than `enable` while `enable` is 0.")
        self._camera = CSRStorage(name="camera", fields=[
            CSRField("clock", offset=0, description="Drive the sensor's input clock."),
            CSRField("reset", offset=1, reset=1, description="Hold the image sensor in reset, where the adapter has this pin."),
            CSRField("power_down", offset=2, reset=1, description="Power the image sensor down, where the adapter has this pin."),
            CSRField("scl", offset=8, reset=1, description="SCL of the sensor's bus: 0 pulls the wire low, 1 releases it."),
            CSRField("sda", offset=9, reset=1, description="SDA of the sensor's bus, in the same way."),
        ], description="Pins of the image sensor. Software moves the wires of its bus (SCCB).")
        self._size = Parameter(name="size", fields=[
            CSRField("width", size=11, offset=0, description="Pixels of a line, 1 to 1280."),
            CSRField("height", size=10, offset=16, description="Lines of a frame, 1 to 720."),
        ], description="Size of a whole frame. This register and those of windows, region and run are taken at the start of "
                       "each frame.")
        self._window_a = _window("window_a", "First")
        self._window_b = _window("window_b", "Second")
        self._region_x = _range("region_x", "Columns of the region: pixels outside do not count.", "column")
        self._region_y = _range("region_y", "Lines of the region.", "line")
        self._least_run = Parameter(4, name="least_run", description="A marked pixel counts if it is one of at least this many in "
                                    "a row, in the region. 0 is 1.")
        self._status = CSRStatus(name="status", fields=[
            CSRField("running", offset=0, description="The sensor's clock has ticked in the last 4096 clocks."),
            CSRField("waiting", offset=1, description="Enabled, and no frame has begun yet."),
            CSRField("vsync", offset=2, description="State of VSYNC."),
            CSRField("href", offset=3, description="State of HREF."),
            CSRField("scl", offset=4, description="State of the bus's SCL."),
            CSRField("sda", offset=5, description="State of the bus's SDA."),
            CSRField("fault", size=FAULTS.bits, offset=8, values=FAULTS.values, description="First fault of the last frame."),
        ], description="State.")
        self._seen = CSRStatus(name="seen", fields=[
            CSRField("pixels", size=11, offset=0, description="Pixels of the last line."),
            CSRField("lines", size=11, offset=16, description="Lines of the last frame, whole or not."),
        ], description="What the image sensor sends. A count stays at its largest value.")
        self.ev = EventManager()
        self.ev.frame = EventSourcePulse(name="frame", description="The results of a whole frame are in the registers.")
        self.ev.finalize()
        self._sequence = CSRStatus(16, name="sequence", description="Whole frames since reset, modulo 2^16. Results are of one "
                                   "frame if this number is the same before and after reading them.")
        self._count = CSRStatus(20, name="count", description="Pixels that count.")
        self._sum_x = CSRStatus(30, name="sum_x", description="Sum of their columns, the first column is 0.")
        self._sum_y = CSRStatus(29, name="sum_y", description="Sum of their lines, the first line is 0.")
        boxes = [CSRStatus(name=f"box_{axis}", fields=[
            CSRField("first", size=11, offset=0, description=f"Least {unit}; 2047 without a pixel."),
            CSRField("last", size=11, offset=16, description=f"Greatest {unit}; 0 without a pixel."),
        ], description=f"{unit.capitalize()}s of the box around them.") for axis, unit in (("x", "column"), ("y", "line"))]
        self._box_x, self._box_y = boxes
        sums = [CSRStatus(64, name=f"sum_{product}", description=f"Sum of {text}; 0 if it is not built (`moments`).")
                for product, text in (("xx", "the squares of their columns"), ("xy", "their columns times their lines"),
                                      ("yy", "the squares of their lines"))]
        self._sum_xx, self._sum_xy, self._sum_yy = sums
        self._snapshot = CSRStorage(name="snapshot", fields=[
            CSRField("step", size=3, offset=0, description="Keep every 2^step-th pixel of every 2^step-th line, 0 to 5."),
            CSRField("colour", offset=3, description="Keep RGB565 colours, one a word. Otherwise marks before region and run, 16 a "
                     "word, the first in the highest bit."),
            CSRField("start", offset=8, pulse=True, description="Write 1 to keep a picture of the next whole frame."),
        ], description="Small picture of one frame.")
        self._snapshot_state = CSRStatus(name="snapshot_state", fields=[
            CSRField("words", size=12, offset=0, description="Words kept, valid with `ready`."),
            CSRField("ready", offset=12, description="The picture is complete."),
            CSRField("sequence", size=16, offset=16, description="`sequence` of its frame."),
        ], description="State of the small picture.")
        self._snapshot_place = Parameter(11, name="snapshot_place", description="Word of the small picture to read next.")
        self._snapshot_word = CSRStatus(16, name="snapshot_word", description="Word of the small picture. A read moves on to the "
                                        "next word.")
        self.constants = {"snapshot_words": (SNAPSHOT_WORDS, "Words of the memory for a small picture.")}
        self.counters = Counters(self, {
            "frames": "Whole frames.",
            "frames_dropped": "Frames with a fault, which leave the results as they are.",
            "lines_malformed": "Lines with a wrong number of bytes, or cut by VSYNC, in all frames.",
        })

        # # #

        def span(register):
            return Struct("span_t", "First and last column, or first and last line, of a box or region.", {
                name: getattr(register.fields, name) for name in ("first", "last")})

        def window(register):
            return Struct("window_t", "Window of a channel.", {
                name: getattr(register.fields, name) for name in ("channel", "lower", "upper")})

        control = self._control.fields
        pins = Struct("pins_t", "Properties of the image sensor's pins: polarities, byte order and clock edge.", {
            name: getattr(control, name) for name in ("vsync_low", "href_low", "swap", "falling")})
        settings = Struct("frame_settings_t", "Settings of a frame.", {
            "width": self._size.fields.width,
            "height": self._size.fields.height,
            "window_a": window(self._window_a),
            "window_b": window(self._window_b),
            "region_x": span(self._region_x),
            "region_y": span(self._region_y),
            "least_run": self._least_run.storage,
        })
        status = Struct("status_t", "State of the engine and levels of its wires. `pixels` counts the pixels of the last line, "
                        "`lines` the lines of the last frame.", {
            **{name: getattr(self._status.fields, name) for name in (
                "running", "waiting", "vsync", "href", "scl", "sda", "fault")},
            **{name: getattr(self._seen.fields, name) for name in ("pixels", "lines")},
        })
        results = Struct("results_t", "Results of a whole frame.", {
            "count": self._count.status,
            "sum_x": self._sum_x.status,
            "sum_y": self._sum_y.status,
            "box_x": span(self._box_x),
            "box_y": span(self._box_y),
            "sum_xx": self._sum_xx.status[:_PRODUCT_BITS],
            "sum_xy": self._sum_xy.status[:_PRODUCT_BITS],
            "sum_yy": self._sum_yy.status[:_PRODUCT_BITS],
        })
        snapshot = Struct("snapshot_t", "Request for a small picture, and the read position in the picture. `start`, `set` and `move` are "
                          "high for one clock.", {
            **{name: getattr(self._snapshot.fields, name) for name in ("step", "colour", "start")},
            "set": self._snapshot_place.re,
            "place": self._snapshot_place.storage,
            "move": self._snapshot_word.we,
        })
        snapshot_state = Struct("snapshot_state_t", "State of the small picture, and its word at the read position.", {
            "words": self._snapshot_state.fields.words,
            "ready": self._snapshot_state.fields.ready,
            "sequence_number": self._snapshot_state.fields.sequence,
            "word": self._snapshot_word.status,
        })
        self.package = Package("gesture", enumerations=[CHANNELS, FAULTS], structs=[
            span(self._region_x), window(self._window_a), pins, settings, status, results, snapshot, snapshot_state,
            self.counters.events])

        wires = {name: Signal() for name in ("scl", "sda")}
        # A high PCLK shows that the image sensor runs.
        camera, state = self._camera.fields, self._status.fields
        self.clock_control = ClockControl(
            control.enable | state.running | state.waiting | pads.pclk | camera.clock | ~camera.scl | ~camera.sda)
        self.specials += Instance("gesture_engine", name="gesture_core",
            p_MOMENTS          = int(moments),
            p_CLOCK_DIVIDER    = divider,
            i_clk              = ClockSignal("sys"),
            i_rst              = ResetSignal("sys"),
            i_pins             = pins.value,
            i_enable           = control.enable,
            i_settings         = settings.value,
            i_snapshot_request = snapshot.value,
            o_status           = status.value,
            o_latched          = self.ev.frame.trigger,
            o_sequence_number  = self._sequence.status,
            o_results          = results.value,
            o_snapshot_state   = snapshot_state.value,
            o_events           = self.counters.events.value,
            i_camera_pclk      = pads.pclk,
            i_camera_vsync     = pads.vsync,
            i_camera_href      = pads.href,
            i_camera_data      = pads.d,
            i_camera_scl       = wires["scl"],
            i_camera_sda       = wires["sda"],
            i_clock_on         = self._camera.fields.clock,
            o_camera_xclk      = pads.xclk,
        )
        add_sources(platform, "gesture_engine")
        if hasattr(pads, "reset_n"):
            self.comb += [
                pads.reset_n.eq(~self._camera.fields.reset),
                pads.power_down.eq(self._camera.fields.power_down),
            ]
        for name, wire in wires.items():
            released = getattr(self._camera.fields, name)
            if hasattr(pads, f"{name}_in"):
                self.comb += [getattr(pads, f"{name}_out").eq(released), wire.eq(getattr(pads, f"{name}_in"))]
            else:
                self.specials += Tristate(getattr(pads, name), o=0, oe=~released, i=wire)

"""Register block of the gesture engine (rtl/gesture): finds a hand in the frames of an image sensor by its colour."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import ClockSignal, Instance, ResetSignal, Signal
from migen.fhdl.specials import Tristate

from .clock_control import ClockControl
from .counters import Counters
from .packed import Enumeration, Package, Struct
from .parameters import Parameter, driven_bits
from .rtl import add_sources

IDENT = int.from_bytes(b"GEST", "big")

MAX_WIDTH, MAX_HEIGHT = 1280, 720

CAMERA_CLOCK = 25e6
"""Largest frequency of the sensor's input clock in Hz. The OV5640 takes up to 27 MHz, the OV7670 more."""

PIXEL_CLOCK = 66e6
"""Largest frequency of the sensor's clock PCLK in Hz, for the boards' constraints. 640x480 at 60 Hz needs about 49 MHz."""

SNAPSHOT_WORDS = 2048

_PRODUCT_BITS = 40
"""Width of the sums of products in bits."""

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
        CSRField("last", size=11, offset=16, description=f"Last {unit} of the region."),
    ], description=text)


def _window(name, channel):
    return Parameter(name=name, fields=[
        CSRField("lower", size=8, offset=0, description="Smallest value in the window."),
        CSRField("upper", size=8, offset=8, description="Largest value in the window."),
        CSRField("channel", size=CHANNELS.bits, offset=16, values=CHANNELS.values, description="Channel of the pixel."),
    ], description=f"{channel} window of the hand's colour: a pixel is marked if its channels are in both windows.")


def clock_divider(sys_clk_freq):
    """Returns the even number by which the system clock is divided for the image sensor."""
    return 2 * -int(-sys_clk_freq // (2 * CAMERA_CLOCK))


class GestureEngine(LiteXModule):
    """Receives the frames of the image sensor on `pads`. `moments` adds the sums of products to the build.

    `pads` has `pclk`, `href`, `vsync`, `d` and `xclk`; `reset_n` and `power_down` if the adapter has these pins; and the wires of
    the camera's bus: `scl` and `sda`, or for a test harness `scl_in`, `scl_out`, `sda_in` and `sda_out`.
    """

    def __init__(self, platform, pads, sys_clk_freq, moments=False):
        divider = clock_divider(sys_clk_freq)
        # The board's SoC adds a timing constraint for this clock.
        self.pclk = pads.pclk

        self._ident = CSRStatus(32, name="ident", reset=IDENT, description="`GEST` in ASCII; 0 where the block is absent.")
        self._caps = CSRStatus(name="caps", fields=[
            CSRField("width", size=11, offset=0, reset=MAX_WIDTH, description="Largest number of pixels in a line."),
            CSRField("height", size=10, offset=12, reset=MAX_HEIGHT, description="Largest number of lines in a frame."),
            CSRField("clock_divider", size=4, offset=24, reset=divider, description="Divider: the sensor's input clock is the system clock "
                     "divided by this number."),
            CSRField("moments", offset=28, reset=int(moments), description="The build has the sums of products."),
        ], description="Capabilities of this build.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("enable", offset=0, description="Process frames. The first frame begins at the next VSYNC."),
            CSRField("vsync_low", offset=1, description="VSYNC is low between frames, and high during a frame."),
            CSRField("href_low", offset=2, description="HREF is low during a line."),
            CSRField("swap", offset=3, description="The first byte of a pixel is the low byte."),
            CSRField("falling", offset=4, description="Sample the pins at the falling edge of the sensor's clock."),
        ], description="Operation. Software changes the fields other than `enable` while `enable` is 0.")
        self._camera = CSRStorage(name="camera", fields=[
            CSRField("clock", offset=0, description="Drive the sensor's input clock."),
            CSRField("reset", offset=1, reset=1, description="Hold the image sensor in reset, if the adapter has this pin."),
            CSRField("power_down", offset=2, reset=1, description="Power the image sensor down, if the adapter has this pin."),
            CSRField("scl", offset=8, reset=1, description="SCL of the sensor's bus: 0 pulls the wire low, 1 releases it."),
            CSRField("sda", offset=9, reset=1, description="SDA of the sensor's bus: 0 pulls the wire low, 1 releases it."),
        ], description="Pins of the image sensor. Software moves the wires of its bus (SCCB).")
        self._size = Parameter(name="size", fields=[
            CSRField("width", size=11, offset=0, description="Pixels of a line, 1 to 1280."),
            CSRField("height", size=10, offset=16, description="Lines of a frame, 1 to 720."),
        ], description="Size of a whole frame. This register and the registers of windows, region and run are sampled at the "
                       "start of each frame.")
        self._window_a = _window("window_a", "First")
        self._window_b = _window("window_b", "Second")
        self._region_x = _range("region_x", "Columns of the region: pixels outside do not count.", "column")
        self._region_y = _range("region_y", "Lines of the region.", "line")
        self._least_run = Parameter(4, name="least_run", description="A marked pixel counts if it is in the region and in a run of "
                                    "at least this many marked pixels. 0 has the effect of 1.")
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
        ], description="Counts of received lines and pixels. The counts saturate.")
        self.ev = EventManager()
        self.ev.frame = EventSourcePulse(name="frame", description="The results of a whole frame are in the registers.")
        self.ev.finalize()
        self._sequence = CSRStatus(16, name="sequence", description="Whole frames since reset, modulo 2^16. If this number is the "
                                   "same before and after reading the results, they belong to one frame.")
        self._count = CSRStatus(20, name="count", description="Number of counted pixels: marked, in the region, and in a run of the "
                                "required length.")
        self._sum_x = CSRStatus(30, name="sum_x", description="Sum of the columns of the counted pixels; the first column is 0.")
        self._sum_y = CSRStatus(29, name="sum_y", description="Sum of the lines of the counted pixels; the first line is 0.")
        boxes = [CSRStatus(name=f"box_{axis}", fields=[
            CSRField("first", size=11, offset=0, description=f"Smallest {unit}; 2047 without a counted pixel."),
            CSRField("last", size=11, offset=16, description=f"Largest {unit}; 0 without a counted pixel."),
        ], description=f"{unit.capitalize()}s of the bounding box of the counted pixels.") for axis, unit in (("x", "column"), ("y", "line"))]
        self._box_x, self._box_y = boxes
        sums = [CSRStatus(64, name=f"sum_{product}", description=f"Sum of {text}; 0 in a build without `moments` in `caps`.")
                for product, text in (("xx", "the squares of the columns of the counted pixels"),
                                      ("xy", "the products of their columns and lines"),
                                      ("yy", "the squares of the lines of the counted pixels"))]
        self._sum_xx, self._sum_xy, self._sum_yy = sums
        self._snapshot = CSRStorage(name="snapshot", fields=[
            CSRField("step", size=3, offset=0, description="Store every 2^step-th pixel of every 2^step-th line, 0 to 5."),
            CSRField("colour", offset=3, description="1: store RGB565 colours, one per word. 0: store marks, before the tests of region and "
                     "run, 16 per word, the first in the highest bit."),
            CSRField("start", offset=8, pulse=True, description="Write 1 to store a small picture of the next whole frame."),
        ], description="Small picture of one frame.")
        self._snapshot_state = CSRStatus(name="snapshot_state", fields=[
            CSRField("words", size=12, offset=0, description="Number of stored words, valid with `ready`."),
            CSRField("ready", offset=12, description="The picture is complete."),
            CSRField("sequence", size=16, offset=16, description="Value of the register `sequence` for the frame of the picture."),
        ], description="State of the small picture.")
        self._snapshot_place = Parameter(11, name="snapshot_place", description="Number of the word of the small picture to read next.")
        self._snapshot_word = CSRStatus(16, name="snapshot_word", description="Word of the small picture. A read advances to the "
                                        "next word.")
        self.constants = {"snapshot_words": (SNAPSHOT_WORDS, "Words of the memory for a small picture.")}
        self.counters = Counters(self, {
            "frames": "Whole frames.",
            "frames_dropped": "Frames with a fault, which do not change the results.",
            "lines_malformed": "Lines with a wrong number of bytes, or cut off by VSYNC, in all frames.",
        })

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
            "sum_xx": driven_bits(self, self._sum_xx, _PRODUCT_BITS),
            "sum_xy": driven_bits(self, self._sum_xy, _PRODUCT_BITS),
            "sum_yy": driven_bits(self, self._sum_yy, _PRODUCT_BITS),
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
        # A high PCLK may mean that the image sensor runs.
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

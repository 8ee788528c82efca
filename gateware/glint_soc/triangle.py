"""Register block of the triangle engine (rtl/triangle): draws a mesh in memory, and the field of a raymarcher, to a frame in
memory."""

from itertools import chain

from litedram.common import LiteDRAMNativePort
from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import Cat, ClockSignal, If, Instance, Mux, Record, ResetSignal, Signal, log2_int

from . import constants
from .clock_control import ClockControl
from .counters import Counters
from .packed import Enumeration, Package, Struct
from .parameters import Parameter, PassParameters, driven_bits
from .records import DESCRIPTOR, LIGHT_BYTES, TEXTURE_BYTES
from .rtl import add_sources

IDENT = int.from_bytes(b"TRIA", "big")

# Members of a group from the raymarcher: `halves` is 3 for a pixel, or 1 or 2 for its half of the left or right eye; `row`,
# `line` and `column` locate eight pixels in the band, and `mask` selects one of them; then its depth code and colour.
_FIELD_GROUP = [("halves", 2), ("row", 11), ("line", 6), ("column", 8), ("mask", 8), ("code", 18), ("colour", 16)]

_ADDRESS_BITS = 23
_COUNT_BITS = 20

ERRORS = Enumeration("error", "Results of a pass.", {
    "none": "no error",
    "size": "`size` is not supported by this build",
    "address": "a region was not aligned to 16 bytes or not within main memory; memory is unchanged",
    "busy": "started while the same pass was running; that pass continued",
    "mesh": "a chunk without vertices or beyond `mesh_bytes`; the chunks before it were drawn",
    "full": "no room for all descriptors, list entries or exceptions; the others were drawn",
    "list": "a band list was too long, or named a number that is no descriptor; the frame is wrong",
    "cancelled": "ended by `cancel`",
    "triangles": "this build draws no triangles; memory is unchanged",
    "lines": "this build draws no lines; memory is unchanged",
    "geometry": "this build has no geometry passes; memory is unchanged",
})

SIZES = Enumeration("size", "Sizes of a picture.", {size.name: size.text for size in constants.SIZES})


# Names of the fields that select a quarter of a picture.
_QUARTER = ("quarter", "right", "lower")


def _quarter(offset, description):
    """The fields that select a quarter of a picture, from the bit `offset` on."""
    texts = (description, "With `quarter`: 1 selects a right quarter, 0 a left quarter.",
             "With `quarter`: 1 selects a lower quarter, 0 an upper quarter.")
    return [CSRField(name, offset=offset + i, description=text) for i, (name, text) in enumerate(zip(_QUARTER, texts))]


class TriangleEngine(LiteXModule):
    """Draws meshes, in two passes that may run at the same time for two frames.

    `readers` are four native 128-bit LiteDRAM read ports (triangles, vertices, raster, texels), `writers` four write ports
    (descriptors, lists, frame in even and in odd banks), all in the domain `sys`. `main_ram` is the region that the ports reach, of which
    the engine uses the first 128 MiB.
    `sizes` are the picture sizes of this build, bit k for the size of code k. `smooth` adds smooth shading, `texture` adds textures, which
    use the port of texels (they exclude each other), `has_sky` adds the sky behind triangles, `has_fog` adds fog on triangles, `averages`
    adds pictures with four samples a pixel, `fields` adds the input `field` for a raymarcher, and `lines` adds the line engine. Without `triangles` the engine draws only lines and fields, and does not use the port of the vertices; with neither
    triangles nor lines it uses only the last two writers. The registers are the same. A build without `triangles` may also omit `depths`,
    the memory for the depths of a band. Without `has_geometry`, for builds without lines, the engine draws triangles from the firmware's
    lists, and does not use the ports of mesh, vertices, descriptors and lists. `pending` is for memories other than LiteDRAM: two signals that
    are high while words which the writers of lists, or of the frame, have sent may not be in memory yet. A pass ends when they are low.
    """

    def __init__(self, platform, readers, writers, main_ram, sizes, triangles=True, smooth=False, texture=False, has_sky=False,
                 has_fog=False, averages=False, fields=False, lines=False, has_geometry=True, depths=True, pending=None):
        has_geometry = has_geometry and (triangles or lines)
        memory_bits = min(log2_int(main_ram.size // 16), _ADDRESS_BITS)
        for port in (*readers, *writers):
            if port.data_width != 128 or port.address_width < memory_bits:
                raise ValueError(f"the triangle engine needs memory ports of 128 bits and at least {memory_bits} address bits, "
                                 f"got {port.data_width} and {port.address_width}")
        if main_ram.origin % (16 << memory_bits):
            raise ValueError(f"the triangle engine needs main memory at a multiple of its size, got {main_ram}")

        self._ident = CSRStatus(32, name="ident", reset=IDENT, description="`TRIA` in ASCII; 0 where the block is absent.")
        self._caps = CSRStatus(name="caps", fields=[
            CSRField("sizes", size=3, offset=0, reset=sizes, description="Bit k is set if `size` k is supported."),
            CSRField("gouraud", offset=3, reset=int(smooth), description="Smooth shading: colours interpolated between "
                     f"vertices. A descriptor has {DESCRIPTOR.size} bytes, and {LIGHT_BYTES} more with smooth shading."),
            CSRField("triangles", offset=4, reset=int(triangles), description="Triangles: geometry passes without `lines`, and raster "
                     "passes of their lists. With neither triangles nor lines a raster pass draws the raymarcher's field alone."),
            CSRField("lines", offset=5, reset=int(lines), description="Lines: geometry passes with `lines`, and raster passes of their "
                     "lists."),
            CSRField("depths", offset=6, reset=int(depths), description="Depths: the depth test and the field `depth` of a raster pass, which "
                     "writes zeros in a build without depths."),
            CSRField("geometry", offset=7, reset=int(has_geometry), description="Geometry passes. Without them a raster pass draws lists that "
                     "the CPU has written."),
            CSRField("count_bits", size=6, offset=8, reset=_COUNT_BITS, description="Bits of a count of descriptors or entries."),
            CSRField("textures", offset=14, reset=int(texture), description="Textures: descriptors are "
                     f"{TEXTURE_BYTES} bytes longer."),
            CSRField("sky", offset=15, reset=int(has_sky), description="The sky behind triangles."),
            CSRField("fog", offset=16, reset=int(has_fog), description="Fog on triangles."),
            CSRField("average", offset=17, reset=int(averages), description="Averages of four samples."),
        ], description="Capabilities of this build.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("cancel", offset=0, pulse=True, description="Write 1 to cancel both passes. A pass started afterwards waits "
                     "for outstanding reads and for a clear band buffer."),
        ], description="Operation.")
        self._status = CSRStatus(name="status", fields=[
            CSRField("geometry_busy", offset=0, description="The geometry pass runs."),
            CSRField("raster_busy", offset=1, description="The raster pass runs."),
            CSRField("geometry_error", size=ERRORS.bits, offset=4, values=ERRORS.values,
                     description="Result of the last geometry pass."),
            CSRField("raster_error", size=ERRORS.bits, offset=8, values=ERRORS.values,
                     description="Result of the last raster pass."),
        ], description="State.")
        self.ev = EventManager()
        self.ev.geometry = EventSourcePulse(name="geometry", description="The geometry pass has ended, see `status`; its "
            "descriptors and lists are in memory.")
        self.ev.raster = EventSourcePulse(name="raster", description="The raster pass has ended, see `status`; the frame is in "
            "memory.")
        self.ev.finalize()

        # Registers with the parameters of the geometry pass, constant while the pass runs.
        self._geometry = Parameter(name="geometry", fields=[
            CSRField("start", offset=0, pulse=True, description="Write 1 to start."),
            CSRField("cull", offset=1, description="Cull back faces."),
            CSRField("size", size=SIZES.bits, offset=2, values=SIZES.values, description="Size of the picture."),
            CSRField("smooth", offset=4, description="Interpolate colours between vertices. No effect without `gouraud` in `caps`."),
            CSRField("append", offset=5, description="Continue the descriptors, lists and exceptions of the previous pass instead of "
                     "empty ones. `size`, `geometry_descriptors`, `geometry_lists`, `list_shift` and `exceptions` must be as in that "
                     "pass. No effect in the first pass after a reset or after `cancel`."),
            CSRField("mirror", offset=6, description="The mesh is mirrored: front faces are clockwise on the screen."),
            CSRField("recolour", offset=7, description="Use `colour` instead of the colours of the mesh."),
            CSRField("lines", offset=8, description="Draw lines: `mesh` has segments instead of triangles."),
            CSRField("orthographic", offset=9, description="Orthographic projection, in which X and Y are not divided and depth codes "
                     "are linear. Light between vertices is not: `smooth` must be 0."),
            CSRField("textures", offset=10, description="Draw the textures of the mesh, under flat light. No effect without `textures` in "
                     "`caps`, or with `smooth`."),
            *_quarter(11, "`size` is that of a quarter of the picture. No effect without `average` in `caps`."),
        ], description="Start of the geometry pass: descriptors and band lists of a mesh. The registers down to "
            "`first_texture`, and those from `light_0` on, must hold for 128 clock cycles after the start, in which they are copied.")
        address = "Byte address, a multiple of 16, of"
        self._mesh = Parameter(32, name="mesh", description=f"{address} the mesh's first chunk.")
        self._mesh_bytes = Parameter(32, name="mesh_bytes", description="Length of all chunks of the mesh in bytes, a multiple of 16.")
        self._geometry_descriptors = Parameter(32, name="geometry_descriptors", description=f"{address} the descriptors, "
                                                "written by the pass.")
        self._descriptor_limit = Parameter(_COUNT_BITS, name="descriptor_limit", description="Largest number of "
                                             "descriptors; `caps` determines their size.")
        self._geometry_lists = Parameter(32, name="geometry_lists", description=f"{address} the band lists, written by the pass.")
        self._list_shift = Parameter(5, name="list_shift", description="A band list has at most 4 << list_shift entries, "
            "in both passes.")
        self._exceptions = Parameter(32, name="exceptions", description=f"{address} the list of exceptions, written by the pass.")
        self._exception_limit = Parameter(_COUNT_BITS, name="exception_limit", description="Largest number of exceptions, 4 bytes each.")
        self._scale_shift = Parameter(5, name="scale_shift", description="Scale shift f of rows U and V; in orthographic projection "
            "f + 1 - ke.")
        rows = {}
        for row, meaning in [("u", "U"), ("v", "V"), ("n", "n")]:
            for i, axis in enumerate("xyz"):
                register = Parameter(25, name=f"row_{row}{i}", description=f"Row {meaning}, {axis}, two's complement.")
                setattr(self, f"_row_{row}{i}", register)
                rows.setdefault(row, []).append(register)
        translation = {}
        for axis, what in [("x", "14 + f"), ("y", "14 + f"), ("z", "37")]:
            low = Parameter(32, name=f"t{axis}_low", description=f"Translation t{axis}, {what} fraction bits: bits 0 to 31.")
            high = Parameter(12, name=f"t{axis}_high", description=f"Translation t{axis}: bits 32 to 43.")
            setattr(self, f"_t{axis}_low", low)
            setattr(self, f"_t{axis}_high", high)
            translation[axis] = [low, high]
        self._near_low = Parameter(32, name="near_low", description="Near plane, 37 fraction bits: bits 0 to 31.")
        self._near_high = Parameter(7, name="near_high", description="Near plane: bits 32 to 38.")
        self._depth_scale = Parameter(name="depth_scale", fields=[
            CSRField("mantissa", size=17, offset=0, description="km, 2^16 to 2^17 - 1."),
            CSRField("exponent", size=4, offset=17, description="ke, two's complement."),
        ], description="Depth scale K = km * 2^ke.")

        self._coordinates = Parameter(32, name="coordinates", description=f"{address} the texture coordinates of the mesh's vertices, with "
                                      "`textures` in `geometry`.")
        self._first_texture = Parameter(8, name="first_texture", description="Number of textures before the mesh's first texture in the "
                                        "table at `textures`.")

        # Registers with the parameters of the raster pass, constant while the pass runs.
        self._raster = Parameter(name="raster", fields=[
            CSRField("start", offset=0, pulse=True, description="Write 1 to start."),
            CSRField("size", size=SIZES.bits, offset=1, values=SIZES.values, description="Size of the picture."),
            CSRField("first", offset=3, description="Draw the first set of lists."),
            CSRField("second", offset=4, description="Draw the second set of lists, in each band after the first set."),
            CSRField("depth", offset=5, description="Write the depths as well as the colours. Implies `whole`."),
            CSRField("slot", offset=6, description="Number of the frame buffer: the engine remembers the extents of the last frame in each "
                     "slot."),
            CSRField("whole", offset=7, description="Write the whole frame buffer. Required for the first frame in a frame buffer, "
                     "after a cancelled frame, after a change of size, `clear` or `sky`, and after writes by the CPU."),
            CSRField("sky", offset=8, description="Draw the sky in place of `clear`, in a frame without a field. Implies `whole`. No effect "
                     "without `sky` in `caps`."),
            CSRField("sky_first", offset=9, description="With `sky`: draw the sky before the triangles of each band, as textures that are "
                     "blended with it require, instead of during the flush, which takes no time. No effect without `textures` in `caps`."),
            CSRField("fog", offset=10, description="Draw triangles in fog, in perspective. No effect without `fog` in `caps`."),
            CSRField("dither", offset=11, description="Dither the colours of smooth triangles, textures, field, sky and fog; 0 rounds them to "
                     "nearest."),
            CSRField("average", offset=12, description="Draw four samples for each pixel: `size` is that of the picture of the samples, and the "
                     "frame has half its width and height. Implies `whole`, and writes no depths. No effect without `average` in `caps`."),
            *_quarter(13, "With `average`: the samples are those of a quarter of the frame, which has the width and height `size`."),
        ], description="Start of the raster pass: a frame from descriptors and band lists. The registers down to `textures`, and those "
            "from `sky_above` on, must hold while it runs.")
        self._frame = Parameter(32, name="frame", description=f"{address} the frame, RGB565, written by the pass.")
        self._depth = Parameter(32, name="depth", description=f"{address} the depth codes, 32 bits each, written by the pass.")
        self._clear = Parameter(16, name="clear", description="Background colour, RGB565.")
        sets = {}
        for k, which in enumerate(["first", "second"]):
            for name, register in [
                ("lists", Parameter(32, name=f"lists_{k}", description=f"{address} the {which} set's lists.")),
                ("descriptors", Parameter(32, name=f"descriptors_{k}", description=f"{address} the {which} set's descriptors.")),
                ("count", Parameter(_COUNT_BITS, name=f"count_{k}", description=f"Descriptors of the {which} set.")),
            ]:
                setattr(self, f"_{name}_{k}", register)
                sets.setdefault(name, []).append(register)

        self._textures = Parameter(32, name="textures", description=f"{address} the table of the textures' addresses. No effect without "
                                   "`textures` in `caps`.")

        # Registers with the results of the last geometry pass.
        results = {
            "triangles": "Triangles of the mesh.",
            "unseen": "Triangles behind the near plane or beyond one side of the picture.",
            "culled": "Triangles culled by the setup: back faces, triangles without area or without a pixel centre in their bounds, "
                      "and tiny ones that cover no pixel.",
            "descriptor_count": "Descriptors written, with `append` including those of earlier passes.",
            "exception_count": "Triangles that need clipping, listed in `exceptions` by their numbers in the mesh, with `append` "
                               "including those of earlier passes.",
        }
        results = {name: CSRStatus(32, name=name, description=description) for name, description in results.items()}
        for name, register in results.items():
            setattr(self, f"_{name}", register)
        self.counters = Counters(self, {
            "cycles_busy": "Clock cycles of both passes.",
            "cycles_stalled": "Clock cycles in which memory refused a command.",
            "stalled_reads": "Clock cycles in which memory refused a read.",
            "stalled_lists": "Clock cycles in which memory refused a write of the geometry pass.",
            "stalled_frame": "Clock cycles in which memory refused a write of the raster pass.",
            "items_in": "Words of 16 bytes read from memory.",
            "items_out": "Words of 16 bytes written to memory.",
            "cycles_geometry": "Clock cycles of geometry passes.",
            "vertices": "Vertices transformed.",
            "cycles_raster": "Clock cycles of raster passes.",
            "cycles_walking": "Clock cycles in which the walker was at a group of pixels.",
            "cycles_empty": "Clock cycles in which the walker was at a group without a covered pixel.",
            "groups": "Groups of eight pixels with a covered pixel, except groups whose texels are all transparent.",
            "pixels_covered": ("Covered pixels, counted for each triangle, except pixels of transparent texels.", 4),
            "pixels_drawn": ("Pixels that passed the depth test.", 4),
            "cycles_held": "Clock cycles in which a group waited for an earlier group of the same pixels.",
            "cycles_memory": "Clock cycles in which the flush of a band waited for memory.",
            "cycles_flush": "Clock cycles in which a drawn band waited for the flush of the previous band.",
        })
        # More parameters of the geometry pass.
        light = [Parameter(25, name=f"light_{i}", description=f"Row of the light, {axis}, s2.23, two's complement.")
                 for i, axis in enumerate("xyz")]
        for i, register in enumerate(light):
            setattr(self, f"_light_{i}", register)
        self._light_colour = Parameter(27, name="light_colour", description="Colour of the light, u1.8 for each channel, at most 1: red "
                                       "in bits 0 to 8, green in bits 9 to 17, blue in bits 18 to 26.")
        self._ambient = Parameter(27, name="ambient", description="Ambient light, in the format of `light_colour`. It must be 0 with "
                                  "`smooth` and without `cull`.")
        self._colour = Parameter(16, name="colour", description="Colour instead of those of the mesh, with `recolour` in "
                                 "`geometry`, RGB565.")

        # More parameters of the raster pass.
        sky = {
            "above": Parameter(32, name="sky_above", description="Height of the sky, s8.23, two's complement, for the first eight pixels of "
                               "the line above the picture."),
            "across": Parameter(32, name="sky_across", description="Change of the height over eight pixels."),
            "down": Parameter(32, name="sky_down", description="Change of the height from a line to the next."),
            **{name: Parameter(24, name=f"sky_{name}", description=f"Colour of the sky at the {name}: red in bits 0 to 7, green in bits 8 "
                               "to 15, blue in bits 16 to 23.") for name in ("zenith", "horizon", "nadir")},
        }
        fog = {
            "offset": Parameter(13, name="fog_offset", description="The number that is subtracted from 128·log2 of a depth code, two's "
                                "complement."),
            "colour": Parameter(24, name="fog_colour", description="Colour of the fog: red, u5.3, in bits 0 to 7, green, u6.2, in bits 8 to "
                                "15, blue, u5.3, in bits 16 to 23."),
        }
        for prefix, registers in (("sky", sky), ("fog", fog)):
            for name, register in registers.items():
                setattr(self, f"_{prefix}_{name}", register)

        recovering = Signal()
        self.clock_control = ClockControl(
            recovering | self._control.fields.cancel | self._status.fields.geometry_busy | self._status.fields.raster_busy)
        self.parameters = PassParameters(
            [self._mesh, self._mesh_bytes, self._geometry_descriptors, self._descriptor_limit, self._geometry_lists, self._list_shift,
             self._exceptions, self._exception_limit, self._scale_shift, *chain(*rows.values(), *translation.values()),
             self._near_low, self._near_high, self._depth_scale, *light, self._light_colour, self._ambient,
             self._colour, *([self._coordinates, self._first_texture] if texture else [])],
            [self._frame, self._depth, self._clear, self._list_shift, *chain(*sets.values()),
             *([self._textures] if texture else []),
             *(sky.values() if has_sky else []),
             *(fog.values() if has_fog else [])])
        # A raymarcher copies its parameters when the raster pass is requested; the pass waits until engine and
        # raymarcher have copied their parameters.
        self.raster_load, self.field_loading = Signal(), Signal()
        # A refused request does not change the parameters of the running pass.
        self.comb += [
            self.raster_load.eq(self._raster.fields.start & ~self._status.fields.raster_busy),
            self.parameters.load.eq(Cat(self._geometry.fields.start & ~self._status.fields.geometry_busy, self.raster_load)),
        ]

        # Signals between the triangle engine and a raymarcher, explained in rtl/triangle/raster_unit.sv.
        self.field = field = Record([
            ("enable", 1), ("compose", 2), ("start", 1), ("restart", 1), ("size", 2), ("dither", 1), ("open", 1), ("done", 1), ("next", 1),
            ("valid", 1), ("ready", 1), *_FIELD_GROUP])

        geometry_flags = Struct("geometry_flags_t", "Flags of a geometry pass.", {
            name: getattr(self._geometry.fields, name) for name in (
                "size", "cull", "smooth", "append", "mirror", "recolour", "lines", "orthographic", "textures", *_QUARTER)})
        geometry = Struct("geometry_t", "Parameters of the geometry pass. Memory regions are given by byte addresses.", {
            "mesh": self._mesh.storage,
            "mesh_bytes": self._mesh_bytes.storage,
            "descriptors": self._geometry_descriptors.storage,
            "descriptor_limit": self._descriptor_limit.storage,
            "lists": self._geometry_lists.storage,
            "list_shift": self._list_shift.storage,
            "exceptions": self._exceptions.storage,
            "exception_limit": self._exception_limit.storage,
            **{name: [register.storage[9*i:9*i + 9] for i in range(3)]
               for name, register in (("light_colour", self._light_colour), ("ambient", self._ambient))},
            "colour": self._colour.storage,
            "coordinates": self._coordinates.storage,
            "first_texture": self._first_texture.storage,
        })
        view = Struct("view_t", "Camera and light of the geometry pass: docs/formats/camera.md, \"Frame constants\".", {
            "scale_shift": self._scale_shift.storage,
            **{f"row_{row}": [register.storage for register in registers] for row, registers in rows.items()},
            **{f"t{axis}": Cat(*(register.storage for register in registers)) for axis, registers in translation.items()},
            "near_z": Cat(self._near_low.storage, self._near_high.storage),
            "depth_mantissa": self._depth_scale.fields.mantissa,
            "depth_exponent": self._depth_scale.fields.exponent,
            "row_light": [register.storage for register in light],
        })
        raster_flags = Struct("raster_flags_t", "Flags of a raster pass.", {
            name: getattr(self._raster.fields, name) for name in (
                "size", "first", "second", "depth", "slot", "whole", "sky", "sky_first", "fog", "dither", "average", *_QUARTER)})
        raster = Struct("raster_t", "Parameters of the raster pass. Memory regions are given by byte addresses.", {
            "frame": self._frame.storage,
            "depth": self._depth.storage,
            "clear": self._clear.storage,
            "list_shift": self.parameters.copies[1][self._list_shift],
            **{name: [register.storage for register in registers] for name, registers in sets.items()},
            "textures": self._textures.storage,
        })
        sky = Struct("sky_t", "The sky: heights, s8.23, and colours, {blue, green, red} (docs/formats/triangle.md, \"Sky\").", {
            name: register.storage for name, register in sky.items()})
        fog = Struct("fog_t", "The fog: an offset of logarithms, s13, and a colour, {blue, green, red} (docs/formats/triangle.md, "
                     "\"Fog\").", {name: register.storage for name, register in fog.items()})
        counts = ("descriptor_count", "exception_count")
        results = Struct("results_t", "Results of the geometry pass.", {
            name: driven_bits(self, register, _COUNT_BITS) if name in counts else register.status for name, register in results.items()})
        status = Struct("status_t", "State of the engine. `geometry_done` and `raster_done` are high for one clock; the errors "
                        "are valid in that clock.", {
            name: Signal(name=f"engine_{name}") for name in (
                "ready", "geometry_busy", "geometry_done", "mesh_error", "full", "raster_busy", "raster_done", "list_error")})
        field_source = Struct("field_source_t", "Link from a raymarcher to the engine.", {
            name: getattr(field, name) for name in ("enable", "compose", "done", "valid", *(name for name, _ in _FIELD_GROUP))})
        field_sink = Struct("field_sink_t", "Link from the engine to a raymarcher.", {
            name: getattr(field, name) for name in ("start", "open", "next", "ready")})
        read_ports = {name: _read_port(port) for name, port in zip(("mesh", "vertex", "raster", "texture"), readers, strict=True)}
        write_ports = {name: _write_port(port) for name, port in zip(
            ("descriptors", "lists", "frame_even", "frame_odd"), writers, strict=True)}
        self.package = Package(
            "triangle", {"ADDRESS_BITS": _ADDRESS_BITS, "COUNT_BITS": _COUNT_BITS}, [ERRORS],
            [geometry_flags, geometry, view, raster_flags, raster, sky, fog, results, status, self.counters.events, field_source, field_sink,
             *read_ports["mesh"].values(), *write_ports["lists"].values()])

        given = status if pending is None else self._held(status, *pending)
        geometry_kept, raster_kept = geometry_flags.signals(), raster_flags.signals()
        start = {name: Signal(name=name) for name in ("geometry_start", "raster_start")}
        cancel = self._control.fields.cancel
        self.comb += [
            field.restart.eq(cancel),
            field.size.eq(raster_kept["size"]),
            field.dither.eq(raster_kept["dither"]),
            *(port.rdata.ready.eq(1) for port in readers),
            *(port.cmd.we.eq(1) for port in writers),
        ]
        self.specials += Instance("triangle_control", name="triangle_control",
            p_BASE             = main_ram.origin,
            p_MEMORY_BITS      = memory_bits,
            p_SIZES            = sizes,
            p_TRIANGLES        = int(triangles),
            p_SMOOTH           = int(smooth),
            p_TEXTURE          = int(texture),
            p_LINES            = int(lines),
            p_GEOMETRY         = int(has_geometry),
            p_AVERAGE          = int(averages),
            i_clk              = ClockSignal("sys"),
            i_rst              = ResetSignal("sys"),
            i_cancel           = cancel,
            i_geometry_ask     = self._geometry.fields.start,
            i_geometry_flags   = geometry_flags.value,
            i_geometry_loading = self.parameters.loading[0],
            i_geometry         = geometry.value,
            o_geometry_kept    = geometry_kept.value,
            o_geometry_active  = self._status.fields.geometry_busy,
            o_geometry_ended   = self.ev.geometry.trigger,
            o_geometry_error   = self._status.fields.geometry_error,
            i_raster_ask       = self._raster.fields.start,
            i_raster_flags     = raster_flags.value,
            i_raster_loading   = self.parameters.loading[1] | self.field_loading,
            i_raster           = raster.value,
            o_raster_kept      = raster_kept.value,
            o_raster_active    = self._status.fields.raster_busy,
            o_raster_ended     = self.ev.raster.trigger,
            o_raster_error     = self._status.fields.raster_error,
            i_engine           = given.value,
            o_recovering       = recovering,
            **{f"o_{name}": signal for name, signal in start.items()},
        )
        self.specials += Instance("triangle_engine", name="triangle_engine",
            p_TRIANGLES       = int(triangles),
            p_SMOOTH          = int(smooth),
            p_TEXTURE         = int(texture),
            p_SKY             = int(has_sky),
            p_FOG             = int(has_fog),
            p_AVERAGE         = int(averages),
            p_FIELDS          = int(fields),
            p_LINES           = int(lines),
            p_GEOMETRY        = int(has_geometry),
            p_DEPTHS          = int(depths),
            i_clk             = ClockSignal("sys"),
            i_rst             = ResetSignal("sys"),
            i_cancel          = cancel,
            o_status          = status.value,
            **{f"i_{name}": signal for name, signal in start.items()},
            i_geometry_flags  = geometry_kept.value,
            i_geometry        = geometry.value,
            i_view            = view.value,
            o_results         = results.value,
            i_raster_flags    = raster_kept.value,
            i_raster          = raster.value,
            i_sky             = sky.value,
            i_fog             = fog.value,
            i_field_source    = field_source.value,
            o_field_sink      = field_sink.value,
            o_events          = self.counters.events.value,
            **{f"o_{name}_read_request": port["request"].value for name, port in read_ports.items()},
            **{f"i_{name}_read_answer": port["answer"].value for name, port in read_ports.items()},
            **{f"o_{name}_write_request": port["request"].value for name, port in write_ports.items()},
            **{f"i_{name}_write_answer": port["answer"].value for name, port in write_ports.items()},
        )
        add_sources(platform, "triangle_control", "triangle_engine")

    def _held(self, status, lists_pending, frame_pending):
        """Returns the engine's state `status` with ends of passes delayed until all words are in memory."""
        held = status.signals()
        cancel = self._control.fields.cancel
        self.comb += held["ready"].eq(status["ready"] & ~lists_pending & ~frame_pending)
        for name, pending, errors in (("geometry", lists_pending, ("mesh_error", "full")), ("raster", frame_pending, ("list_error",))):
            done, waits = status[f"{name}_done"], Signal()
            self.sync += waits.eq((done | waits) & pending & ~cancel)
            self.comb += [
                held[f"{name}_busy"].eq(status[f"{name}_busy"] | done | waits),
                held[f"{name}_done"].eq((done | waits) & ~pending),
            ]
            for error in errors:
                kept = Signal()
                self.sync += If(done, kept.eq(status[error]))
                self.comb += held[error].eq(Mux(waits, kept, status[error]))
        return held


def memory_ports(get_port, main_ram, triangles=True, texture=False, lines=False, has_geometry=True):
    """Returns the readers and the writers for a `TriangleEngine` with these options. `get_port` returns a memory port of 128 bits that reads
    or writes, from its mode, `"read"` or `"write"`. For a part that is not built, the port is unconnected."""
    has_lists = triangles or lines
    has_geometry = has_geometry and has_lists

    def port(mode, is_built):
        return get_port(mode) if is_built else LiteDRAMNativePort(mode, log2_int(main_ram.size // 16), 128)

    readers = [port("read", built) for built in (has_geometry, has_geometry and triangles, has_lists, has_lists and texture)]
    return readers, [port("write", built) for built in (has_geometry, has_geometry, True, True)]


def _read_port(port):
    """Returns the port connections of a native read port of the memory, in both directions."""
    return {
        "request": Struct("read_request_t", "A read port of the memory: signals to the memory.", {
            "cmd_valid": port.cmd.valid, "cmd_addr": _address(port)}),
        "answer": Struct("read_answer_t", "A read port of the memory: signals from the memory.", {
            "cmd_ready": port.cmd.ready, "rdata_valid": port.rdata.valid, "rdata": port.rdata.data}),
    }


def _address(port):
    """Returns the port's address, extended or shortened to the width in the RTL. For a smaller memory the highest bits are 0, because the
    regions of a pass are checked to be within memory. For a larger memory, the further bits of the port stay 0."""
    address = port.cmd.addr[:_ADDRESS_BITS]
    return Cat(address, Signal(_ADDRESS_BITS - len(address))) if len(address) < _ADDRESS_BITS else address


def _write_port(port):
    """Returns the port connections of a native write port of the memory, in both directions."""
    return {
        "request": Struct("write_request_t", "A write port of the memory: signals to the memory.", {
            "cmd_valid": port.cmd.valid, "cmd_addr": _address(port),
            "wdata_valid": port.wdata.valid, "wdata": port.wdata.data, "wdata_strobe": port.wdata.we}),
        "answer": Struct("write_answer_t", "A write port of the memory: signals from the memory.", {
            "cmd_ready": port.cmd.ready, "wdata_ready": port.wdata.ready}),
    }

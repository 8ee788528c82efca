"""The raymarcher: distance fields, beside the triangles in the band buffer. The work is done by rtl/raymarch."""

from dataclasses import asdict, dataclass
from functools import reduce
from operator import or_

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import Case, Cat, Constant, If, Instance, Mux, ResetSignal, Signal

from .fields import FLAT_FIELDS, KIND_BITS, NAMES, has_octants, mask
from .packed import Package, Struct
from .rtl import add_sources

IDENT = int.from_bytes(b"MARC", "big")

_ERRORS = [
    ("0", "none", "what is asked for is built"),
    ("1", "field", "the sponge, so many levels of it, boxes, spheres, or fillets are not built"),
    ("2", "stereo", "two eyes are not built"),
    ("3", "prepass", "cones are not built"),
]


@dataclass(frozen=True)
class Fields:
    """What a raymarcher is built with: lanes (1, 2, 4), levels of the sponge (0 to 6), flat fields by their names, of which the sponge
    is one where it has levels, spheres, fillets, two eyes, cones before the rays."""

    lanes: int = 2
    levels: int = 6
    flat: tuple = NAMES
    round: bool = True
    blend: bool = True
    stereo: bool = True
    prepass: bool = True

    def parameters(self):
        """Returns those of the module by their names."""
        values = asdict(self)
        return {"FIELDS": mask(values.pop("flat")), **{name.upper(): int(value) for name, value in values.items()}}


BUILDS = {
    "all": Fields(),
    "round": Fields(levels=4, flat=("menger", "box"), blend=False, prepass=False),
    "faces": Fields(levels=4, flat=("menger", "box"), round=False, blend=False, prepass=False),
    "sponge": Fields(lanes=4, levels=4, flat=("menger",), round=False, blend=False),
}
"""What there is to choose from: everything; less and less of it; and the sponge alone, by twice as many lanes."""


class Raymarcher(LiteXModule):
    """Draws distance fields into the frames of a triangle engine's raster pass.

    `clk`, to be driven, is its clock, or that gated by `clock_enable`. `field` is its side of the engine's ports of that name.
    """

    def __init__(self, platform, fields, engine):
        self._ident = CSRStatus(32, name="ident", reset=IDENT, description="`MARC` in ASCII; 0 where the block is absent.")
        self._caps = CSRStatus(name="caps", fields=[
            CSRField("lanes", size=3, offset=0, reset=fields.lanes, description="Evaluations of the field a clock."),
            CSRField("levels", size=3, offset=4, reset=fields.levels, description="The deepest sponge; 0: none."),
            CSRField("stereo", offset=9, reset=int(fields.stereo), description="Two eyes."),
            CSRField("round", offset=10, reset=int(fields.round), description="Spheres, alone and beside what has faces."),
            CSRField("blend", offset=11, reset=int(fields.blend), description="Fillets between both."),
            CSRField("prepass", offset=12, reset=int(fields.prepass), description="Cones before the rays."),
            CSRField("flat", size=8, offset=16, reset=mask(fields.flat), description="Bit k is set if flat fields of the kind k "
                     "of `solid` are built."),
        ], description="What this block can do.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("enable", offset=0, description="Frames of the raster pass have the field, after their triangles."),
            CSRField("stereo", size=2, offset=1, values=[
                ("0", "mono", "one eye"), ("1", "red_blue", "the left eye red, the right one blue, green the smaller of both"),
                ("2", "red_cyan", "the left eye red, the right one green and blue")],
                description="How many eyes look, and in which colours."),
            CSRField("prepass", offset=3, description="A cone for each block of pixels says where its rays begin."),
        ], description="Operation. This and all other registers have to hold while a raster pass runs.")
        self._status = CSRStatus(name="status", fields=[
            CSRField("busy", offset=0, description="A field is being drawn."),
            CSRField("error", size=2, offset=4, values=_ERRORS, description="What the registers ask for and is not built: frames "
                     "are drawn without the field then."),
        ], description="State.")
        self.ev = EventManager()
        self.ev.field = EventSourcePulse(name="field", description="The field of a frame has been drawn.")
        self.ev.finalize()

        self._solid = CSRStorage(name="solid", fields=[
            CSRField("levels", size=6, offset=1, description="Levels of the sponge that count, the first one in bit 0."),
            CSRField("has", size=3, offset=8, description="Axes along which the box has an end, x in bit 0."),
            CSRField("room", offset=11, description="The solid is what is outside of the box."),
            CSRField("repeated", offset=12, description="The box repeats itself every 64 units along each axis."),
            CSRField("is_round", offset=13, description="There are spheres."),
            CSRField("flat_too", offset=14, description="What has faces is there beside them."),
            CSRField("spheres_repeated", offset=15, description="The spheres repeat themselves every 64 units along each axis."),
            CSRField("last_sphere", size=3, offset=16, description="The last sphere's number; 0 where there is none."),
            CSRField("last_light", size=2, offset=20, description="The number of the last light on spheres."),
            CSRField("kind", size=KIND_BITS, offset=22,
                     values=[(str(number), flat.name, flat.text) for number, flat in enumerate(FLAT_FIELDS)],
                     description="The flat field."),
        ], description="The solid.")
        self._cube_half = CSRStorage(22, name="cube_half", description="Half the side of the cubes that a sponge leaves, u10.12.")
        box_half = [self._register(f"half_{axis}", 22, f"Half the side of the box along {axis}, u10.12.") for axis in "xyz"]
        self._tuning = CSRStorage(name="tuning", fields=[
            CSRField("threshold", size=16, offset=0, description="A ray has arrived where the distance is below this, u4.12 ..."),
            CSRField("footprint", size=4, offset=16, description="... and t * 2^-footprint, 7 to 15."),
            CSRField("cap", size=8, offset=20, description="Evaluations after which a ray is given up, from 1."),
        ], description="How finely.")
        self._far = CSRStorage(23, name="far", description="t beyond which there is nothing, u11.12.")
        self._near = CSRStorage(23, name="near", description="Distance of the near plane times 2^e, or of the nearest corner of the "
                                "box, u11.12.")
        origins, outside, first = [], [], []
        for eye in ("left", "right"):
            for axis in "xyz":
                origins.append(self._register(f"origin_{eye}_{axis}", 25, f"Where the {eye} eye is, {axis}, s13.12."))
                outside.append(self._register(f"outside_{eye}_{axis}", 24, f"How far the {eye} eye is outside of the box along "
                                              f"{axis}, u12.12."))
                first.append(self._register(f"first_{eye}_{axis}", 32, f"D of the {eye} eye's first ray, {axis}, s2.30."))
        bounds = [self._register(f"bounds_{axis}", 24, f"Half the side of the box about the field along {axis}, u12.12.")
                  for axis in "xyz"]
        across = [self._register(f"across_{axis}", 32, f"What D grows by with a column, {axis}, s2.30.") for axis in "xyz"]
        down = [self._register(f"down_{axis}", 32, f"What D grows by with a line, {axis}, s2.30.") for axis in "xyz"]
        offset = [self._register(f"cone_offset_{axis}", 32, f"What D grows by from a block's first pixel to its middle, {axis}, s2.30.")
                  for axis in "xyz"]
        self._cone_spread = CSRStorage(14, name="cone_spread", description="The most by which D differs from that in the middle of a "
                                       "block, u0.18.")
        self._depth_scale = CSRStorage(name="depth_scale", fields=[
            CSRField("mantissa", size=17, offset=0, description="In 2^16 to 2^17 - 1."),
            CSRField("exponent", size=6, offset=17, description="Two's complement."),
        ], description="K for depths in field units times 2^e: mantissa * 2^exponent.")
        palette = [self._register(f"colour_{number}", 24, f"Colour of {what}: red in bits 0 to 7, green, blue.")
                   for number, what in enumerate([*(f"faces whose normal points {way} {axis}" for axis in "xyz"
                                                    for way in ("against", "along")), "rays that were given up", "the zenith"])]
        self._horizon = CSRStorage(24, name="horizon", description="Colour of the horizon, and of the fog.")
        self._fog_shift = CSRStorage(3, name="fog_shift", description="An entry of the fog is for 2^this field units times 2^e.")
        self._table = CSRStorage(name="table", fields=[
            CSRField("part", size=8, offset=0, description="Of 255."),
            CSRField("entry", size=9, offset=8, description="0 to 255: what the fog hides, by depth. 256 to 511: what light is left, "
                     "by evaluations."),
        ], description="Writing sets an entry of fog or light.")

        self._sphere = CSRStorage(name="sphere", fields=[
            CSRField("value", size=24, offset=0, description="A constant of spheres or their light."),
            CSRField("entry", size=6, offset=24, description="0 to 2: a sphere's centre, x, y, z, s9.12. 3: its radius, u9.12. 4: the "
                     "inverse of the radius in bits 0 to 16, and its shift. 8 + n: the colour of sphere n, which takes these constants. "
                     "16 + 4i + 0, 1, 2: the direction to light i, s1.16. 16 + 4i + 3: its colour. 5: the ambient light's colour. 6: the "
                     "width of the fillet, u5.12, 0 without one. 7: 1 over twice that, u1.16. 32, 33: the colours "
                     "of the faces 6 and 7 of a field that has eight."),
        ], description="Writing sets a constant of spheres, their light, or faces.")

        counters = {
            "cycles_busy": "Clock cycles in which a field was drawn.",
            "cycles_stalled": "Clock cycles in which a ray waited as no end of one was taken.",
            "items_in": "Rays.",
            "items_out": "Pixels given to the band buffer, each eye's.",
            "cycles_idle": "Clock cycles, of each lane, in which it had room for a ray and none came.",
            "evaluations": "Evaluations of the field: slots of the lanes that were occupied.",
            "hits": "Rays that came to a surface.",
            "misses": "Rays that went by.",
            "undecided": "Rays that were given up.",
        }
        status = {}
        for name, description in counters.items():
            status[name] = CSRStatus(32, name=name, description=description[:-1] + ", modulo 2^32.")
            setattr(self, f"_{name}", status[name])
        self.counters = list(counters)

        # # #

        self.clk = Signal()
        self.clock_enable = Signal()
        enable, stereo, prepass = (getattr(self._control.fields, name) for name in ("enable", "stereo", "prepass"))
        busy, was_busy = self._status.fields.busy, Signal()
        error = self._status.fields.error
        solid, tuning = self._solid.fields, self._tuning.fields
        write_sphere, number, sphere, lights, (blend_width, blend_inverse) = self._spheres(fields, solid.last_light)
        # Without levels the sponge is an empty field: what a frame of spheres alone asks for.
        unknown = [solid.kind == number for number, flat in enumerate(FLAT_FIELDS) if number and flat.name not in fields.flat]
        not_built = Signal()
        self.comb += not_built.eq(reduce(or_, unknown, Constant(0)) | (solid.is_round & int(not fields.round)) |
                                  (solid.flat_too & ((blend_width | blend_inverse) != 0) & int(not fields.blend)))
        too_deep = (solid.kind == 0) & (solid.levels >> fields.levels != 0)
        constants = Struct("solid_t", "The solid: the fillet's width, u5.12, 0 without one, and 1 over twice that, u1.16; whether the flat "
            "field is there beside spheres, whether there are any, whether they repeat themselves, and the last one's number; the "
            "flat field, and its constants.", {
            "blend_width": blend_width, "blend_inverse": blend_inverse,
            **{name: getattr(solid, name) for name in ("flat_too", "is_round", "spheres_repeated", "last_sphere", "kind", "levels")},
            "cube_half": self._cube_half.storage, "half": box_half,
            **{name: getattr(solid, name) for name in ("has", "room", "repeated")}})
        limits = Struct("tuning_t", "The tuning: distance and part of t below which a ray has hit, its most evaluations, its largest t.", {
            **{name: getattr(tuning, name) for name in ("threshold", "footprint", "cap")}, "far_limit": self._far.storage})
        colours = Struct("palette_t", "Colours, {blue, green, red}: the zenith, rays that were given up, and faces by their surface.", {
            "zenith": palette[7], "undecided": palette[6], "faces": [*palette[:6], *self._octants(fields)]})
        self.package = Package("raymarch", structs=[constants, sphere, lights, limits, colours])
        # The engine's clock runs while a pass does; the tables are written while it stands.
        lingers, working = Signal(5), Signal()
        self.comb += [
            If(not_built | too_deep, error.eq(1)).Elif((stereo != 0) & int(not fields.stereo), error.eq(2)).Elif(
                prepass & int(not fields.prepass), error.eq(3)),
            engine.field.enable.eq(enable & (error == 0)),
            engine.field.compose.eq(stereo),
            working.eq(ResetSignal("sys") | self._table.re | self._sphere.re | (enable & engine.clock_enable)),
            self.clock_enable.eq(working | (lingers != 0)),
            self.ev.field.trigger.eq(was_busy & ~busy),
        ]
        self.sync += [
            was_busy.eq(busy),
            If(working, lingers.eq(31)).Elif(lingers != 0, lingers.eq(lingers - 1)),
            If(engine.field.valid & engine.field.ready, status["items_out"].status.eq(status["items_out"].status + 1)),
        ]
        eye = Signal()
        self.comb += engine.field.halves.eq(Mux(stereo == 0, 0b11, Mux(eye, 0b10, 0b01)))
        self.specials += Instance("raymarcher", name="raymarcher",
            **{f"p_{name}": value for name, value in fields.parameters().items()},
            i_clk            = self.clk,
            i_rst            = ResetSignal("sys"),
            i_restart        = engine.field.restart,
            i_start          = engine.field.start,
            o_busy           = busy,
            i_size           = engine.field.size,
            i_stereo         = stereo != 0,
            i_first          = Cat(*first),
            i_across         = Cat(*across),
            i_down           = Cat(*down),
            i_near_limit     = self._near.storage,
            i_origins        = Cat(*origins),
            i_outside        = Cat(*outside),
            i_bounds         = Cat(*bounds),
            i_solid          = constants.value,
            i_sphere_write   = write_sphere,
            i_sphere_number  = number,
            i_sphere         = sphere.value,
            i_lights         = lights.value,
            i_tuning         = limits.value,
            i_prepass        = prepass,
            i_cone_offset    = Cat(*offset),
            i_cone_spread    = self._cone_spread.storage,
            i_depth_mantissa = self._depth_scale.fields.mantissa,
            i_depth_exponent = self._depth_scale.fields.exponent,
            i_fog_shift      = self._fog_shift.storage,
            i_palette        = colours.value,
            i_horizon        = self._horizon.storage,
            i_table_write    = self._table.re,
            i_table_entry    = self._table.fields.entry,
            i_table_part     = self._table.fields.part,
            i_band_open      = engine.field.open,
            o_band_done      = engine.field.done,
            i_band_next      = engine.field.next,
            o_group_valid    = engine.field.valid,
            i_group_ready    = engine.field.ready,
            o_group_eye      = eye,
            **{f"o_group_{name}": getattr(engine.field, name) for name in ("row", "line", "column", "mask", "code", "colour")},
            o_clocks_busy    = status["cycles_busy"].status,
            o_clocks_idle    = status["cycles_idle"].status,
            o_clocks_waiting = status["cycles_stalled"].status,
            o_evaluations    = status["evaluations"].status,
            o_rays           = status["items_in"].status,
            o_hits           = status["hits"].status,
            o_misses         = status["misses"].status,
            o_undecided      = status["undecided"].status,
        )
        add_sources(platform, "raymarcher")

    def _spheres(self, fields, last_light):
        """The constants that writes to `sphere` leave: whether a sphere is written, its number, the sphere, the lights, and width and
        inverse of the fillet."""
        value, entry = self._sphere.fields.value, self._sphere.fields.entry
        centre, radius, inverse = [Signal(22) for _ in range(3)], Signal(21), Signal(22)
        directions, colours = [[Signal(18) for _ in range(3)] for _ in range(4)], [Signal(24) for _ in range(4)]
        ambient, blend = Signal(24), [Signal(17), Signal(17)]
        write = Signal()
        if fields.round:
            places = {**dict(enumerate([*centre, radius, inverse, ambient, *blend])),
                      **{16 + 4*light + axis: part for light, direction in enumerate(directions) for axis, part in enumerate(direction)},
                      **{19 + 4*light: colour for light, colour in enumerate(colours)}}
            self.sync += If(self._sphere.re, Case(entry, {number: place.eq(value) for number, place in places.items()}))
            self.comb += write.eq(self._sphere.re & (entry[3:] == 0b001))
        sphere = Struct("sphere_t", "A sphere: its material, {blue, green, red}; the inverse of its radius and a shift (docs/formats.md, "
                        "\"Light\"); its radius, and its centre.", {
            "material": value, "shift": inverse[17:], "inverse": inverse[:17], "radius": radius, "centre": centre})
        lights = Struct("lights_t", "The light on spheres: the last light's number, ambient light, and lights in their colours from "
                        "their directions, s1.16.", {
            "last_light": last_light, "ambient": ambient, "colours": colours, "directions": directions})
        return write, entry[:3], sphere, lights, blend

    def _octants(self, fields):
        """The colours of the faces 6 and 7, which writes to `sphere` set; without registers where no field has such faces."""
        if not has_octants(fields.flat):
            return [Constant(0, 24)] * 2
        colours = [Signal(24), Signal(24)]
        self.sync += If(self._sphere.re, Case(self._sphere.fields.entry, {
            32 + number: colour.eq(self._sphere.fields.value) for number, colour in enumerate(colours)}))
        return colours

    def _register(self, name, size, description):
        """Adds a register and returns what is in it."""
        register = CSRStorage(size, name=name, description=description)
        setattr(self, f"_{name}", register)
        return register.storage

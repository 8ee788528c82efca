"""The raymarcher: draws distance fields into the bands of the triangle engine. rtl/raymarch implements it."""

from dataclasses import asdict, dataclass, replace
from functools import reduce
from operator import or_

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import Case, Cat, ClockSignal, Constant, If, Instance, Mux, ResetSignal, Signal

from .clock_control import ClockControl
from .counters import Counters
from .fields import FLAT_FIELDS, KIND_BITS, NAMES, has_marching, has_octants, mask
from .packed import Package, Struct
from .parameters import Parameter, PassParameters
from .rtl import add_sources

IDENT = int.from_bytes(b"MARC", "big")

_ERRORS = [
    ("0", "none", "all requested features are built"),
    ("1", "field", "the flat field, the depth of the sponge, spheres, a lattice, fillets, colours by normals, a highlight or shadows are not built"),
    ("2", "stereo", "two eyes are not built"),
]

_RULES = [("0", "box", "inside of a box, or of an octahedron: a box along diagonals"), ("1", "planes", "outside of the slab between two planes"),
          ("2", "sponge", "Menger sponge"), ("3", "cubes", "cubes, repeated every 64 field units, or spheres in such cubes")]

_EXITS = [("0", "second", "the second of three"), ("1", "first", "the first"), ("2", "last", "the last")]

INTERVAL_BITS = 13
"""Width of the interval of a coordinate: `INTERVAL_BITS` of rtl/raymarch/exit_pkg.sv."""


@dataclass(frozen=True)
class Fields:
    """Build options of a raymarcher: `lanes`, the number of lanes (1, 2 or 4); `levels` of the sponge (0 to 6); `flat`, the names of
    the flat fields, including the sponge if it has levels; `round`, spheres of a list; `lattice`, spheres of a lattice; `blend`,
    fillets between spheres and flat fields; `stereo`, two eyes; `normals`, colours of spheres by their normals; `highlight` on
    spheres; `shadow` on faces; `cone`, a solid cone, which needs `round`."""

    lanes: int = 2
    levels: int = 6
    flat: tuple = NAMES
    round: bool = True
    lattice: bool = True
    blend: bool = True
    stereo: bool = True
    normals: bool = True
    highlight: bool = True
    shadow: bool = True
    cone: bool = True

    @property
    def has_spheres(self):
        """Whether some fields have spheres."""
        return self.round or self.lattice

    @property
    def has_marching(self):
        """Whether rays of some fields march by distances."""
        return self.blend and has_marching(self.flat)

    def parameters(self):
        """Returns the parameters of the module by name."""
        values = asdict(self)
        return {"FIELDS": mask(values.pop("flat")), **{name.upper(): int(value) for name, value in values.items()}}


_FACES_ALONE = dict.fromkeys(("round", "lattice", "blend", "normals", "highlight", "shadow", "cone"), False)

BUILDS = {
    "all": Fields(),
    "round": Fields(levels=4, flat=("menger", "box"), lattice=False, blend=False, highlight=False, shadow=False, cone=False),
    "faces": Fields(levels=4, flat=("menger", "box"), **_FACES_ALONE),
    "sponge": Fields(lanes=4, levels=4, flat=("menger",), **_FACES_ALONE),
}
"""Builds of the raymarcher by name: one with all features, two with fewer features, and one for the sponge alone with twice as
many lanes."""

_FEATURES = {"spheres": "round", "lattice": "lattice", "fillets": "blend", "stereo": "stereo", "normals": "normals", "highlight": "highlight",
             "shadow": "shadow", "cone": "cone"}


def build(text, lanes=None):
    """Returns the build options that `text` names. `lanes`, if given, replaces the number of lanes of the build.

    `text` is the name of one of `BUILDS`, or a list of features with commas between them: `menger:LEVELS`, the names of other flat
    fields, `spheres`, `lattice`, `fillets`, `stereo`, `normals`, `highlight`, `shadow`, `cone`.
    """
    if text in BUILDS:
        fields = BUILDS[text]
    else:
        levels, flat, features = 0, [], dict.fromkeys(_FEATURES.values(), False)
        for name in text.split(","):
            sponge, _, depth = name.partition(":")
            if sponge == NAMES[0] and depth in ("1", "2", "3", "4", "5", "6"):
                flat, levels = [sponge, *flat], int(depth)
            elif name in NAMES[1:]:
                flat.append(name)
            elif name in _FEATURES:
                features[_FEATURES[name]] = True
            else:
                raise ValueError(f"fields {name!r}: expected one of {', '.join(BUILDS)}, or some of {NAMES[0]}:1 to {NAMES[0]}:6, "
                                 f"{', '.join((*NAMES[1:], *_FEATURES))}")
        fields = Fields(levels=levels, flat=tuple(flat), **features)
    return replace(fields, lanes=lanes) if lanes else fields


class Raymarcher(LiteXModule):
    """Draws distance fields into the frames of the raster pass of `engine`, a triangle engine."""

    def __init__(self, platform, fields, engine):
        self._ident = CSRStatus(32, name="ident", reset=IDENT, description="`MARC` in ASCII; 0 where the block is absent.")
        self._caps = CSRStatus(name="caps", fields=[
            CSRField("lanes", size=3, offset=0, reset=fields.lanes, description="Lanes: evaluations of the field per clock."),
            CSRField("levels", size=3, offset=4, reset=fields.levels, description="Largest depth of a sponge; 0 without sponges."),
            CSRField("cone", offset=7, reset=int(fields.cone), description="A solid cone."),
            CSRField("stereo", offset=9, reset=int(fields.stereo), description="Two eyes."),
            CSRField("round", offset=10, reset=int(fields.round), description="Spheres of a list, alone and in unions."),
            CSRField("blend", offset=11, reset=int(fields.blend), description="Fillets between spheres and flat fields."),
            CSRField("lattice", offset=12, reset=int(fields.lattice), description="Spheres of a lattice."),
            CSRField("normals", offset=13, reset=int(fields.normals), description="Colours of spheres by their normals."),
            CSRField("highlight", offset=14, reset=int(fields.highlight), description="A highlight on spheres."),
            CSRField("shadow", offset=15, reset=int(fields.shadow), description="Shadows on faces."),
            CSRField("flat", size=8, offset=16, reset=mask(fields.flat), description="Bit k is set if the flat field of kind k in "
                                                           "`solid` is built."),
        ], description="Capabilities of this build.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("enable", offset=0, description="Draws the field in every raster pass, before the triangles."),
            CSRField("stereo", size=2, offset=1, values=[
                ("0", "mono", "one eye"), ("1", "red_blue", "left eye red, right eye blue, green is the smaller of both"),
                ("2", "red_cyan", "left eye red, right eye green and blue")],
                description="Number of eyes, and their colours."),
        ], description="Operation. All registers of this block must hold during a raster pass.")
        self._status = CSRStatus(name="status", fields=[
            CSRField("busy", offset=0, description="A field is being drawn."),
            CSRField("error", size=2, offset=4, values=_ERRORS, description="Feature that the registers request and that this build "
                     "does not have. Frames are then drawn without the field."),
        ], description="State.")
        self.ev = EventManager()
        self.ev.field = EventSourcePulse(name="field", description="The field of a frame has been drawn.")
        self.ev.finalize()

        self._solid = Parameter(name="solid", fields=[
            CSRField("levels", size=6, offset=1, description="Mask of the sponge levels in use, the first level in bit 0; 0 for a box."),
            CSRField("is_round", offset=13, description="The field has spheres."),
            CSRField("spheres_repeated", offset=15, description="The first sphere repeats every 64 field units along each axis."),
            CSRField("last_sphere", size=3, offset=16, description="Number of the last sphere; 0 without spheres."),
            CSRField("last_light", size=2, offset=20, description="Number of the last light on spheres."),
            CSRField("kind", size=KIND_BITS, offset=22,
                     values=[(str(number), flat.name, flat.text) for number, flat in enumerate(FLAT_FIELDS)],
                     description="Kind of the flat field."),
            CSRField("last_cone_left", size=4, offset=24, description="For rays by exits, number of the last cone of the left eye."),
            CSRField("last_cone_right", size=4, offset=28, description="For rays by exits, number of the last cone of the right eye."),
        ], description="The solid, and the number of spheres and lights.")
        self._exits = Parameter(name="exits", fields=[
            CSRField("enable", offset=0, description="1: rays by exits. 0: marching rays, which start at the bounding box."),
            CSRField("rule", size=2, offset=1, values=_RULES, description="The solid; `box` for marching rays."),
            CSRField("depth", size=3, offset=4, description="Levels of the sponge; 1 for spheres instead of cubes, and for an octahedron."),
            *(CSRField(f"{eye}_exit", size=2, offset=8 + 2 * number, values=_EXITS,
                       description=f"Plane through which a ray leaves the prism around the {eye} eye: the order among its planes.")
              for number, eye in enumerate(("left", "right"))),
            CSRField("shadow", offset=12, description="Faces of a sponge and of repeated boxes may be in the shadow of the first light."),
        ], description="The solid for rays by exits; for marching rays, the bounding box.")
        border = [self._register(f"border_{axis}", 22, f"For rays by exits, the coordinate of a plane perpendicular to {axis}, s9.12: the "
                                 "lower plane of a box or sponge, the upper plane of `planes`, or the lower plane of the cube after the middle cube.")
                  for axis in "xyz"]
        box_half = [self._register(f"half_{axis}", 22, f"Half the side along {axis}, u10.12: of the solid, of a repeated cube, or, for marching "
                                   "rays, of the sponge's smallest solid cubes.") for axis in "xyz"]
        self._tuning = Parameter(name="tuning", fields=[
            CSRField("threshold", size=16, offset=0, description="Threshold, u4.12: a ray hits where the distance is below "
                     "threshold + T * 2^-(footprint + 7)."),
            CSRField("footprint", size=4, offset=16, description="Exponent of the part of the threshold that grows with T, minus 7."),
            CSRField("cap", size=10, offset=20, description="Step limit, at least 1: evaluations after which a ray is undecided."),
        ], description="Threshold and step limit of marching rays.")
        self._far = Parameter(28, name="far", description="Far limit of T, u14.14.")
        self._near = Parameter(28, name="near", description="T of the near plane, u14.14.")
        origins, first, starts, sums, nexts = [], [], [], [], []
        for eye in ("left", "right"):
            for axis in "xyz":
                origins.append(self._register(f"origin_{eye}_{axis}", 25, f"Position of the {eye} eye, {axis}, s13.12."))
                first.append(self._register(f"first_{eye}_{axis}", 32, f"D of the {eye} eye's first ray, {axis}, s2.30."))
                nexts.append(self._register(f"next_{eye}_{axis}", 29, f"Intervals above the planes that bound the prism around the {eye} eye "
                                            f"along {axis} (rtl/raymarch/exit_pkg.sv): along the axis in bits 0 to 12, along the "
                                            "mirrored axis in bits 16 to 28."))
            for way, text in (("", ""), ("mirrored_", "mirrored ")):
                for axis in "xyz":
                    starts.append(self._register(f"start_{eye}_{way}{axis}", 28, "Plane of the empty prism around the "
                                                 f"{eye} eye along the {text}{axis} axis: its distance in bits 0 to 24, u12.12; "
                                                 "bit 25 is set if there is such a plane, bit 26 if a ray along this axis leads away from the "
                                                 "solid, bit 27 if a ray beyond the plane has left the solid."))
                sums.append(self._register(f"start_{eye}_{way}sum", 27, f"The same along the {text}fourth axis of an octahedron, without "
                                           "bit 27."))
        bounds = [self._register(f"bounds_{axis}", 21, f"For marching rays, half the side of the bounding box along {axis}, u9.12.")
                  for axis in "xyz"]
        across = [self._register(f"across_{axis}", 32, f"Change of D per column, {axis}, s2.30.") for axis in "xyz"]
        down = [self._register(f"down_{axis}", 32, f"Change of D per line, {axis}, s2.30.") for axis in "xyz"]
        self._depth_scale = Parameter(name="depth_scale", fields=[
            CSRField("mantissa", size=17, offset=0, description="Mantissa, 2^16 to 2^17 - 1."),
            CSRField("exponent", size=6, offset=17, description="Exponent, two's complement."),
        ], description="Scale K of depth codes, for depths in field units times 2^e: mantissa * 2^exponent.")
        palette = [self._register(f"colour_{number}", 24, f"Colour of {what}: red in bits 0 to 7, green in bits 8 to 15, blue in "
                                  "bits 16 to 23.")
                   for number, what in enumerate([*(f"faces whose normal points {way} {axis}" for axis in "xyz"
                                                    for way in ("against", "along")), "undecided rays", "the zenith"])]
        self._horizon = Parameter(24, name="horizon", description="Colour of the horizon, and of the fog.")
        self._fog_shift = Parameter(3, name="fog_shift", description="Exponent of the range of the fog: the table covers "
                                     "2^(8 + fog_shift) field units times 2^e.")
        self._table = Parameter(name="table", fields=[
            CSRField("part", size=8, offset=0, description="Share, in 255ths."),
            CSRField("entry", size=9, offset=8, description="0 to 255: share hidden by fog, by depth. 256 to 511: remaining share of "
                     "light, by number of evaluations."),
        ], description="Writing sets an entry of the tables of fog and light.")

        self._sphere = Parameter(name="sphere", fields=[
            CSRField("value", size=24, offset=0, description="Value of the constant."),
            CSRField("entry", size=6, offset=24, description="0 to 2: centre of a sphere, x, y, z, s10.12. 3: radius of the sphere, "
                     "u9.12, for marching rays. 4: inverse of the radius in bits 0 to 16, and its shift. 5: colour of the ambient light. 6: width of "
                     "the fillet, u5.12, 0 without a fillet. 7: 1 / (2 * width), u1.16. 8 + n: colour of sphere n, which also takes "
                     "the constants 0 to 4. 16 + 4i + 0, 1, 2: direction to light i, s1.16. 16 + 4i + 3: colour of light i. 32, 33: "
                     "colours of the faces 6 and 7 of a field with eight faces. 34, 35, 36: direction of the highlight, halfway to "
                     "light 0 and to the camera, s1.16. 37: bit 0 is set if colours of spheres depend on their normals, bit 1 if there are "
                     "lights (required if bit 0 is clear), bit 2 if there is a highlight; bits 8 to 20 are the steepness of the highlight, "
                     "u5.8. 38: its colour. 39: bit 4 is set if the list includes a solid cone, and bits 0 to 3 are the exponent of the "
                     "light on it; 52, 53: component x of the direction for the x axis and component z of the direction for the z axis, "
                     "s1.16, for the light on a cone (docs/formats/raymarch.md). "
                     "40, 41, 42: colours of faces perpendicular to x, y, z that face light 0 and are in its shadow. 43, 44, 45: direction "
                     "to light 0, s1.14, for shadows. 46, 47, 48: the lowest 24 bits of the reciprocals of half its components "
                     "(rtl/raymarch/exit_pkg.sv). 49, 50, 51: their highest 8 bits."),
        ], description="Writing sets a constant of spheres, lights or faces.")

        self._cone_address = Parameter(9, name="cone_address", description="Address of the next write to `cone_value`: the eye in bit 8, the "
                                       "number of the cone in bits 4 to 7, the number of the constant in bits 0 to 3 "
                                       "(rtl/raymarch/sphere_unit.sv).")
        self._cone_value = Parameter(32, name="cone_value", description="Writing sets a constant of the cone in which an eye sees a sphere, "
                                     "and increases the address by 1.")

        self.counters = Counters(self, {
            "cycles_busy": "Clock cycles in which a field was drawn.",
            "cycles_stalled": "Clock cycles in which a ray waited because no end of a ray was taken.",
            "items_in": "Rays.",
            "items_out": "Pixels sent to the band buffer, counted for each eye.",
            "cycles_idle": ("Clock cycles, summed over the lanes, in which a lane had a free slot and no ray arrived.", 3),
            "evaluations": ("Evaluations of the field: occupied slots of the lanes.", 3),
            "hits": "Rays that hit.",
            "misses": "Rays that missed.",
            "undecided": "Undecided rays.",
        })

        enable, stereo = (getattr(self._control.fields, name) for name in ("enable", "stereo"))
        busy, was_busy = self._status.fields.busy, Signal()
        error = self._status.fields.error
        solid, exits, tuning = self._solid.fields, self._exits.fields, self._tuning.fields
        shadow, shadow_colours = self._shadow(fields, exits.shadow)
        write_sphere, number, sphere, lights, (blend_width, blend_inverse) = self._spheres(fields, solid.last_light)
        cone_write, cone_address = self._cones(fields)
        # Every build accepts kind 0, the sponge: without levels it is an empty field, which frames with only spheres select.
        unknown = [solid.kind == number for number, flat in enumerate(FLAT_FIELDS) if number and flat.name not in fields.flat]
        not_built = Signal()
        no_rays = ~exits.enable & int(not fields.has_marching)
        has_list = solid.is_round & (~solid.spheres_repeated | (solid.last_sphere != 0))
        self.comb += not_built.eq(reduce(or_, unknown, Constant(0)) | no_rays | (has_list & int(not fields.round)) |
                                  (exits.enable & exits.shadow & int(not fields.shadow)) |
                                  (exits.enable & (exits.rule == 3) & exits.depth[0] & int(not fields.lattice)) |
                                  (solid.is_round & lights["normals"] & int(not fields.normals)) |
                                  (solid.is_round & lights["highlight"] & int(not fields.highlight)))
        too_deep = (solid.kind == 0) & (solid.levels >> fields.levels != 0)
        constants = Struct("solid_t", "The solid of marching rays. `blend_width` is the width of the fillet, u5.12, and "
            "`blend_inverse` is 1 / (2 * width), u1.16. `spheres_repeated` is high if the first sphere is repeated, by exits.", {
            "blend_width": blend_width, "blend_inverse": blend_inverse,
            **{name: getattr(solid, name) for name in ("spheres_repeated", "last_sphere", "levels")}, "half": _contents(box_half)})
        limits = Struct("tuning_t", "Constants of marching rays: threshold, footprint, step limit.", {
            name: getattr(tuning, name) for name in ("threshold", "footprint", "cap")})
        colours = Struct("palette_t", "Colours, {blue, green, red}, of the zenith, of undecided rays, of the faces by surface, and "
            "of faces in the shadow by axis.", {
            "zenith": palette[7].storage, "undecided": palette[6].storage,
            "faces": [*_contents(palette[:6]), *self._octants(fields)], "shadows": shadow_colours})
        self.package = Package("raymarch", structs=[constants, sphere, lights, shadow, limits, colours, self.counters.events])
        # The registers that this build uses, except registers whose writes take effect at once.
        eyes = 2 if fields.stereo else 1
        registers = [*box_half, self._far, self._near, *origins[:3*eyes], *first[:3*eyes], *across, *down, *border, *starts[:6*eyes], *nexts[:3*eyes],
                     self._depth_scale, *palette, self._horizon, self._fog_shift]
        if has_octants(fields.flat):
            registers += sums[:2*eyes]
        if fields.has_marching:
            registers += [self._tuning, *bounds]
        self.parameters = PassParameters(registers)
        # Parameters are also copied while the block is disabled.
        self.clock_control = ClockControl(
            engine.raster_load | self.parameters.loading | (enable & engine.clock_control.enable))
        self.comb += [
            If(not_built | too_deep, error.eq(1)).Elif((stereo != 0) & int(not fields.stereo), error.eq(2)),
            self.parameters.load.eq(engine.raster_load),
            engine.field_loading.eq(self.parameters.loading),
            engine.field.enable.eq(enable & (error == 0)),
            engine.field.compose.eq(stereo),
            self.ev.field.trigger.eq(was_busy & ~busy),
        ]
        self.sync += was_busy.eq(busy)
        eye = Signal()
        self.comb += engine.field.halves.eq(Mux(stereo == 0, 0b11, Mux(eye, 0b10, 0b01)))
        self.specials += Instance("raymarcher", name="raymarcher",
            **{f"p_{name}": value for name, value in fields.parameters().items()},
            i_clk            = ClockSignal("sys"),
            i_rst            = ResetSignal("sys"),
            i_restart        = engine.field.restart,
            i_start          = engine.field.start,
            o_busy           = busy,
            i_size           = engine.field.size,
            i_dither         = engine.field.dither,
            i_stereo         = stereo != 0,
            i_first          = Cat(*_contents(first)),
            i_across         = Cat(*_contents(across)),
            i_down           = Cat(*_contents(down)),
            i_near_limit     = self._near.storage,
            i_far_limit      = self._far.storage,
            i_exits          = exits.enable,
            i_rule           = exits.rule,
            i_levels         = exits.depth,
            i_halves         = Cat(*(half.storage[:21] for half in box_half)),
            i_borders        = Cat(*_contents(border)),
            i_choice         = Cat(exits.left_exit, exits.right_exit),
            i_distances      = Cat(*(start.storage[:25] for start in starts)),
            i_there          = Cat(*(start.storage[25] for start in starts)),
            i_away           = Cat(*(start.storage[26] for start in starts)),
            i_last           = Cat(*(start.storage[27] for start in starts)),
            i_sum_distances  = Cat(*(start.storage[:25] for start in sums)),
            i_sum_there      = Cat(*(start.storage[25] for start in sums)),
            i_sum_away       = Cat(*(start.storage[26] for start in sums)),
            i_nexts          = Cat(*(after.storage[way:way + INTERVAL_BITS] for pair in (nexts[:3], nexts[3:]) for way in (0, 16)
                                     for after in pair)),
            i_origins        = Cat(*_contents(origins)),
            i_bounds         = Cat(*_contents(bounds)),
            i_solid          = constants.value,
            i_sphere_write   = write_sphere,
            i_sphere_number  = number,
            i_sphere         = sphere.value,
            i_lights         = lights.value,
            i_shadow         = shadow.value,
            i_last_cone      = Cat(solid.last_cone_left, solid.last_cone_right),
            i_cone_write     = cone_write,
            i_cone_address   = cone_address,
            i_cone_value     = self._cone_value.storage,
            i_tuning         = limits.value,
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
            o_events         = self.counters.events.value,
        )
        add_sources(platform, "raymarcher")

    def _spheres(self, fields, last_light):
        """Decodes writes to the register `sphere`. Returns whether a sphere is written, its number, the sphere, the lights, and
        the fillet's width and its inverse."""
        value, entry = self._sphere.fields.value, self._sphere.fields.entry
        centre, radius, inverse = [Signal(23) for _ in range(3)], Signal(21), Signal(22)
        directions, colours = [[Signal(18) for _ in range(3)] for _ in range(4)], [Signal(24) for _ in range(4)]
        ambient, blend = Signal(24), [Signal(17), Signal(17)]
        half, (normals, lit, highlight), steepness, shine = [Signal(18) for _ in range(3)], [Signal() for _ in range(3)], Signal(13), Signal(24)
        cone, lead, across, along = Signal(), Signal(4), Signal(18), Signal(18)
        write = Signal()
        if fields.has_spheres:
            places = {**dict(enumerate([*centre, radius, inverse, ambient, *blend])),
                      **{16 + 4*light + axis: part for light, direction in enumerate(directions) for axis, part in enumerate(direction)},
                      **{19 + 4*light: colour for light, colour in enumerate(colours)},
                      **{34 + axis: part for axis, part in enumerate(half)}, 37: Cat(normals, lit, highlight, Signal(5), steepness), 38: shine}
            if fields.cone:
                places |= {39: Cat(lead, cone), 52: across, 53: along}
            self.sync += If(self._sphere.re, Case(entry, {number: place.eq(value) for number, place in places.items()}))
            self.comb += write.eq(self._sphere.re & (entry[3:] == 0b001))
        sphere = Struct("sphere_t", "A sphere: its material, {blue, green, red}; the reciprocal of its radius and a shift "
            "(docs/formats/raymarch.md, \"Light on spheres\"); its radius, and its centre.", {
            "material": value, "shift": inverse[17:], "inverse": inverse[:17], "radius": radius, "centre": centre})
        lights = Struct("lights_t", "Light on spheres: whether colours depend on normals, whether there are lights and a highlight, "
            "the steepness, the colour and the direction of the highlight, number of the last light, ambient light, colours of the lights, and directions "
            "to the lights, s1.16. Whether the list has a solid cone, the exponent of the light on it, and components of the directions of axes for it.", {
            "cone": cone, "lead": lead, "across": across, "along": along,
            "normals": normals, "lit": lit, "highlight": highlight, "steepness": steepness, "shine": shine, "half": half,
            "last_light": last_light, "ambient": ambient, "colours": colours, "directions": directions})
        return write, entry[:3], sphere, lights, blend

    def _shadow(self, fields, enable):
        """Decodes writes to the register `sphere` for shadows. Returns the struct of the rays to the light, and the colours of faces in the
        shadow; both are constants in builds without shadows."""
        colours, directions = [Signal(24) for _ in range(3)], [Signal(16) for _ in range(3)]
        low, high = [Signal(24) for _ in range(3)], [Signal(8) for _ in range(3)]
        if fields.shadow:
            places = dict(enumerate([*colours, *directions, *low, *high], start=40))
            self.sync += If(self._sphere.re, Case(self._sphere.fields.entry, {
                number: place.eq(self._sphere.fields.value) for number, place in places.items()}))
        shadow = Struct("shadow_t", "Rays to the first light: reciprocals of half the components of the direction to it (exit_pkg), in the order x, "
            "y, z from the lowest bits; this direction, s1.14; and whether there are shadows.", {
            "inverse": Cat(*(part for pair in zip(low, high) for part in pair)), "direction": Cat(*directions), "enable": enable})
        return shadow, colours

    def _cones(self, fields):
        """Returns the strobe of a write to `cone_value`, and the address that it writes."""
        write, address, following = Signal(), Signal(9), Signal(9)
        if fields.round:
            self.sync += [
                write.eq(self._cone_value.re),
                If(self._cone_value.re, address.eq(following), following.eq(following + 1)),
                If(self._cone_address.re, following.eq(self._cone_address.storage)),
            ]
        return write, address

    def _octants(self, fields):
        """Returns the colours of faces 6 and 7, set by writes to `sphere`, or constants in builds without such faces."""
        if not has_octants(fields.flat):
            return [Constant(0, 24)] * 2
        colours = [Signal(24), Signal(24)]
        self.sync += If(self._sphere.re, Case(self._sphere.fields.entry, {
            32 + number: colour.eq(self._sphere.fields.value) for number, colour in enumerate(colours)}))
        return colours

    def _register(self, name, size, description):
        """Adds a register and returns it."""
        register = Parameter(size, name=name, description=description)
        setattr(self, f"_{name}", register)
        return register


def _contents(registers):
    return [register.storage for register in registers]

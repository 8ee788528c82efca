"""The RTL modules under test, and the parameters of their builds; the variants of the soft core."""

from dataclasses import dataclass, field
from pathlib import Path

import pythondata_cpu_vexriscv
from litex.soc.cores.cpu.vexriscv.core import CPU_VARIANTS as FILES

from glint_soc import rtl
from glint_soc.fields import FLAT_FIELDS, NAMES, has_octants
from glint_soc.raymarch import BUILDS
from glint_soc.soc import CPU_VARIANTS


@dataclass(frozen=True)
class Module:
    """A module under test. `variants` has the parameters of further builds by name. `measured` names builds for synthesis only:
    no test in `tools/testbench` simulates them."""

    top: str
    variants: dict = field(default_factory=dict)
    measured: tuple = ()

    @property
    def sources(self):
        """The source files of the module and of all modules and packages that it uses."""
        return rtl.sources(self.top)

    def builds(self):
        """Returns the parameters of every build by the build's name."""
        return {self.top: {}, **self.variants}


@dataclass(frozen=True)
class Core:
    """A variant of the soft core, which is measured alone, as the block `vexriscv_VARIANT`."""

    variant: str
    top = "VexRiscv"

    @property
    def name(self):
        """Name of the block in tables and in the budget."""
        return f"vexriscv_{self.variant}"

    @property
    def sources(self):
        """The source file of the variant."""
        return [Path(pythondata_cpu_vexriscv.data_location) / f"{FILES[self.variant]}.v"]

    def builds(self):
        """Returns the parameters of the only build by its name."""
        return {self.name: {}}


# Video timing of a small picture. A frame takes about 1/200 of the time of a 1280x720 frame, but a memory word lasts for the same
# number of pixel clocks.
_SMALL_RASTER = {"H_ACTIVE": 160, "H_FRONT": 8, "H_SYNC": 4, "H_BACK": 12,
                 "V_ACTIVE": 24, "V_FRONT": 2, "V_SYNC": 2, "V_BACK": 4}
_SMOOTH = {"SMOOTH": 1}
_LINES = {"LINES": 1}
_FIELDS_ALONE = {"TRIANGLES": 0, "FIELDS": 1}
_NO_DEPTHS = _FIELDS_ALONE | {"DEPTHS": 0}
_LINES_ALONE = {"TRIANGLES": 0, "LINES": 1}
_NO_GEOMETRY = {"GEOMETRY": 0}
# Parameters of the module that computes the colours of rays (ray_paint) in a build with every field.
_ALL_PAINT = {"ROUND": 1, "OCTANTS": int(has_octants(NAMES)), "SHADOW": 1}

_SIMULATED = ("skid_buffer", "flash_reader", "binner", "vertex_stage", "vertex_cache", "reciprocal", "texture_sampler", "texture_place",
              "texture_filter", "texture_loader", "group_fog", "band_sky", "colour_window", "line_setup", "line_raster", "exit_reciprocal")
_MEASURED = ("list_reader", "texture_shader", "field_sphere", *(f"field_{flat.name}" for flat in FLAT_FIELDS if flat.marches))

RTL_MODULES = [
    *(Module(top=name) for name in _SIMULATED),
    *(Module(top=name, measured=(name,)) for name in _MEASURED),
    Module(
        top="scanout",
        variants={"scanout_small": _SMALL_RASTER, "scanout_border": _SMALL_RASTER | {"V_FRONT": 5, "V_BACK": 7, "V_BORDER": 3}},
    ),
    Module(top="fifo", variants={"fifo_2": {"DEPTH": 2}, "fifo_block": {"BLOCK": 1}}),
    # In the build i2c_engine_hasty, the time-out for a device that holds SCL low is 2^15 clocks, 0.4 ms.
    Module(top="i2c_engine", variants={"i2c_engine_hasty": {"STRETCH_BITS": 15}}, measured=("i2c_engine",)),
    Module(top="band_buffer",
           variants={"band_buffer_stereo": {"STEREO": 1}, "band_buffer_blend": {"BLEND": 1}, "band_buffer_sky": {"SKY": 1}}),
    Module(top="setup", variants={"setup_smooth": _SMOOTH}),
    Module(top="triangle_raster", variants={"triangle_raster_smooth": _SMOOTH}),
    Module(top="raster_unit", variants={"raster_unit_fields": {"FIELDS": 1}}, measured=("raster_unit", "raster_unit_fields")),
    Module(top="triangle_engine",
           variants={"triangle_engine_smooth": _SMOOTH, "triangle_engine_texture": {"TEXTURE": 1}, "triangle_engine_fields": {"FIELDS": 1},
                     "triangle_engine_texture_fields": {"TEXTURE": 1, "SKY": 1, "FOG": 1, "FIELDS": 1, "AVERAGE": 1},
                     "triangle_engine_fields_alone": _FIELDS_ALONE, "triangle_engine_no_depths": _NO_DEPTHS,
                     "triangle_engine_lines": _LINES, "triangle_engine_lines_alone": _LINES_ALONE | {"DEPTHS": 0},
                     "triangle_engine_no_geometry": _NO_GEOMETRY,
                     "triangle_engine_smooth_lines": _SMOOTH | _LINES | {"FOG": 1, "AVERAGE": 1}},
           measured=("triangle_engine_fields",)),
    Module(top="cdc_fifo", variants={"cdc_fifo_4": {"DEPTH": 4}}),
    # In the build gesture_engine_hasty, the sensor's clock counts as stopped after 2^6 clocks.
    Module(top="gesture_engine",
           variants={"gesture_engine_hasty": {"MOMENTS": 1, "TIMEOUT_BITS": 6}}, measured=("gesture_engine",)),
    Module(top="ray_generator",
           variants={"ray_generator_all": {"MARCH": 1, "ROUND": 1, "LATTICE": 1, "OCTAHEDRON": 1}}),
    Module(top="ray_paint", variants={"ray_paint_shadow": {"SHADOW": 1}, "ray_paint_all": _ALL_PAINT}),
    Module(top="round_light", variants={"round_light_plain": {"NORMALS": 0}, "round_light_all": {"HIGHLIGHT": 1, "BLEND": 1, "CONE": 1}},
           measured=("round_light", "round_light_plain", "round_light_all")),
    Module(top="ring_lane", variants={"ring_lane_all": {"LEVELS": 6}}),
    Module(top="exit_lane",
           variants={"exit_lane_all": {"LEVELS": 6, "ROUND": 1, "LATTICE": 1, "OCTAHEDRON": 1}, "exit_lane_lattice": {"LATTICE": 1},
                     "exit_lane_octahedron": {"OCTAHEDRON": 1}}),
    Module(top="exit_shadow", variants={"exit_shadow_sponge": {"BOXES": 0}}, measured=("exit_shadow", "exit_shadow_sponge")),
    Module(top="exit_landing", variants={"exit_landing_round": {"ROUND": 1}}),
    Module(top="sphere_unit", variants={"sphere_unit_one_eye": {"STEREO": 0}, "sphere_unit_cone": {"CONE": 1}}),
    Module(top="raymarcher",
           variants={f"raymarcher_{name}": fields.parameters() for name, fields in BUILDS.items() if name != "all"},
           measured=("raymarcher_round", "raymarcher_faces")),
    Module(
        top="triangle_control",
        variants={"triangle_control_smooth": _SMOOTH, "triangle_control_32_mb": {"MEMORY_BITS": 21, "SIZES": 3},
                  "triangle_control_fields_alone": {"TRIANGLES": 0}, "triangle_control_lines": _LINES,
                  "triangle_control_lines_alone": _LINES_ALONE, "triangle_control_no_geometry": _NO_GEOMETRY},
    ),
]
"""The RTL modules that have tests, each with its builds."""

CORES = [Core(variant) for variant in CPU_VARIANTS]

MODULES = [*RTL_MODULES, *CORES]
"""All that can be measured as a block."""

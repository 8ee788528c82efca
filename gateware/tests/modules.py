"""The modules under test: their sources and their benches."""

from dataclasses import dataclass, field

from glint_soc import scanout
from glint_soc.i2c import I2C
from glint_soc.raymarch import BUILDS, FIELD_UNIT, RAY_GENERATOR, RAY_PAINT, RAYMARCHER, RING_LANE, ROUND_LIGHT
from glint_soc.triangle import BAND_BUFFER, SETUP, TRIANGLE_CONTROL, TRIANGLE_ENGINE, TRIANGLE_RASTER, VERTEX_STAGE


@dataclass(frozen=True)
class Module:
    """A top module. `variants` are builds with other parameters, `defines` what the bench is told about them.

    A module without a bench is tested from Rust, by `tools/testbench`, in the builds that are not `measured` only.
    """

    top: str
    sources: list
    bench: list = field(default_factory=list)
    variants: dict = field(default_factory=dict)
    defines: list = field(default_factory=list)
    measured: tuple = ()

    def builds(self):
        """The parameters of every build by its name."""
        return {self.top: {}, **self.variants}


# As much time for a memory word as 1280x720 has, in a two-hundredth of its frame.
_SMALL_RASTER = {"H_ACTIVE": 160, "H_FRONT": 8, "H_SYNC": 4, "H_BACK": 12,
                 "V_ACTIVE": 24, "V_FRONT": 2, "V_SYNC": 2, "V_BACK": 4}
_SMOOTH = {"SMOOTH": 1}
# Every field there is.
_ALL_FIELDS = {"LEVELS": 6, "BOXES": 1, "ROUND": 1, "BLEND": 1}
_PREPASS = {"PREPASS": 1}
_COMMON, _TRIANGLE = (scanout.RTL / folder for folder in ("common", "triangle"))

MODULES = [
    Module(
        top="scanout",
        sources=scanout.SOURCES,
        bench=["scanout_test.cpp", "scanout_bench.h"],
        variants={"scanout_small": _SMALL_RASTER},
        defines=["SMALL_RASTER=" + ",".join(str(value) for value in _SMALL_RASTER.values())],
    ),
    Module(top="skid_buffer", sources=[_COMMON / "skid_buffer.sv"]),
    Module(top="fifo", sources=[_COMMON / "fifo.sv"], variants={"fifo_2": {"DEPTH": 2}}),
    # A device that holds SCL for ever is given up in half a millisecond.
    Module(top="i2c_engine", sources=I2C, variants={"i2c_engine_hasty": {"STRETCH_BITS": 15}}, measured=("i2c_engine",)),
    Module(top="band_buffer", sources=BAND_BUFFER, variants={"band_buffer_stereo": {"STEREO": 1}}),
    Module(top="binner", sources=[_TRIANGLE / "triangle_pkg.sv", _TRIANGLE / "list_pkg.sv", _TRIANGLE / "binner.sv"]),
    Module(top="vertex_stage", sources=VERTEX_STAGE),
    Module(top="vertex_cache", sources=[_COMMON / "fifo.sv", _TRIANGLE / "vertex_cache.sv"]),
    Module(top="reciprocal", sources=[_TRIANGLE / "multiply_add.sv", _TRIANGLE / "reciprocal.sv"]),
    Module(top="setup", sources=SETUP, variants={"setup_smooth": _SMOOTH}),
    Module(top="triangle_raster", sources=TRIANGLE_RASTER, variants={"triangle_raster_smooth": _SMOOTH}),
    Module(top="triangle_engine", sources=TRIANGLE_ENGINE, variants={"triangle_engine_smooth": _SMOOTH, "triangle_engine_fields": {"FIELDS": 1}},
           measured=("triangle_engine_fields",)),
    Module(top="field_menger", sources=FIELD_UNIT, measured=("field_menger",)),
    Module(top="field_box", sources=FIELD_UNIT, measured=("field_box",)),
    Module(top="field_sphere", sources=FIELD_UNIT, measured=("field_sphere",)),
    Module(top="ray_generator", sources=RAY_GENERATOR, variants={"ray_generator_all": {"ROUND": 1, **_PREPASS}}, measured=("ray_generator",)),
    Module(top="ray_paint", sources=RAY_PAINT, variants={"ray_paint_round": {"ROUND": 1}}, measured=("ray_paint_round",)),
    Module(top="round_light", sources=ROUND_LIGHT, measured=("round_light",)),
    Module(top="ring_lane", sources=RING_LANE, variants={"ring_lane_all": {**_ALL_FIELDS, **_PREPASS}}),
    Module(top="raymarcher", sources=RAYMARCHER,
           variants={f"raymarcher_{name}": fields.parameters() for name, fields in BUILDS.items() if name != "all"},
           measured=("raymarcher_round", "raymarcher_faces")),
    Module(top="triangle_control", sources=TRIANGLE_CONTROL, variants={"triangle_control_smooth": _SMOOTH}),
]

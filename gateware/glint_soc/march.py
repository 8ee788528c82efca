"""The raymarcher: distance fields, beside the triangles in the band buffer. The work is done by rtl/raymarch."""

from .scanout import RTL

_COMMON, _TRIANGLE, _MARCH = (RTL / folder for folder in ("common", "triangle", "raymarch"))

FIELD_UNIT = [_MARCH / "march_pkg.sv", _COMMON / "delay.sv",
              *(_MARCH / f"{name}.sv" for name in ("menger_level", "field_menger", "field_box", "field_unit"))]
RING_LANE = [*FIELD_UNIT, _COMMON / "fifo.sv", _TRIANGLE / "multiply_add.sv", _MARCH / "ring_lane.sv"]
RAY_GENERATOR = [_MARCH / "march_pkg.sv", _COMMON / "delay.sv", _COMMON / "skid_buffer.sv", _TRIANGLE / "multiply_add.sv",
                 _MARCH / "inverse_table.sv", _MARCH / "ray_generator.sv"]
RAY_PAINT = [_MARCH / "march_pkg.sv", _COMMON / "delay.sv", _COMMON / "skid_buffer.sv", _TRIANGLE / "multiply_add.sv",
             _TRIANGLE / "normalise.sv",
             *(_MARCH / f"{name}.sv" for name in ("inverse_table", "depth_code", "paint_table", "ray_paint"))]
RAYMARCHER = [*dict.fromkeys([RTL / "band" / "band_pkg.sv", *RING_LANE, *RAY_GENERATOR, *RAY_PAINT, _MARCH / "raymarcher.sv"])]

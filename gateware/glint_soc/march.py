"""The raymarcher: distance fields, beside the triangles in the band buffer. The work is done by rtl/raymarch."""

from .scanout import RTL

_COMMON, _TRIANGLE, _MARCH = (RTL / folder for folder in ("common", "triangle", "raymarch"))

FIELD_UNIT = [_MARCH / "march_pkg.sv", _COMMON / "delay.sv", _TRIANGLE / "multiply_add.sv",
              *(_MARCH / f"{name}.sv" for name in ("menger_level", "field_menger", "field_box", "root_table", "field_sphere", "field_unit"))]
RING_LANE = [*FIELD_UNIT, _COMMON / "fifo.sv", _MARCH / "ring_lane.sv"]
RAY_GENERATOR = [_MARCH / "march_pkg.sv", _COMMON / "delay.sv", _COMMON / "skid_buffer.sv", _TRIANGLE / "multiply_add.sv",
                 *(_MARCH / f"{name}.sv" for name in ("inverse_table", "round_inverse", "ray_generator"))]
RAY_PAINT = [_MARCH / "march_pkg.sv", _COMMON / "delay.sv", _COMMON / "skid_buffer.sv", _TRIANGLE / "multiply_add.sv",
             _TRIANGLE / "normalise.sv",
             *(_MARCH / f"{name}.sv" for name in ("inverse_table", "round_inverse", "depth_code", "paint_table", "ray_paint"))]
ROUND_LIGHT = [_MARCH / "march_pkg.sv", _COMMON / "delay.sv", _COMMON / "skid_buffer.sv", _TRIANGLE / "multiply_add.sv",
               _MARCH / "round_light.sv"]
RAYMARCHER = [*dict.fromkeys([*RING_LANE, *RAY_GENERATOR, *ROUND_LIGHT, *RAY_PAINT, _MARCH / "raymarcher.sv"])]

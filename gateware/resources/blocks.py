"""Lists of the blocks that are measured, and the order of their rows in tables."""

from glint_soc.rtl import RTL

SOC = "soc"
"""The whole design in the Urbana's FPGA."""

OWN = ("exit_lane", "setup", "triangle_raster", "band_buffer", "scanout", "vertex_stage", "line_setup", "line_raster", "gesture_engine",
       "i2c_engine", "flash_reader")
"""This project's own blocks, as opposed to LiteX's. The block that takes longest to measure comes first."""

BUILDS = ("triangle_engine_smooth", "triangle_engine_texture", "texture_shader", "raymarcher", "triangle_engine", "raymarcher_sponge",
          "raymarcher_round", "raymarcher_faces", "ring_lane", "ring_lane_all", "exit_lane_all", "ray_generator", "ray_paint",
          "round_light", "group_fog", "band_sky")
"""Builds of engines, which consist of blocks in `OWN`, and parts of them. The tables list them, but their measurement takes too
long for `cargo xtask test`."""

SHOWN = ("soc_core", "triangle_engine", "raymarcher_faces", "ray_generator")
"""Blocks that are placed and routed for the page, in addition to `OWN`: the computer without its engines, the engines of the Urbana's
default build, and a part of the raymarcher. The whole SoC would take an hour."""

FLAT_PARTS = ("vertex_stage", "setup", "triangle_raster")
"""Blocks that together form the smallest triangle engine, with flat shading only."""

FLAT = "flat_build"
"""Name of the row with the sum of `FLAT_PARTS`."""

ROWS = ("scanout", "i2c_engine", "flash_reader", *FLAT_PARTS, FLAT, "line_setup", "line_raster", "gesture_engine", "band_buffer",
        "group_fog", "band_sky", "triangle_engine", "triangle_engine_smooth", "triangle_engine_texture", "texture_shader", "field_menger",
        "field_box", "field_sphere", "exit_lane", "exit_lane_all", "ring_lane", "ring_lane_all", "ray_generator", "round_light",
        "ray_paint", "raymarcher", "raymarcher_round", "raymarcher_faces", "raymarcher_sponge", SOC)
"""The blocks in the order of their rows in the tables. Other measured modules come after them."""

FIELDS = tuple(sorted(path.stem for path in RTL.glob("raymarch/field_*.sv") if path.stem != "field_unit"))
"""The modules that compute the distances of the raymarcher's fields."""

ALL = (SOC, *BUILDS, *OWN, *FIELDS)
"""All blocks, the slowest to measure first."""


def selection(names, default):
    """Returns the blocks to measure, each once: `names`, or `default` if `names` is empty. `FLAT` is replaced by its parts."""
    parts = (part for name in names or default for part in (FLAT_PARTS if name == FLAT else (name,)))
    return list(dict.fromkeys(parts))


def row(block):
    """Returns the number of a block's row in the tables."""
    return ROWS.index(block) if block in ROWS else len(ROWS)

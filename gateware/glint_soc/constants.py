"""Numbers that gateware, firmware and host share.

`gateware/tests/run.py --packages` writes them as the SystemVerilog packages `picture_pkg`, `band_pkg` and `list_pkg`, and
`cargo xtask pac` as `firmware/core/src/machine.rs`. Numbers of a single block are in the description of that block.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Size:
    """A picture size. A band is a number of whole lines with at most `BAND_PIXELS` pixels, and whole bands fill the picture."""

    width: int
    height: int
    band_lines: int

    @property
    def name(self):
        """Name of the size's code in registers."""
        return f"w{self.width}"

    @property
    def text(self):
        """Width and height, as text."""
        return f"{self.width}x{self.height}"

    @property
    def bands(self):
        """Number of bands of a picture."""
        return self.height // self.band_lines

    @property
    def band_groups(self):
        """Number of groups of a band, which is the number of its rows in the band buffer."""
        return self.width // GROUP * self.band_lines


SIZES = (Size(320, 180, 45), Size(640, 360, 24), Size(1280, 720, 12))
"""Picture sizes by code. Each has twice the width and height of the previous one; the last one is the size of the screen."""

GROUP = 8
"""Number of neighbouring pixels of a line in a group, which is one 128-bit word of a frame and one row of the band buffer."""

BAND_PIXELS = 15360
"""Largest number of pixels in a band: those of a bank of the band buffer."""

LIST_TABLE_WORDS = 16
"""Number of 128-bit words before the first band list of a set, which hold the lengths of 64 lists."""

LIST_GAP_WORDS = 128
"""Number of 128-bit words between two band lists: a row of a DDR3 bank, so that neighbouring lists lie in different banks."""

DESCRIPTOR_BYTES = {"flat": 48, "smooth": 96}
"""Size of a triangle's descriptor in bytes, without and with smooth shading."""

CONES = (160, 90)
"""Number of cones of the raymarcher across and down, for one eye at a size above the first. Otherwise half of each number."""

FLASH_BYTES = 16 << 20
"""Bytes of the window of the SPI flash."""

FLASH_FIRMWARE = 3 << 20
"""Offset of the firmware in the SPI flash."""

for _size, _code in zip(SIZES, range(3)):
    if _size.width * _size.band_lines > BAND_PIXELS or _size.height % _size.band_lines or \
            (_size.width, _size.height) != (SIZES[0].width << _code, SIZES[0].height << _code):
        raise ValueError(f"{_size}: expected bands of at most {BAND_PIXELS} pixels and twice the size of code {_code - 1}")


def describe():
    """Returns the numbers as plain data."""
    return {
        "sizes": [
            {"width": size.width, "height": size.height, "band_lines": size.band_lines}
            for size in SIZES
        ],
        "group": GROUP,
        "list_table_words": LIST_TABLE_WORDS,
        "list_gap_words": LIST_GAP_WORDS,
        "flat_descriptor_bytes": DESCRIPTOR_BYTES["flat"],
        "smooth_descriptor_bytes": DESCRIPTOR_BYTES["smooth"],
        "flash_firmware": FLASH_FIRMWARE,
    }


def packages():
    """Returns the texts of the SystemVerilog packages, by folder and name."""
    return {
        ("common", "picture_pkg"): _package("picture_pkg", "Sizes of pictures. Code s is the first size times 2^s.", [
            f"    localparam int unsigned WIDTH  = {SIZES[0].width};",
            f"    localparam int unsigned HEIGHT = {SIZES[0].height};",
            "    // 128-bit words of a frame of the first size, RGB565.",
            f"    localparam int unsigned FRAME_WORDS = {SIZES[0].width * SIZES[0].height // GROUP};",
            "    // Cones across and down, of an eye that looks alone at a size above the first; half of each otherwise.",
            f"    localparam int unsigned CONES_ACROSS = {CONES[0]};",
            f"    localparam int unsigned CONES_DOWN   = {CONES[1]};",
        ]),
        ("band", "band_pkg"): _package(
            "band_pkg", f"Bands of a picture: at most {BAND_PIXELS:,} pixels each, a row of the band buffer for eight of them.", [
                "    // Bands, less one; lines and columns of eight of a band; its rows.",
                "    typedef struct packed {",
                "        logic [5:0]  last_band;",
                "        logic [5:0]  lines;",
                "        logic [7:0]  stride;",
                "        logic [10:0] rows;",
                "    } cut_t;",
                "",
                f"    // By size: {', '.join(size.text for size in SIZES)}.",
                "    function automatic cut_t cut(input logic [1:0] size);",
                *_case(lambda size: f"cut = {{6'd{size.bands - 1}, 6'd{size.band_lines}, 8'd{size.width // GROUP}, "
                                    f"11'd{size.band_groups}}};"),
                "    endfunction",
                "",
                "    // Bands of a picture.",
                "    function automatic logic [5:0] bands(input logic [1:0] size);",
                *_case(lambda size: f"bands = 6'd{size.bands};"),
                "    endfunction",
            ]),
        ("triangle", "list_pkg"): _package(
            "list_pkg",
            "Places of the band lists in memory, in words of 16 bytes (docs/formats/triangle.md): behind the table of their lengths, and apart by\n"
            "their length and a row of a memory bank, so that the lists of eight bands lie in eight banks, which stay open. LiteDRAM\n"
            "puts BANK_WORDS neighbours into a row of a bank, and the next ones into the next bank.", [
                f"    localparam int unsigned TABLE_WORDS = {LIST_TABLE_WORDS};",
                f"    localparam int unsigned BANK_WORDS  = {LIST_GAP_WORDS};",
            ]),
    }


def _case(line):
    labels = [f"2'd{code}" for code in range(len(SIZES) - 1)] + ["default"]
    arms = [f"            {label + ':':<8} {line(size)}" for label, size in zip(labels, SIZES)]
    return ["        case (size)", *arms, "        endcase"]


def _package(name, text, lines):
    head = ["// Generated by `gateware/tests/run.py --packages` from glint_soc/constants.py. Do not edit.", "//",
            *(f"// {line}" for line in text.splitlines())]
    # Verilator would warn about parameters that a module does not use, and each module uses only some.
    off, on = ("    /* verilator lint_" + switch + " UNUSEDPARAM */" for switch in ("off", "on"))
    return "\n".join([*head, "", "`default_nettype none", "", f"package {name};", off, *lines, on, "endpackage", "",
                      "`default_nettype wire", ""])

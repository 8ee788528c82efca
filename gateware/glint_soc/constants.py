"""Numbers that gateware, firmware and host share.

`cargo xtask pac` writes them as the SystemVerilog packages `picture_pkg`, `band_pkg` and `list_pkg`, and
as `firmware/core/src/gateware/constants.rs`. Numbers of a single block are in the description of that block.
"""

from dataclasses import dataclass

from .packed import generated, number, package
from .rtl import CORE, RTL


@dataclass(frozen=True)
class Size:
    """A picture size. A band consists of whole lines, with at most `BAND_PIXELS` pixels in total; a picture consists of whole bands."""

    width: int
    height: int
    band_lines: int

    @property
    def name(self):
        """Name of this size as a value of a register field."""
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
"""Picture sizes by code. Each size has twice the width and height of the previous size. The last size is that of the screen."""

GROUP = 8
"""Number of neighbouring pixels of a line in a group, which is one 128-bit word of a frame and one row of the band buffer."""

BAND_PIXELS = 15360
"""Largest number of pixels in a band: the capacity of a bank of the band buffer."""

LISTS = 64
"""Number of band lists, at least the number of bands of every picture."""

LIST_TABLE_WORDS = LISTS // 4
"""Number of 128-bit words before the first band list of a set: the table of list lengths."""

LIST_GAP_WORDS = 128
"""Number of 128-bit words between two band lists: a row of a DDR3 bank, so that neighbouring lists lie in different banks."""

FLASH_BYTES = 16 << 20
"""Size in bytes of the address window of the SPI flash."""

FLASH_FIRMWARE = 3 << 20
"""Offset of the firmware in the SPI flash."""

for _size, _code in zip(SIZES, range(3)):
    if _size.width * _size.band_lines > BAND_PIXELS or _size.height % _size.band_lines or \
            (_size.width, _size.height) != (SIZES[0].width << _code, SIZES[0].height << _code):
        raise ValueError(f"{_size}: expected bands of at most {BAND_PIXELS} pixels and twice the size of code {_code - 1}")
    if _size.bands > LISTS or _code and _size.band_lines not in (3 << n for n in range(6)):
        raise ValueError(f"{_size}: expected at most {LISTS} bands, and 3·2^n lines of a band except at the first size")


def files():
    """Returns the texts of the generated files by path: the packages `picture_pkg`, `band_pkg` and `list_pkg`, and the module
    `constants` of glint-core."""
    texts = {
        ("common", "picture_pkg"): ("Sizes of pictures. Code s is the first size times 2^s.", [
            "\n".join([number("WIDTH", SIZES[0].width), number("HEIGHT", SIZES[0].height)]),
            number("FRAME_WORDS", SIZES[0].width * SIZES[0].height // GROUP,
                   "Number of 128-bit words of an RGB565 frame of the first size."),
        ]),
        ("band", "band_pkg"): (
            f"Bands of a picture. A band has at most {BAND_PIXELS:,} pixels; a row of the band buffer holds eight pixels.", [
            "    // Number of the last band; numbers of a band's lines, of groups of eight pixels in a line, and of rows in the band buffer.\n"
            "    typedef struct packed {\n"
            "        logic [5:0]  last_band;\n"
            "        logic [5:0]  lines;\n"
            "        logic [7:0]  stride;\n"
            "        logic [10:0] rows;\n"
            "    } cut_t;",
            _by_size("cut", "cut_t", f"Division of a picture into bands, for the sizes {', '.join(size.text for size in SIZES)}.", lambda size: (
                f"{{6'd{size.bands - 1}, 6'd{size.band_lines}, 8'd{size.width // GROUP}, 11'd{size.band_groups}}}")),
            _by_size("lines", "int unsigned", "Number of lines of a band.", lambda size: size.band_lines),
            _by_size("bands", "logic [5:0]", "Number of bands of a picture.", lambda size: f"6'd{size.bands}"),
        ]),
        ("triangle", "list_pkg"): (
            "Positions of the band lists in memory, in words of 16 bytes (docs/formats/triangle.md). The lists follow the table of their "
            "lengths. The distance between the starts of two lists is the maximum length of a list plus a row of a memory bank, so that the "
            "lists of eight bands lie in eight banks, whose rows stay open. LiteDRAM maps BANK_WORDS consecutive words to a row of a bank, and "
            "the following words to the next bank.",
            ["\n".join([number("TABLE_WORDS", LIST_TABLE_WORDS), number("BANK_WORDS", LIST_GAP_WORDS)])]),
    }
    return {
        **{RTL / folder / f"{name}.sv": package(name, "constants.py", *text) for (folder, name), text in texts.items()},
        CORE / "constants.rs": _constants(),
    }


def _by_size(name, kind, text, value):
    labels = [f"2'd{code}" for code in range(len(SIZES) - 1)] + ["default"]
    return "\n".join([
        f"    // {text}",
        f"    function automatic {kind} {name}(input logic [1:0] size);",
        "        case (size)",
        *(f"            {label + ':':<8} {name} = {value(size)};" for label, size in zip(labels, SIZES)),
        "        endcase",
        "    endfunction",
    ])


def _constants():
    sizes = "\n".join(f"    Picture {{ width: {size.width}, height: {size.height}, band_lines: {size.band_lines} }},"
                      for size in SIZES)
    numbers = {
        "GROUP": (GROUP, "Number of neighbouring pixels of a line in a 128-bit word, which is a row of the band buffer."),
        "LISTS": (LISTS, "Number of band lists of a set."),
        "LIST_TABLE_WORDS": (LIST_TABLE_WORDS, "Number of 128-bit words before the first band list of a set: the table of the lists' lengths."),
        "LIST_GAP_WORDS": (LIST_GAP_WORDS, "Number of 128-bit words between two band lists."),
        "FLASH_FIRMWARE": (hex(FLASH_FIRMWARE), "Offset of the firmware in the SPI flash."),
    }
    constants = "".join(f"\n/// {text}\npub const {name}: u32 = {value};\n" for name, (value, text) in numbers.items())
    return f"""//! Numbers that gateware, firmware and host share.
{generated("//", "constants.py")}

/// A picture size of the gateware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picture {{
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Number of lines of a band.
    pub band_lines: u32,
}}

/// The picture sizes by their code in registers. The last size is the size of the screen.
pub const PICTURES: [Picture; {len(SIZES)}] = [
{sizes}
];
{constants}"""

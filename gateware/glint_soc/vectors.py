"""Vectors for simulations: accesses to registers and memory with the expected results, one a line.

    memory OFFSET               place of the following words
    words WORD ...              words of 32 bits
    fill OFFSET COUNT           words of a fixed pattern
    write REGISTER VALUE ...    writes of a register
    address REGISTER OFFSET     write of an address in memory
    copy FROM TO                write of a register's value to another one
    wait REGISTER MASK          until these bits are 0
    expect REGISTER MASK VALUE  comparison of these bits
    picture OFFSET WIDTH HEIGHT place of a picture, RGB565
    runs COUNT*COLOUR ...       the picture's pixels
    shown OFFSET WIDTH HEIGHT   comparison of the next shown frame with a picture in memory

Counts, widths and heights are decimal numbers, all others hexadecimal. Registers are named as in LiteX's exports, or by the name of the
block and the offset in its window, such as `raymarch+4`.
"""

from pathlib import Path

from .constants import SIZES

CUBE = Path(__file__).resolve().parent / "vectors" / "cube.txt"
"""A cube for the triangle engine, with its picture by the model. A test of `tools/testbench` generates it."""

SPONGE = CUBE.with_name("sponge.txt")
"""A sponge for the raymarcher's build `faces`, with its picture by the model. A test of `firmware/engines` generates it."""

_OFFSETS = {"memory": 1, "fill": 1, "address": 2, "picture": 1, "shown": 1}
"""For each command, the number of its argument that is an offset in memory."""

_REGISTERS = {"write": (1,), "address": (1,), "copy": (1, 2), "wait": (1,), "expect": (1,)}
"""For each command, the numbers of its arguments that are registers."""


def registers(soc):
    """Returns the addresses of the registers and of the windows of a finalized SoC by name."""
    places = {}
    for name, region in soc.csr_regions.items():
        place = places[name] = region.origin
        for register in region.obj if isinstance(region.obj, list) else ():
            places[f"{name}_{register.name}"] = place
            place += 4 * -(-register.size // region.busword)
    return places


def resolved(text, places, origin):
    """Returns the lines of vectors with addresses in place of registers and offsets, for a memory at `origin`."""
    lines = []
    for line in text.splitlines():
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        for argument in _REGISTERS.get(words[0], ()):
            name, _, offset = words[argument].partition("+")
            words[argument] = f"{places[name] + int(offset or '0', 16):x}"
        if argument := _OFFSETS.get(words[0]):
            words[argument] = f"{int(words[argument], 16) + origin:x}"
        if words[0] == "address":
            words[0] = "write"
        lines.append(" ".join(words))
    return lines


def shown_frame(mode, is_drawn):
    """Returns vectors that show a picture by the scan-out in the video mode `mode`: the picture of `CUBE` if it is drawn, otherwise a
    pattern."""
    offset, size = (0, SIZES[0]) if is_drawn else (0x10_0000, SIZES[-1 if mode.width == SIZES[-1].width else 0])
    return "\n".join([
        *([] if is_drawn else [f"fill {offset:x} {size.width * size.height // 2}"]),
        f"address scanout_fb_next {offset:x}",
        f"write scanout_scale {mode.width // size.width:x}",
        "write scanout_control 1",
        f"shown {offset:x} {size.width} {size.height}",
        "expect scanout_underflow_count ffffffff 0",
        "expect scanout_status 301 1",
    ])

"""Addresses of all peripherals, and the build id computed from them.

Addresses and interrupt numbers are pinned here, so they are the same in every build. The window of a block that
a build omits reads as 0, and no other address changes.
"""

import json
import zlib
from dataclasses import dataclass

from litex.soc.interconnect.csr import CSRStatus

from .packed import generated
from .rtl import CORE


@dataclass(frozen=True)
class Location:
    """Location of a peripheral: number of its window of `CSR_PAGING` bytes, and number of its interrupt if it has one."""

    window: int
    irq: int | None = None


CSR_PAGING = 0x800

PINNED = {
    "ctrl": Location(0),
    "identity": Location(1),
    "uart": Location(2, irq=0),
    "timer0": Location(3, irq=1),
    "sdram": Location(4),
    "i2c": Location(5, irq=6),
    "buttons": Location(6, irq=2),
    "switches": Location(7),
    "leds": Location(8),
    "scanout": Location(9, irq=3),
    "triangle": Location(10, irq=4),
    "raymarch": Location(11, irq=5),
    "gesture": Location(12, irq=7),
    "digits": Location(13),
    # The physical layers differ between boards, so the build id does not cover their registers.
    "ddrphy": Location(30),
    "uart_phy": Location(31),
}

BOARD_SPECIFIC = ("ddrphy", "uart_phy")

# Registers that depend on the type of memory. Only the BIOS uses them, which is built with the gateware.
MEMORY_SPECIFIC = ("sdram",)

# The optional blocks in the order of their bits in the register `identity_blocks`, each with its text.
BLOCKS = {
    "scanout": "The scan-out.",
    "triangle": "The triangle engine.",
    "raymarch": "The raymarcher.",
    "line": "The line engine, a part of the triangle engine.",
    "gesture": "The gesture engine.",
    "flash": "The SPI flash, readable in a memory window.",
    "i2c": "The I2C master, for the motion sensor.",
    "digits": "The seven-segment displays.",
}

OPTIONAL_BLOCKS = {name: bit for bit, name in enumerate(BLOCKS)}

CSR_MAP = {name: location.window for name, location in PINNED.items()}


def access(csr):
    """Returns whether software may write a register, `rw`, or not, `ro`. LiteX has no write-only registers."""
    return "ro" if isinstance(csr, CSRStatus) and not hasattr(csr, "r") else "rw"


def registers(soc):
    """Returns the register map of a finalized SoC without its board-specific parts, as plain data in address order."""
    regions = {}
    for name, region in soc.csr.regions.items():
        if name in BOARD_SPECIFIC:
            continue
        if name not in PINNED:
            raise ValueError(f"CSR region {name!r} has no pinned address: add it to PINNED in {__name__}")
        offset = 0
        rows = []
        for csr in region.obj:
            fields = [[f.name, f.offset, f.size] for f in getattr(csr, "fields", None).fields] \
                if getattr(csr, "fields", None) else []
            rows.append([offset, csr.name, csr.size, access(csr), fields])
            offset += 4 * -(-csr.size // region.busword)
        regions[name] = {"origin": region.origin, "irq": soc.irq.locs.get(name), "registers": rows}
    return regions


def build_id(soc):
    """Returns the CRC-32 of the register map of `soc`, which must be the build with all blocks."""
    canonical = json.dumps(registers(soc), sort_keys=True, separators=(",", ":"))
    return zlib.crc32(canonical.encode())


def check_subset(soc, full):
    """Fails if a register of `soc` does not have the same address in the full build."""
    expected = registers(full)
    for name, region in registers(soc).items():
        if name not in MEMORY_SPECIFIC and region != expected.get(name):
            raise ValueError(
                f"registers of {name!r} differ from the full build: expected {expected.get(name)}, got {region}")


def files():
    """Returns the text of the generated module `block` of glint-core, by path."""
    variants = "\n".join(f"    /// {text}\n    {name.title()} = {bit}," for bit, (name, text) in enumerate(BLOCKS.items()))
    names = "\n".join(f'    {name.title()}: "{name}",' for name in BLOCKS)
    return {CORE / "block.rs": f"""//! The optional blocks of a gateware.
{generated("//", "register_map.py")}

use crate::choice::choices;

/// An optional block. The discriminant is the number of its bit among the block enable bits (`identity.blocks`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Block {{
{variants}
}}

choices!(Block {{
{names}
}});

impl Block {{
    /// Returns the block's bit among the block enable bits, as a mask.
    pub const fn bit(self) -> u32 {{
        1 << self as u32
    }}

    /// Yields the blocks whose bits are set in `bits`.
    pub fn of_bits(bits: u32) -> impl Iterator<Item = Self> {{
        let all = Self::ALL.into_iter();
        all.filter(move |block| block.bit() & bits != 0)
    }}
}}
"""}

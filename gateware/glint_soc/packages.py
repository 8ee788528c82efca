"""Files generated from the shared constants and records, and from the blocks' descriptions."""

from . import constants, fields, records, register_map
from .register_map import OPTIONAL_BLOCKS, PINNED
from .rtl import RTL
from .virtual import VirtualSoC

WRITER = ".venv/bin/python gateware/tests/run.py --packages"
"""Shell command that writes the files."""


def full_soc():
    """Returns the SoC with all blocks, not finalized."""
    return VirtualSoC(0, OPTIONAL_BLOCKS)


def stale(soc):
    """Returns the new texts of the generated files that are not up to date with the full SoC `soc`, by path."""
    blocks = [getattr(soc, name) for name in PINNED if hasattr(soc, name)]
    packages = [block.package for block in blocks if hasattr(block, "package")]
    texts = {
        **{RTL / package.block / f"{package.name}.sv": package.text() for package in packages},
        **constants.files(),
        **fields.files(),
        **records.files(),
        **register_map.files(),
    }
    return {path: text for path, text in texts.items() if not path.exists() or path.read_text() != text}


def write(soc):
    """Writes the generated files that are not up to date with the full SoC `soc`, and returns their paths."""
    texts = stale(soc)
    for path, text in texts.items():
        path.write_text(text)
    return list(texts)

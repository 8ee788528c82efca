"""Writes the files that are generated from the descriptions of blocks, records and shared constants: `python -m glint_soc.packages`."""

import argparse
import logging
import sys

from migen import Constant

from . import constants, fields, pac, records, register_map
from .register_map import OPTIONAL_BLOCKS, PINNED
from .rtl import RTL
from .virtual import VirtualSoC

WRITER = "cargo xtask pac"
"""Shell command that writes the files."""


def full_soc():
    """Returns the finalized SoC with all blocks."""
    soc = VirtualSoC(0, OPTIONAL_BLOCKS)
    soc.finalize()
    # The build id needs the addresses of the registers, which LiteX assigns in `finalize`.
    soc.identity.build_id.status.reset = Constant(register_map.build_id(soc))
    return soc


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
        **pac.files(soc),
    }
    return {path: text for path, text in texts.items() if not path.exists() or path.read_text() != text}


def main():
    """Parses the command line, and writes the files that are not up to date."""
    parser = argparse.ArgumentParser(prog="python -m glint_soc.packages", description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing; fail if a file is not up to date")
    check = parser.parse_args().check
    logging.disable(logging.INFO) # LiteX logs each step
    texts = stale(full_soc())
    for path, text in texts.items():
        if not check:
            path.write_text(text)
        print(f"{path} is out of date: `{WRITER}` writes it" if check else path)
    return 1 if check and texts else 0


if __name__ == "__main__":
    sys.exit(main())

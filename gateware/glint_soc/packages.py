"""Writes the SystemVerilog packages that follow from the shared constants and the blocks' descriptions: `python -m glint_soc.packages [--check]`."""

import argparse
import logging
import sys

from . import constants
from .register_map import OPTIONAL_BLOCKS, PINNED
from .rtl import RTL
from .virtual import VirtualSoC


def packages(soc):
    """Returns the text of each generated file of a full build."""
    blocks = [getattr(soc, name) for name in PINNED if hasattr(soc, name)]
    found = [block.package for block in blocks if hasattr(block, "package")]
    shared = {RTL / folder / f"{name}.sv": text for (folder, name), text in constants.packages().items()}
    return shared | {RTL / package.block / f"{package.name}.sv": package.text() for package in found}


def stale(soc):
    """Returns the generated files that differ from the descriptions."""
    return [path for path, text in packages(soc).items() if not path.exists() or path.read_text() != text]


def full_soc():
    """The SoC with all blocks, not finalized."""
    return VirtualSoC(0, OPTIONAL_BLOCKS)


def main():
    """Writes or checks."""
    parser = argparse.ArgumentParser(prog="python -m glint_soc.packages", description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing, and fail where a file differs")
    arguments = parser.parse_args()
    logging.disable(logging.INFO)
    soc = full_soc()
    texts = packages(soc)
    for path in stale(soc):
        print(path.relative_to(RTL.parent.parent))
        if not arguments.check:
            path.write_text(texts[path])
    if arguments.check and stale(soc):
        sys.exit(f"out of date: `{parser.prog}` writes them")


if __name__ == "__main__":
    main()

"""Writes the gateware of one board: `python -m glint_soc --board virtual --output DIR`."""

import argparse
import logging
import os
import sys
from pathlib import Path

from litex.soc.integration.builder import Builder

from . import packages, register_map
from .raymarch import build
from .register_map import OPTIONAL_BLOCKS
from .soc import CPU_VARIANT, CPU_VARIANTS


def make_soc(board, build_id, blocks=None, **options):
    """Returns the SoC of `board`, not yet finalized, with `blocks` or the board's default blocks."""
    if board == "virtual":
        from .virtual import VirtualSoC as BoardSoC
    elif board == "urbana":
        from .urbana import UrbanaSoC as BoardSoC
    else:
        from .ulx3s import Ulx3sSoC as BoardSoC
    return BoardSoC(build_id, BoardSoC.default_blocks if blocks is None else blocks, **options)


def main():
    """Parses the command line and builds the gateware."""
    parser = argparse.ArgumentParser(prog="python -m glint_soc", description=__doc__)
    parser.add_argument("--board", choices=["virtual", "urbana", "ulx3s"], required=True)
    parser.add_argument("--output", type=Path, required=True, help="directory to write to")
    parser.add_argument("--blocks", nargs="*", choices=sorted(OPTIONAL_BLOCKS),
                        help="optional blocks of this build (default: all; for the ulx3s: all but flash, digits and raymarch)")
    parser.add_argument("--smooth", action="store_true", help="build smooth shading into the triangle engine")
    parser.add_argument("--texture", action="store_true", help="build textures into the triangle engine")
    parser.add_argument("--no-sky", dest="sky", action="store_false", help="omit the sky behind triangles")
    parser.add_argument("--fog", action="store_true", help="build fog into the triangle engine")
    parser.add_argument("--no-antialiasing", dest="antialiasing", action="store_false", help="omit pictures with four samples a pixel")
    parser.add_argument("--no-geometry", dest="geometry", action="store_false",
                        help="omit the geometry pass of the triangle engine: the CPU makes the descriptors of meshes")
    parser.add_argument("--no-depths", dest="depths", action="store_false",
                        help="omit the depth buffer, which a build without `triangle` does not need for pictures")
    parser.add_argument("--fields", help="build of the raymarcher, or a list of its features (`raymarch.build`; default: all; "
                                         "for the urbana and the ulx3s: faces)")
    parser.add_argument("--lanes", type=int, choices=[1, 2, 4], help="lanes of the raymarcher (default: those of its build)")
    parser.add_argument("--cpu", choices=CPU_VARIANTS, default=CPU_VARIANT,
                        help="variant of VexRiscv, of those with the firmware's instructions, rv32im (default: %(default)s)")
    parser.add_argument("--clock", type=float, metavar="MHZ",
                        help="frequency of the system clock, a multiple of 0.25 (default: the board's)")
    arguments = parser.parse_args()
    logging.getLogger().setLevel(logging.WARNING)
    # The build of the BIOS calls meson and ninja, which are in the virtual environment that runs this program.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])

    # LiteX runs git to find LiteX's own version. Without this limit, git would find the repository of this project instead.
    os.environ["GIT_CEILING_DIRECTORIES"] = sys.prefix

    full = packages.full_soc()
    build_id = register_map.build_id(full)
    for path in packages.stale(full):
        parser.error(f"{path} differs from the descriptions: `{packages.WRITER}` writes it")

    try:
        fields = build(arguments.fields or ("all" if arguments.board == "virtual" else "faces"), arguments.lanes)
    except ValueError as error:
        parser.error(error)
    options = {name: getattr(arguments, name) for name in (
        "smooth", "texture", "sky", "fog", "antialiasing", "geometry", "depths", "cpu")} | {"fields": fields}
    if arguments.clock:
        options["sys_clk_freq"] = arguments.clock * 1e6
    soc = make_soc(arguments.board, build_id, arguments.blocks, **options)
    soc.finalize()
    register_map.check_subset(soc, full)
    output = arguments.output.resolve()
    builder = Builder(
        soc, output_dir=str(output), gateware_dir=str(output / "gateware"), software_dir=str(output / "software"),
        # Link-time optimisation inlines the calls in the serial boot loop of the BIOS, so that the loop fits the instruction cache.
        bios_lto=True,
        # Without its command history the BIOS fits into six block RAMs.
        bios_console="no-history",
        # The FPGA tools run separately: through `gateware/ecp5`, or by hand on a computer with the vendor's tools.
        compile_gateware=False)
    builder.build()
    # This file contains the build time, so it would differ between builds of equal SoCs.
    (output / "csr.csv").unlink()


if __name__ == "__main__":
    main()

"""Command line of the virtual board's build."""

import argparse
import sys
from pathlib import Path

from . import __doc__ as description
from . import board
from .programs import ToolError

parser = argparse.ArgumentParser(prog="verilate", description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("folder", type=Path, help="the folder of a virtual board's Verilog and BIOS")
kind = parser.add_mutually_exclusive_group()
kind.add_argument("--waveforms", dest="kind", action="store_const", const=board.WAVEFORMS, default=board.PROFILED,
                  help="build the slower library that writes waveforms")
kind.add_argument("--quick", dest="kind", action="store_const", const=board.QUICK,
                  help="compile once, without a profile: a shorter build, a slower library")
arguments = parser.parse_args()
try:
    board.build(arguments.folder.resolve(), arguments.kind)
except ToolError as error:
    sys.exit(str(error))

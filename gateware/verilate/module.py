"""Build of a single module as a shared library for `glint_testbench::Module`."""

import shutil
from pathlib import Path

from . import compiler
from .programs import GATEWARE, digest, is_current, run

MODELS = GATEWARE.parent / "target" / "gateware" / "models"

_OPTIMISE = "-O2"

# Registers start with random values, and each `x` becomes a random value: tests then detect reads of values that were never written.
_VERILATE = ["--x-initial", "unique", "--x-assign", "unique"]


def build(top, sources, name, parameters, warnings=("-Wall",)):
    """Builds the module `top` with the given parameters as `target/gateware/models/NAME.so`, unless it is up to date. `warnings` are
    Verilator's options for warnings, which are errors."""
    library, folder = MODELS / f"{name}.so", MODELS / name
    stamp = folder / "inputs"
    inputs = digest([*sources, *compiler.RECIPE, Path(__file__)], top, name, parameters)
    if is_current(stamp, inputs, library):
        return
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    compiler.verilate(top, sources, parameters, folder, [*warnings, *_VERILATE])
    options = [*compiler.flags(folder), _OPTIMISE]
    # All files are compiled as one file, because each of them alone would take as long as all together.
    parts = [*sorted(folder.glob("Vmodel*.cpp")), compiler.HARNESS / "module.cpp"]
    whole = folder / "whole.cpp"
    whole.write_text("".join(f'#include "{path}"\n' for path in parts))
    run([compiler.COMPILER, *options, "-c", whole, "-o", folder / "whole.o"])
    runtime = compiler.runtime(MODELS / "runtime", ["-std=gnu++20", "-fPIC", "-fvisibility=hidden", "-pthread", "-w", _OPTIMISE])
    compiler.link([folder / "whole.o", *runtime], folder / "built.so", library)
    stamp.write_text(inputs)

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
    objects, shared = compiler.runtime()
    hot, slow = compiler.model_sources(folder)
    whole = compiler.write_whole([*hot, *slow, compiler.HARNESS / "module.cpp"], folder / "whole.cpp")
    run([compiler.COMPILER, *compiler.flags(folder), *shared, _OPTIMISE, "-c", whole, "-o", folder / "whole.o"])
    compiler.link([folder / "whole.o", *objects], folder / "built.so", library)
    stamp.write_text(inputs)

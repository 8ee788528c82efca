"""Builds a module as a shared library that the tests in `tools/testbench` clock from Rust.

`target/gateware/models/NAME.so` is the verilated module and `tools/testbench/harness/module.cpp` around it.
"""

import json
import shutil

from description import describe
from tools import BUILD, GATEWARE, TESTS, VERILATOR_ROOT, digest, run, run_verilator

MODELS = BUILD.parent / "models"
_HARNESS = GATEWARE.parent / "tools" / "testbench" / "harness" / "module.cpp"

_COMPILE = ["g++", "-std=c++20", "-O2", "-fPIC", "-shared", "-w", "-pthread", "-fvisibility=default",
            f"-I{VERILATOR_ROOT}/include", f"-I{VERILATOR_ROOT}/include/vltstd"]

# Registers start with noise, and `x` is noise, so that nothing rests on a zero that nobody wrote.
_VERILATE = ["--cc", "-O3", "-Wall", "--x-initial", "unique", "--x-assign", "unique", "--prefix", "Vmodel"]


def build(module, name, parameters):
    """Builds the library of a variant of a module, where it is not up to date."""
    library, folder = MODELS / f"{name}.so", MODELS / name
    stamp = folder / "inputs"
    inputs = digest([*module.sources, _HARNESS, TESTS / "description.py", VERILATOR_ROOT / "bin" / "verilator_bin"],
                    _COMPILE, _VERILATE, parameters)
    if library.exists() and stamp.exists() and stamp.read_text() == inputs:
        return
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run_verilator(*_VERILATE, "--top-module", module.top, "-Mdir", folder,
                  *(f"-G{key}={value}" for key, value in parameters.items()), *module.sources)
    description = describe(module.top, parameters, module.sources, folder)
    (folder / "ports.inc").write_text("".join(f"PORT({port['name']})\n" for port in description["ports"]))
    # The longest string literal that compilers have to take is longer than any line of it.
    text = "".join(json.dumps(line) + "\n" for line in json.dumps(description, indent=0).splitlines())
    (folder / "description.inc").write_text(text)
    runtime = [VERILATOR_ROOT / "include" / f"{part}.cpp" for part in ("verilated", "verilated_threads")]
    # In one piece: each of the files alone costs as much as all of them.
    whole = folder / "whole.cpp"
    whole.write_text("".join(f'#include "{path}"\n' for path in [*sorted(folder.glob("Vmodel*.cpp")), *runtime, _HARNESS]))
    built = folder / "built.so"
    run([*_COMPILE, f"-I{folder}", "-DMODEL=Vmodel", '-DMODEL_HEADER="Vmodel.h"', whole, "-o", built])
    # A test that is running keeps the library it has opened.
    built.rename(library)
    stamp.write_text(inputs)

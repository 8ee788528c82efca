"""Builds a module as a shared library that the tests in `tools/testbench` clock from Rust.

`target/gateware/models/NAME.so` is the verilated module and `tools/testbench/harness/module.cpp` around it.
"""

import re
import shutil

from tools import BUILD, GATEWARE, VERILATOR_ROOT, digest, run, run_verilator

MODELS = BUILD.parent / "models"
_HARNESS = GATEWARE.parent / "tools" / "testbench" / "harness" / "module.cpp"

_COMPILE = ["g++", "-std=c++20", "-O2", "-fPIC", "-shared", "-w", "-pthread", "-fvisibility=default",
            f"-I{VERILATOR_ROOT}/include", f"-I{VERILATOR_ROOT}/include/vltstd"]

# Registers start with noise, and `x` is noise, so that nothing rests on a zero that nobody wrote.
_VERILATE = ["--cc", "-O3", "-Wall", "--x-initial", "unique", "--x-assign", "unique", "--prefix", "Vmodel"]

_PORT = re.compile(r"VL_(IN|OUT)(?:8|16|64|W)?\(&(\w+),(\d+),0[,)]")


def build(module, name, parameters):
    """Builds the library of a variant of a module, where it is not up to date."""
    library, folder = MODELS / f"{name}.so", MODELS / name
    stamp = folder / "inputs"
    inputs = digest([*module.sources, _HARNESS, VERILATOR_ROOT / "bin" / "verilator_bin"],
                    _COMPILE, _VERILATE, parameters)
    if library.exists() and stamp.exists() and stamp.read_text() == inputs:
        return
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run_verilator(*_VERILATE, "--top-module", module.top, "-Mdir", folder,
                  *(f"-G{key}={value}" for key, value in parameters.items()), *module.sources)
    ports = _PORT.findall((folder / "Vmodel.h").read_text())
    (folder / "ports.inc").write_text("".join(
        f"PORT({port}, {int(high) + 1}, {int(direction == 'OUT')})\n" for direction, port, high in ports if port != "clk"))
    runtime = [VERILATOR_ROOT / "include" / f"{part}.cpp" for part in ("verilated", "verilated_threads")]
    # In one piece: each of the files alone costs as much as all of them.
    whole = folder / "whole.cpp"
    whole.write_text("".join(f'#include "{path}"\n' for path in [*sorted(folder.glob("Vmodel*.cpp")), *runtime, _HARNESS]))
    built = folder / "built.so"
    run([*_COMPILE, f"-I{folder}", "-DMODEL=Vmodel", '-DMODEL_HEADER="Vmodel.h"', whole, "-o", built])
    # A test that is running keeps the library it has opened.
    built.rename(library)
    stamp.write_text(inputs)

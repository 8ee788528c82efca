"""Builds the SoC of the virtual board as a shared library, which the crate `virtual-board` loads.

For speed the model is compiled twice: the first build counts how often the BIOS takes each branch; the second build, optimised with
these counts, needs a tenth less time per cycle. A library for a few frames is compiled only once.
"""

import shutil
from pathlib import Path

from . import compiler
from .programs import GATEWARE, digest, files_below, is_current, run

TOP = "glint_virtual"

PROFILED, QUICK, WAVEFORMS = "profiled", "quick", "waveforms"
"""Kinds of the library: compiled for speed, compiled once with little optimisation, and able to write waveforms."""

_SOC = GATEWARE.parent / "tools" / "virtual-board" / "soc"
_VERILATE = ["--no-timing", "--flatten", "--public-ignore", "--x-assign", "fast", "--x-initial", "fast", _SOC / "soc.vlt"]


def build(folder, kind=PROFILED):
    """Builds a library of the given kind from LiteX's Verilog in `folder`, unless the library is up to date: `libglint_soc.so`, or
    `libglint_soc_trace.so` that can write waveforms."""
    waveforms = kind == WAVEFORMS
    objects = folder / ("verilated-trace" if waveforms else "verilated")
    library = folder / ("libglint_soc_trace.so" if waveforms else "libglint_soc.so")
    verilog = folder / "gateware" / f"{TOP}.v"
    bios = folder / "software" / "bios" / "bios.bin"
    sources = [verilog, "-f", verilog.with_suffix(".f")]

    runtime, shared = compiler.runtime(waveforms)
    options = [*compiler.flags(objects, waveforms), *shared, "-O1" if kind == QUICK else "-O3"]
    harness_options = [*options, f'-DGLINT_BIOS="{bios}"', f"-I{folder / 'software' / 'include'}", f"-I{_SOC}"]

    # First step: the model in C++ and its objects, which take most of the build's time.
    inputs = digest([verilog, *files_below(GATEWARE / "rtl", _SOC), *compiler.RECIPE, Path(__file__)], kind)
    stamp = objects / "model.stamp"
    if not is_current(stamp, inputs):
        # Verilator derives the names of its output files from their content, so the files of an older build are deleted.
        shutil.rmtree(objects, ignore_errors=True)
        objects.mkdir(parents=True)
        print("Verilator", flush=True)
        trace = ["--trace-vcd"] if waveforms else []
        compiler.verilate(TOP, sources, {}, objects, [*_VERILATE, *trace])
        _compile_model(objects, options, harness_options, runtime, kind)
        stamp.write_text(inputs)

    # Second step: the harness around the model, and the library.
    inputs = digest([bios], inputs)
    stamp = objects / "library.stamp"
    if is_current(stamp, inputs, library):
        return
    compiler.compile_all("compile the harness", [_SOC / "soc.cpp"], objects, harness_options)
    compiler.link([*sorted(objects.glob("*.o")), *runtime], objects / "library.so", library)
    stamp.write_text(inputs)


def _compile_model(objects, options, harness_options, runtime, kind):
    hot, slow = compiler.model_sources(objects)
    whole = compiler.write_whole(slow, objects / "once.cpp")
    compiler.compile_all("compile code that runs once", [whole], objects, [*compiler.flags(objects, kind == WAVEFORMS), "-O0"])
    # With waveforms, the cost of tracing exceeds the gain of a profile; for a few frames, making the profile takes longer than it saves.
    if kind == PROFILED:
        harness = [_SOC / "soc.cpp", _SOC / "train.cpp"]
        compiler.compile_all("compile the training", harness, objects, harness_options)
        compiler.compile_all("compile with counters", hot, objects, [*options, "-fprofile-generate"])
        print("train", flush=True)
        program, counts, profile = (objects / name for name in ("train", "train.profraw", "train.profdata"))
        compiler.run_linker(["-fprofile-generate", *sorted(objects.glob("*.o")), *runtime], program)
        run([program], cwd=objects, LLVM_PROFILE_FILE=str(counts))
        run([compiler.PROFILE_MERGER, "merge", counts, "-o", profile])
        compiler.object_of(harness[1], objects).unlink()
        options = [*options, f"-fprofile-use={profile}"]
    compiler.compile_all("compile code that runs in each cycle", hot, objects, options)

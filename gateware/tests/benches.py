"""Builds a module's bench with Verilator and the C++ compiler, and runs it."""

import shutil
from concurrent.futures import ThreadPoolExecutor

from tools import BUILD, TESTS, VERILATOR_ROOT, ToolError, digest, run, run_verilator

# Optimisation beyond this costs more than the benches give back.
_COMPILE = ["g++", "-std=c++20", "-O1", "-pthread",
            f"-I{VERILATOR_ROOT}/include", f"-I{VERILATOR_ROOT}/include/vltstd"]

# Registers start with noise, and `x` is noise, so that nothing rests on a zero that nobody wrote.
_VERILATE = ["--cc", "-O3", "-Wall", "--x-initial", "unique", "--x-assign", "unique"]


def run_bench(module):
    """Runs the bench of a module, building it first if it is not up to date. Returns its report, one line a test."""
    program = _build(module)
    try:
        return run([program])
    except ToolError as error:
        # A bench that found something ends with an error; its report says what.
        return str(error)


def _build(module):
    folder = BUILD / module.top
    program = folder / "bench"
    stamp = folder / "inputs"
    inputs = digest([*module.sources, *(TESTS / name for name in module.bench), VERILATOR_ROOT / "bin" / "verilator_bin"],
                    _COMPILE, _VERILATE, module.variants, module.defines)
    if program.exists() and stamp.exists() and stamp.read_text() == inputs:
        return program
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)

    builds = module.builds()
    jobs = [(VERILATOR_ROOT / "include" / f"{name}.cpp", []) for name in ("verilated", "verilated_threads")]
    for name, parameters in builds.items():
        model = folder / name
        run_verilator(*_VERILATE, "--top-module", module.top, "--prefix", f"V{name}", "-Mdir", model,
                      *(f"-G{key}={value}" for key, value in parameters.items()), *module.sources)
        # In one piece: each of the files alone costs as much as all of them.
        whole = model / "whole.cpp"
        whole.write_text("".join(f'#include "{path.name}"\n' for path in sorted(model.glob("*.cpp"))))
        jobs.append((whole, []))
    includes = [f"-I{folder / name}" for name in builds]
    jobs.append((TESTS / module.bench[0], [f"-D{define}" for define in module.defines]))

    def compile_one(number, source, options):
        target = folder / f"{number}.o"
        run([*_COMPILE, *includes, *options, "-c", source, "-o", target])
        return target

    with ThreadPoolExecutor(max_workers=2) as pool:
        objects = list(pool.map(lambda job: compile_one(job[0], *job[1]), enumerate(jobs)))
    run([*_COMPILE, *objects, "-o", program])
    stamp.write_text(inputs)
    return program

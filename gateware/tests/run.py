"""Tests of the gateware that need no SoC: lint, models for the tests in Rust, and the boards' generated files.

    python gateware/tests/run.py           runs everything, one line a test; ends with 1 if anything failed
    python gateware/tests/run.py --models [NAME ...]
                                           builds the models for the tests in tools/testbench instead, all or only those of
                                           the named modules
    python gateware/tests/run.py --size NAME
                                           prints what a module, or `soc`, costs on the FPGA instead, as JSON:
                                           `cargo xtask resources` makes tables of it
    python gateware/tests/run.py --route NAME
                                           places and routes a module, or `vexriscv`, on an ECP5 FPGA instead, and prints its
                                           clock rates as JSON: `cargo xtask resources --route` makes a table of it
"""

import argparse
import json
import logging
import sys
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import counters  # noqa: E402
import digits  # noqa: E402
import register_bus  # noqa: E402
import registers  # noqa: E402
import memory_bridge  # noqa: E402
import memory_crossbar  # noqa: E402
import memory_model  # noqa: E402
import netlist  # noqa: E402
import parameters  # noqa: E402
import route  # noqa: E402
import size  # noqa: E402
import tables  # noqa: E402
import ulx3s  # noqa: E402
import urbana  # noqa: E402
from modules import MODULES  # noqa: E402
from tools import ToolError  # noqa: E402
from verilate import module as verilated_module  # noqa: E402
from verilate.programs import run_verilator  # noqa: E402


# Number of checks that run at the same time: each keeps one core busy.
_AT_A_TIME = 2


def check(name, action):
    """Runs `action` and prints one line if it passes. It fails by an exception or by returning a list of problems that is not
    empty. Returns whether it failed."""
    try:
        problems = action() or []
    except ToolError as error:
        problems = [str(error)]
    print("\n      ".join([f"FAIL  {name}:", *problems] if problems else [f"ok    {name}"]), flush=True)
    return bool(problems)


def module_checks():
    """Yields the checks of the modules, as functions that return whether they failed. The build of a model also checks all warnings."""
    for module in MODULES:
        for name, parameters in module.builds().items():
            if name in module.measured:
                yield partial(check, f"{name}: lint", partial(run_lint, module, parameters))
            yield partial(check, f"{name}: read by Yosys", partial(size.read, module, parameters))
        yield from model_builds(module)


def model_builds(module):
    """Yields the builds of a module for the tests in `tools/testbench`."""
    for name, parameters in module.builds().items():
        if name not in module.measured:
            yield partial(check, f"{name}: built for tools/testbench",
                          partial(verilated_module.build, module.top, module.sources, name, parameters))


def run_all(checks):
    """Runs checks, some at a time, and returns the number of those that failed."""
    with ThreadPoolExecutor(_AT_A_TIME) as pool:
        return sum(pool.map(lambda one: one(), checks))


def test():
    """Runs all checks and returns the number of those that failed."""
    failures = run_all(module_checks())
    others = {
        **{f"descriptions: {name}": action for name, action in registers.CHECKS.items()},
        **{f"counters: {name}": action for name, action in counters.CHECKS.items()},
        **{f"digits: {name}": action for name, action in digits.CHECKS.items()},
        **{f"parameters: {name}": action for name, action in parameters.CHECKS.items()},
        **{f"register banks: {name}": action for name, action in register_bus.CHECKS.items()},
        **{f"memory bridge: {name}": action for name, action in memory_bridge.CHECKS.items()},
        **{f"memory crossbar: {name}": action for name, action in memory_crossbar.CHECKS.items()},
        **{f"memory model: {name}": action for name, action in memory_model.CHECKS.items()},
        **{f"Yosys' table of {name}": action for name, action in tables.CHECKS.items()},
        **{f"sizes: {name}": action for name, action in size.CHECKS.items()},
        **{f"netlists: {name}": action for name, action in netlist.CHECKS.items()},
        **{f"clock rates: {name}": action for name, action in route.CHECKS.items()},
        **board_checks("urbana", urbana),
        **board_checks("ulx3s", ulx3s),
    }
    return failures + sum(check(name, action) for name, action in others.items())


def board_checks(name, board):
    """Generates a board's files, and returns their checks by name."""
    files = board.generate()
    return {f"{name}: {check_name}": partial(action, *files) for check_name, action in board.CHECKS.items()}


def run_lint(module, parameters):
    """Checks a module with all warnings of Verilator; any warning is an error."""
    run_verilator("--lint-only", "-Wall", "--top-module", module.top,
                  *(f"-G{key}={value}" for key, value in parameters.items()), *module.sources)


def print_measured(measure, name):
    """Measures the block `name` and prints the result as a line of JSON. Returns whether the measurement failed."""
    try:
        print(json.dumps({"name": name, **measure(name)}), flush=True)
    except ToolError as error:
        print(error)
        return True
    return False


def build_models(names):
    """Builds the models for `tools/testbench`, or only those of the modules `names`, and returns the number of failed builds."""
    chosen = [module for module in MODULES if not names or module.top in names]
    return run_all(build for module in chosen for build in model_builds(module))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--size", metavar="NAME", help="print a size instead")
    what.add_argument("--route", metavar="NAME", help="print clock rates by place and route instead")
    what.add_argument("--models", nargs="*", metavar="NAME", choices=[module.top for module in MODULES],
                      help="build what the tests in tools/testbench need instead, or only these modules of it")
    parser.add_argument("--seeds", metavar="N", type=int, nargs="+", help="seeds of the placer for --route")
    arguments = parser.parse_args()
    logging.disable(logging.INFO) # LiteX describes all it does
    if arguments.size:
        failed = print_measured(size.measure, arguments.size)
    elif arguments.route:
        failed = print_measured(partial(route.measure, seeds=arguments.seeds or route.SEEDS), arguments.route)
    elif arguments.models is not None:
        failed = build_models(arguments.models)
    else:
        failed = test()
    sys.exit(1 if failed else 0)

"""Tests of the gateware that need no SoC: modules on their benches, lint, and the Urbana's generated files.

    python gateware/tests/run.py           runs everything, one line a test; ends with 1 if anything failed
    python gateware/tests/run.py --models [NAME ...]
                                           builds what the tests in tools/rtl need instead, or only these modules of it
    python gateware/tests/run.py --size NAME
                                           prints what a module, or `soc`, costs on the FPGA instead, as JSON:
                                           `cargo xtask resources` makes tables of it
"""

import argparse
import json
import logging
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import benches  # noqa: E402
import memory_bridge  # noqa: E402
import models  # noqa: E402
import size  # noqa: E402
import urbana  # noqa: E402
from modules import MODULES  # noqa: E402
from tools import ToolError, run_verilator  # noqa: E402


class Report:
    """Prints outcomes and counts the failures."""

    def __init__(self):
        self.failures = 0

    def check(self, name, action):
        """Runs `action`; it fails by an exception or by returning a list of problems that is not empty."""
        try:
            problems = action() or []
        except ToolError as error:
            problems = [str(error)]
        if problems:
            self.failures += 1
            print(f"FAIL  {name}:", *problems, sep="\n      ", flush=True)
        else:
            print(f"ok    {name}", flush=True)

    def bench(self, module):
        """Runs a bench, which reports in the same form."""
        try:
            lines = benches.run_bench(module).splitlines()
        except ToolError as error:
            lines = [f"FAIL  {module.top}: {error}"]
        print(*lines, sep="\n", flush=True)
        if not any(line.startswith("ok ") for line in lines) or any(line.startswith("FAIL") for line in lines):
            self.failures += 1


def test():
    """Runs everything and returns the number of failures."""
    report = Report()
    for module in MODULES:
        for name, parameters in module.builds().items():
            report.check(f"{name}: lint", lambda: run_lint(module, parameters))
            report.check(f"{name}: read by Yosys", lambda: size.read(module, parameters))
        if module.bench:
            report.bench(module)
        else:
            report.check(f"{module.top}: built for tools/rtl", lambda: models.build(module))
    for name, check in memory_bridge.CHECKS.items():
        report.check(f"memory bridge: {name}", check)
    for name, check in size.CHECKS.items():
        report.check(f"sizes: {name}", check)
    files = urbana.generate()
    for name, check in urbana.CHECKS.items():
        report.check(f"urbana: {name}", lambda: check(*files))
    return report.failures


def run_lint(module, parameters):
    """All of Verilator's warnings, none of them allowed."""
    run_verilator("--lint-only", "-Wall", "--top-module", module.top,
                  *(f"-G{key}={value}" for key, value in parameters.items()), *module.sources)


def print_size(name):
    """Prints a line of JSON. Returns whether it failed."""
    try:
        print(json.dumps({"name": name, **size.measure(name)}), flush=True)
    except ToolError as error:
        print(error)
        return True
    return False


def build_models(names):
    """Builds the modules that are tested from Rust, or those named, and returns the number of those that do not build."""
    report = Report()
    for module in MODULES:
        if not module.bench and (not names or module.top in names):
            report.check(module.top, lambda: models.build(module))
    return report.failures


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--size", metavar="NAME", help="print a size instead")
    what.add_argument("--models", nargs="*", metavar="NAME", choices=[module.top for module in MODULES],
                      help="build what the tests in tools/rtl need instead, or only these modules of it")
    arguments = parser.parse_args()
    logging.disable(logging.INFO) # LiteX describes all it does
    if arguments.size:
        failed = print_size(arguments.size)
    elif arguments.models is not None:
        failed = build_models(arguments.models)
    else:
        failed = test()
    sys.exit(1 if failed else 0)

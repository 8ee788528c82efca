"""FPGA resources of the gateware and its clock rates, against `gateware/budget.toml`: `cargo xtask resources` runs this program."""

import argparse
import json
import logging
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from verilate.programs import GATEWARE

from . import machine, route, scenes, size, tables
from .blocks import ALL, FLAT_PARTS, OWN, SHOWN, SOC, row, selection
from .budget import Budget, with_flat_build
from .tools import ToolError

DOCS = GATEWARE.parent / "docs"

_AT_A_TIME = len(os.sched_getaffinity(0))
"""Number of parallel measurements; each needs one core and about 1 GB of memory."""


def measured(what, measure, names):
    """Measures blocks in parallel until one fails, and prints a line for each on standard error. The results are in the order of the
    tables."""
    def one(name):
        start = time.monotonic()
        result = {"name": name, **measure(name)}
        print(f"  ok   {time.monotonic() - start:6.1f} s  {what} of {name}", file=sys.stderr, flush=True)
        return result

    with ThreadPoolExecutor(_AT_A_TIME) as pool:
        return sorted(pool.map(one, names), key=lambda result: row(result["name"]))


def measured_sizes(names):
    """Measures the sizes of blocks."""
    sizes = with_flat_build(measured("size", size.measure, names))
    return sorted(sizes, key=lambda result: row(result["name"]))


def measured_rates(names):
    """Places and routes the soft core and blocks. The rate of the soft core comes first."""
    rates = measured("clock rate", route.measure, [route.REFERENCE, *(name for name in names if name != route.REFERENCE)])
    rates.sort(key=lambda rate: rate["name"] != route.REFERENCE)
    reference = rates[0]["mhz"]
    slow = {name: route.slow_paths(name, reference) for name in machine.MACHINES if name in names}
    return [rate | {"ratio": rate["mhz"] / reference, "slow": slow.get(rate["name"])} for rate in rates]


def check(budget):
    """Measures the sizes of the project's own blocks, and with one seed the clock rates of blocks with a minimum ratio. The SoC and the
    soft core are left out, because their measurement takes too long for every test run. Returns a line for each exceeded limit."""
    sizes = measured("size", size.measure, OWN)
    return budget.problems(sizes, measured("clock rate", partial(route.measure, seeds=route.SEEDS[:1]), budget.routed()))


def measure_scenes(path, write):
    """Measures the builds in the file `path`, which `cargo xtask resources --scenes` writes. Returns a line for each exceeded limit."""
    data = json.loads(path.read_text())
    sizes = measured("size", size.measure, [f"{SOC}-{build['name']}" for build in data["builds"]])
    rows = scenes.rows(data, {one["name"].removeprefix(f"{SOC}-"): one for one in sizes})
    page = tables.render("scene-builds.md", **scenes.contents(data, rows, Budget.read()))
    print(page)
    if write:
        (DOCS / "scene-builds.md").write_text(page)
    return scenes.problems(rows, data["full"])


def main():
    """Parses the command line of `cargo xtask resources`, and measures. Returns a line for each exceeded limit."""
    parser = argparse.ArgumentParser(prog="python -m resources", description=__doc__)
    parser.add_argument("blocks", nargs="*")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--check", action="store_true", help="measure only the limits that `cargo xtask test` checks")
    what.add_argument("--route", action="store_true", help="place and route on an ECP5")
    what.add_argument("--tree", type=int, metavar="DEPTH", help="print the cells of the instances in the blocks, down to DEPTH")
    what.add_argument("--scenes", type=Path, metavar="FILE", help="measure the builds for scenes that FILE describes")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--write", action="store_true", help="write docs/resources.md, or with --scenes docs/scene-builds.md")
    arguments = parser.parse_args()
    logging.disable(logging.INFO) # LiteX logs each step
    start, budget = time.monotonic(), Budget.read()
    if arguments.check:
        return check(budget)
    if arguments.scenes:
        return measure_scenes(arguments.scenes, arguments.write)
    if arguments.tree is not None:
        trees = [tables.tree(one, arguments.tree)
                 for one in measured("size", size.measure, selection(arguments.blocks, [SOC]))]
        print(json.dumps(trees, indent=2) if arguments.json else "\n".join(f"\n{tables.tree_text(tree)[:-1]}" for tree in trees))
        return []
    sizes, rates = [], []
    if not arguments.route or arguments.write:
        sizes = measured_sizes(selection(arguments.blocks, ALL))
    if arguments.route:
        rates = measured_rates(selection(arguments.blocks, OWN + (SHOWN if arguments.write else ())))
    if arguments.json:
        print(json.dumps(tables.as_json(sizes, rates, budget), indent=2, sort_keys=True))
    else:
        print(f"\n{tables.text(sizes, rates, budget)}{time.monotonic() - start:.0f} s")
    if arguments.write:
        (DOCS / "resources.md").write_text(page(sizes, rates, budget))
    return budget.problems(sizes, rates)


def page(sizes, rates, budget):
    """The page docs/resources.md."""
    return tables.render(
        "resources.md", tools=tables.tools(sizes, rates), own=OWN, routed=budget.routed(), flat_parts=FLAT_PARTS,
        others=tables.others(sizes), sizes=tables.sizes_table(sizes, budget), rates=tables.rates_table(rates) if rates else None, slow=tables.slow_tables(rates),
        placement=tables.placement_table(sizes, rates, budget), limits=tables.budget_table(sizes, budget))


if __name__ == "__main__":
    try:
        lines = main()
    except ToolError as error:
        sys.exit(str(error))
    if lines:
        sys.exit("beyond the limits:\n" + "\n".join(lines))

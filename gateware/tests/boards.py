"""Comparison of a board's generated files with a table of its pins."""

import csv
import re
from collections import Counter


def check_pins(found, table, in_design):
    """Checks that each port of a design has exactly the pin and the properties in the table, and that no pin is used twice.

    `found` maps the ports of the constraints to their properties, with the pin as `LOC` and its I/O standard as `IOSTANDARD`.
    `table` is a CSV file with the columns signal, pin, iostandard, properties. `in_design` are the ports of the design.
    """
    with open(table, newline="") as file:
        rows = {row["signal"]: row for row in csv.DictReader(file)}
    expected = {signal: {"LOC": row["pin"], "IOSTANDARD": row["iostandard"], **dict(item.split("=") for item in row["properties"].split())}
                for signal, row in rows.items()}
    assert found
    assert found == {port: expected.get(port) for port in found}, f"pins that differ from {table.name}"
    assert found.keys() == in_design, "ports with a pin, and ports of the design"
    assert max(Counter(row["pin"] for row in rows.values()).values()) == 1, f"uses of a pin in {table.name}"


def ports(verilog, top):
    """Returns the ports of the module `top`, one name per bit."""
    header = re.search(rf"^module {top} \((.*?)^\);", verilog, re.M | re.S).group(1)
    names = set()
    for width, name in re.findall(r"^\s*(?:input|output|inout)\s+(?:wire|reg)\s+(?:\[(\d+):0\])?\s*(\w+),?$", header, re.M):
        names |= {f"{name}[{bit}]" for bit in range(int(width) + 1)} if width else {name}
    return names

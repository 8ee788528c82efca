"""Comparison of a board's generated files with a table of its pins."""

import csv
import re
from collections import Counter


def check_pins(found, table, in_design):
    """Checks that each port of a design has the pin and the properties of the table, and no other, and that no pin is used twice.

    `found` maps the ports of the constraints to their properties, with the pin as `LOC` and its I/O standard as `IOSTANDARD`.
    `table` is a CSV file with the columns signal, pin, iostandard, properties. `in_design` are the ports of the design.
    """
    with open(table, newline="") as file:
        rows = {row["signal"]: row for row in csv.DictReader(file)}
    problems = []
    for port, properties in found.items():
        row = rows.get(port)
        if row is None:
            problems.append(f"{port} is in the constraints but not in {table.name}")
            continue
        expected = {"LOC": row["pin"], "IOSTANDARD": row["iostandard"]}
        expected |= dict(item.split("=") for item in row["properties"].split())
        if properties != expected:
            problems.append(f"{port}: expected {expected}, the constraints have {properties}")
    problems += [f"{port} is a port of the design without a pin" for port in in_design - found.keys()]
    problems += [f"{port} has a pin but is no port of the design" for port in found.keys() - in_design]
    pins = Counter(row["pin"] for row in rows.values())
    problems += [f"pin {pin} is in the table {count} times" for pin, count in pins.items() if count > 1]
    if not found:
        problems.append("no pin found in the constraints")
    return problems


def ports(verilog, top):
    """Returns the ports of the module `top`, one name per bit."""
    header = re.search(rf"^module {top} \((.*?)^\);", verilog, re.M | re.S).group(1)
    names = set()
    for width, name in re.findall(r"^\s*(?:input|output|inout)\s+(?:wire|reg)\s+(?:\[(\d+):0\])?\s*(\w+),?$", header, re.M):
        names |= {f"{name}[{bit}]" for bit in range(int(width) + 1)} if width else {name}
    return names

"""What a module costs on a 7-series FPGA, by Yosys: no place and route, no vendor tool."""

import re

from tools import run_yosys

# The rows of the table and the cells that count in each.
_ROWS = {
    "LUT": r"LUT[1-6]", "FF": r"FD[RSCP]E", "CARRY4": r"CARRY4", "SRL": r"SRL\w+", "LUTRAM": r"RAM\d+[MXD]\w*",
    "RAMB36": r"RAMB36E1", "RAMB18": r"RAMB18E1", "DSP48": r"DSP48E1",
}

LONGEST_PATH = 12
"""Cells between registers that a block may have at most: a proxy for timing that needs no place and route."""

# `ltp` takes a Xilinx flip-flop for logic, so what begins and ends a path is deleted first.
_SCRIPT = """synth_xilinx -family xc7 -top {top} -flatten;
tee -a report stat;
delete t:FD* t:RAMB* t:DSP48E1 t:SRL* t:BUFG t:IBUF t:OBUF;
tee -a report ltp"""


def measure(module):
    """Returns a dictionary of cell counts and the number of cells on the longest path between registers."""
    report = run_yosys(_SCRIPT.format(top=module.top), module.sources)
    cells = {name: int(count) for count, name in re.findall(r"^\s+(\d+)\s+([A-Z]\w+)$", report, re.M)}
    size = {row: sum(count for name, count in cells.items() if re.fullmatch(pattern, name))
            for row, pattern in _ROWS.items()}
    size["path"] = int(re.search(r"Longest topological path in \w+ \(length=(\d+)\)", report).group(1))
    return size


def read(module):
    """Checks that Yosys understands a module."""
    run_yosys(f"hierarchy -check -top {module.top}; proc; check -assert", module.sources)

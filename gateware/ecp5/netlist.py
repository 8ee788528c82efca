"""Changes to a netlist between synthesis and placement.

Yosys and nextpnr write designs as JSON: cells with their ports, and for each port the numbers of the nets at its bits.
"""

import json


class Netlist:
    """The design in one JSON file."""

    def __init__(self, path):
        self._design = json.loads(path.read_text())
        self._cells = next(module["cells"] for module in self._design["modules"].values() if "top" in module["attributes"])

    def write(self, path):
        """Writes the design to a file."""
        path.write_text(json.dumps(self._design))

    def take_logic_off_resets(self):
        """Connects LUTs to the input of a reset's global buffer instead of its output.

        A global buffer reaches the reset inputs of flip-flops through dedicated wires. To reach a LUT, nextpnr uses ordinary
        wires, which it routes before any other net. These wires may be the only ones that another net can use.
        """
        for buffer in [cell for cell in self._cells.values() if cell["type"] == "DCCA"]:
            source, output = (buffer["connections"][port] for port in ("CLKI", "CLKO"))
            loads = [(cell, port) for cell in self._cells.values() for port, nets in cell["connections"].items()
                     if nets == output and cell["port_directions"][port] == "input"]
            if any(port == "LSR" for _, port in loads):
                for cell, port in loads:
                    if port != "LSR":
                        cell["connections"][port] = source

"""Verilog for the proofs of modules that are written in Python."""

import runpy

from migen import Cat, Module, Signal
from migen.fhdl import verilog

from crossbar import connect


class _Crossbar(Module):
    """A crossbar of the class `crossbar` between three ports (both ways, read, write) and two banks. Its vectors have an element
    for each port or bank, the first one in the lowest bits. An address is {row, bank, column} of 1, 1 and 3 bits."""

    def __init__(self, crossbar):
        self.submodules.crossbar, controller, ports = connect(
            crossbar, ("both", "read", "write"), latencies=(1, 0), depth=5, bits=8, column_bits=3, bank_bits=1)
        banks = [controller.bank0, controller.bank1]
        inputs = {
            "cmd_valid": [port.cmd.valid for port in ports],
            "cmd_we": [port.cmd.we for port in ports],
            "cmd_addr": [port.cmd.addr for port in ports],
            "wdata": [port.wdata.data for port in ports],
            "bank_wdata_ready": [bank.wdata_ready for bank in banks],
            "bank_rdata_valid": [bank.rdata_valid for bank in banks],
            "memory_rdata": [controller.rdata],
        }
        outputs = {
            "cmd_ready": [port.cmd.ready for port in ports],
            "wdata_ready": [port.wdata.ready for port in ports],
            "rdata_valid": [port.rdata.valid for port in ports],
            "rdata": [port.rdata.data for port in ports],
            "bank_valid": [bank.valid for bank in banks],
            "bank_we": [bank.we for bank in banks],
            "bank_addr": [bank.addr for bank in banks],
            "memory_wdata": [controller.wdata],
        }
        self.ios = set()
        for names, is_input in (inputs, True), (outputs, False):
            for name, signals in names.items():
                port = Signal(sum(map(len, signals)), name=name)
                self.ios.add(port)
                self.comb += Cat(*signals).eq(port) if is_input else port.eq(Cat(*signals))


def write(source, folder):
    """Writes the crossbar in the file `source`, `memory_crossbar.py` or a mutation of it, as the Verilog module `memory_crossbar`
    to `folder`, and returns the path."""
    # The name puts a mutation into the package too, so that it finds the modules that it imports.
    module = _Crossbar(runpy.run_path(str(source), run_name="glint_soc.memory_crossbar")["MemoryCrossbar"])
    path = folder / "memory_crossbar.v"
    path.write_text(str(verilog.convert(module, module.ios, name="memory_crossbar")))
    return path

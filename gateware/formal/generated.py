"""Verilog for the proofs of modules that are written in Python."""

import runpy

from litex.soc.interconnect import wishbone
from migen import Module
from migen.fhdl import verilog

from crossbar import connect
from ports import add_ports, members


class _CpuBus(Module):
    """The class `cpu_bus` between the buses of the CPU and the shared bus."""

    def __init__(self, cpu_bus):
        data, instructions = (wishbone.Interface(data_width=32, address_width=32, addressing="word") for _ in range(2))
        self.submodules.stage = stage = cpu_bus(data, instructions)
        self.comb += [data.stb.eq(data.cyc), instructions.stb.eq(instructions.cyc), instructions.sel.eq(0b1111)]
        masters, slave = {"data": data, "instructions": instructions}, {"bus": stage.bus}
        self.ios = add_ports(
            self, members(masters, "cyc adr cti") | members({"data": data}, "we dat_w sel") | members(slave, "ack dat_r"),
            members(slave, "cyc stb we adr dat_w sel cti") | members(masters, "ack dat_r"))


class _Crossbar(Module):
    """A crossbar of the class `crossbar` between three ports (read and write, read only, write only) and two banks. The
    module's ports have an element for each of these ports or banks. An address is {row, bank, column} of 1, 1 and 3 bits."""

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
        self.ios = add_ports(self, inputs, outputs)


_MODULES = {"memory_crossbar": (_Crossbar, "MemoryCrossbar"), "cpu_bus": (_CpuBus, "CpuBus")}
"""The modules by the names of their files, each with the ports of its proof and the name of its class."""


def write(source, folder):
    """Writes the module in the file `source`, one of `_MODULES` or a mutation of it, as Verilog to `folder`, and returns the path."""
    ports, name = _MODULES[source.stem]
    # This module name makes relative imports work for mutated copies outside of the package too.
    module = ports(runpy.run_path(str(source), run_name=f"glint_soc.{source.stem}")[name])
    path = folder / f"{source.stem}.v"
    path.write_text(str(verilog.convert(module, module.ios, name=source.stem)))
    return path

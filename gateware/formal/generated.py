"""Verilog for the proofs of modules that are written in Python."""

import runpy

from litex.soc.interconnect import wishbone
from migen import Cat, Module, Signal
from migen.fhdl import verilog

from crossbar import connect


class _Proved(Module):
    """A module whose ports are vectors of signals, the first one in the lowest bits."""

    def __init__(self):
        self.ios = set()

    def add_ports(self, inputs, outputs):
        """Adds ports, each of the given name with the given signals."""
        for names, is_input in (inputs, True), (outputs, False):
            for name, signals in names.items():
                port = Signal(sum(map(len, signals)), name=name)
                self.ios.add(port)
                self.comb += Cat(*signals).eq(port) if is_input else port.eq(Cat(*signals))


class _CpuBus(_Proved):
    """A stage of the class `cpu_bus` between the buses of the CPU and the shared one."""

    def __init__(self, cpu_bus):
        _Proved.__init__(self)
        data, instructions = (wishbone.Interface(data_width=32, address_width=32, addressing="word") for _ in range(2))
        self.submodules.stage = stage = cpu_bus(data, instructions)
        self.comb += [data.stb.eq(data.cyc), instructions.stb.eq(instructions.cyc), instructions.sel.eq(0b1111)]
        masters, slave = {"data": data, "instructions": instructions}, {"bus": stage.bus}
        self.add_ports(
            _members(masters, "cyc adr cti") | _members({"data": data}, "we dat_w sel") | _members(slave, "ack dat_r"),
            _members(slave, "cyc stb we adr dat_w sel cti") | _members(masters, "ack dat_r"))


def _members(buses, names):
    """The ports of the given members of buses, each called BUS_MEMBER."""
    return {f"{bus}_{name}": [getattr(interface, name)] for bus, interface in buses.items() for name in names.split()}


class _Crossbar(_Proved):
    """A crossbar of the class `crossbar` between three ports (both ways, read, write) and two banks. Its ports have an element
    for each port or bank. An address is {row, bank, column} of 1, 1 and 3 bits."""

    def __init__(self, crossbar):
        _Proved.__init__(self)
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
        self.add_ports(inputs, outputs)


_MODULES = {"memory_crossbar": (_Crossbar, "MemoryCrossbar"), "cpu_bus": (_CpuBus, "CpuBus")}
"""The modules by the names of their files, each with the ports of its proof and the name of its class."""


def write(source, folder):
    """Writes the module in the file `source`, one of `_MODULES` or a mutation of it, as Verilog to `folder`, and returns the path."""
    ports, name = _MODULES[source.stem]
    # The name puts a mutation into the package too, so that it finds the modules that it imports.
    module = ports(runpy.run_path(str(source), run_name=f"glint_soc.{source.stem}")[name])
    path = folder / f"{source.stem}.v"
    path.write_text(str(verilog.convert(module, module.ios, name=source.stem)))
    return path

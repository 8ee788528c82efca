"""The whole way to main memory as a module for a test bench: the CPU's stage and bridge, ports of engines and scan-out, controller, memory."""

from litedram.modules import MT41K64M16
from litex.gen import LiteXModule
from litex.gen.fhdl import verilog
from litex.soc.interconnect import wishbone
from migen import ClockDomain, Signal

from glint_soc.cpu_bus import CpuBus
from glint_soc.memory_bridge import MemoryBridge
from glint_soc.memory_controller import MemoryController
from glint_soc.memory_model import MemoryModel
from glint_soc.soc import SYS_CLK_FREQ

NAME = "memory_machine"

_PORTS = {"data": ("cyc", "we", "adr", "dat_w", "sel", "cti"), "instructions": ("cyc", "adr", "cti")}
"""Inputs of the CPU's buses; the address is that of a word of 32 bits in main memory."""


class _Memory(MT41K64M16):
    """The Urbana's memory with fewer rows."""

    nrows = 2048


class _Machine(LiteXModule):
    """Ports: `clk`, `rst`; BUS_SIGNAL of both buses of the CPU; PORT_SIGNAL of the ports `read0`, `read1`, `write0`, `write1` and
    `scanout`, with words of 128 bits; and `refreshed`, high for one clock at the end of a refresh."""

    def __init__(self):
        self.cd_sys = ClockDomain()
        clk, rst = Signal(name="clk"), Signal(name="rst")
        self.comb += [self.cd_sys.clk.eq(clk), self.cd_sys.rst.eq(rst)]
        self.ios = {clk, rst}
        module = _Memory(SYS_CLK_FREQ, "1:4")
        self.phy = MemoryModel(module, data_width=16, clk_freq=SYS_CLK_FREQ)
        self.memory = MemoryController(self.phy, module, SYS_CLK_FREQ)
        get_port = self.memory.crossbar.get_port
        buses = {name: wishbone.Interface(data_width=32, address_width=32, addressing="word") for name in _PORTS}
        self.stage = CpuBus(**buses)
        self.bridge = MemoryBridge(self.stage.bus, get_port("both", 128), 0)
        for name, bus in buses.items():
            self.comb += bus.stb.eq(bus.cyc)
            for signal in _PORTS[name]:
                self._input(f"{name}_{signal}", getattr(bus, signal))
            self._output(f"{name}_ack", bus.ack)
            self._output(f"{name}_dat_r", bus.dat_r)
        self.comb += buses["instructions"].sel.eq(0b1111)
        for name, mode in {"read0": "read", "read1": "read", "write0": "write", "write1": "write", "scanout": "read"}.items():
            port = get_port(mode, 128)
            self._input(f"{name}_valid", port.cmd.valid)
            self._input(f"{name}_addr", port.cmd.addr)
            self._output(f"{name}_ready", port.cmd.ready)
            if mode == "read":
                self._output(f"{name}_data_valid", port.rdata.valid)
                self._output(f"{name}_data", port.rdata.data)
            else:
                self.comb += [port.cmd.we.eq(1), port.wdata.valid.eq(1), port.wdata.we.eq(0xffff)]
                self._input(f"{name}_data", port.wdata.data)
                self._output(f"{name}_data_ready", port.wdata.ready)
        self._output("refreshed", self.memory.controller.refresher.cmd.last)

    def _input(self, name, signal):
        port = Signal(len(signal), name=name)
        self.ios.add(port)
        self.comb += signal.eq(port)

    def _output(self, name, signal):
        port = Signal(len(signal), name=name)
        self.ios.add(port)
        self.comb += port.eq(signal)


def write(folder):
    """Writes the machine as Verilog to `folder` and returns the path."""
    machine = _Machine()
    path = folder / f"{NAME}.v"
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(str(verilog.convert(machine, machine.ios, name=NAME)))
    return path

"""The complete path to main memory as a module for a test bench: the CPU's arbiter and bridge, the ports of engines and scan-out, the
controller, and the memory."""

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
from ports import add_ports, members

NAME = "memory_machine"

class _Memory(MT41K64M16):
    """The Urbana's memory with fewer rows."""

    nrows = 2048


class _Machine(LiteXModule):
    """Ports: `clk`, `rst`; the members of both buses of the CPU, with addresses of 32-bit words in main memory; commands and data of the
    memory ports `read0`, `read1`, `write0`, `write1` and `scanout`, with 128-bit words; and `refreshed`, which is high for one clock at the
    end of a refresh."""

    def __init__(self):
        self.cd_sys = ClockDomain()
        clk, rst = Signal(name="clk"), Signal(name="rst")
        self.comb += [self.cd_sys.clk.eq(clk), self.cd_sys.rst.eq(rst)]
        self.ios = {clk, rst}
        module = _Memory(SYS_CLK_FREQ, "1:4")
        self.phy = MemoryModel(module, data_width=16, clk_freq=SYS_CLK_FREQ)
        self.memory = MemoryController(self.phy, module, SYS_CLK_FREQ)
        get_port = self.memory.crossbar.get_port
        data, instructions = (wishbone.Interface(data_width=32, address_width=32, addressing="word") for _ in range(2))
        self.stage = CpuBus(data, instructions)
        self.bridge = MemoryBridge(self.stage.bus, get_port("both", 128), 0)
        self.comb += [data.stb.eq(data.cyc), instructions.stb.eq(instructions.cyc), instructions.sel.eq(0b1111)]
        readers = {name: get_port("read", 128) for name in ("read0", "read1", "scanout")}
        writers = {name: get_port("write", 128) for name in ("write0", "write1")}
        for port in writers.values():
            self.comb += [port.cmd.we.eq(1), port.wdata.valid.eq(1), port.wdata.we.eq(0xffff)]
        masters, ports = {"data": data, "instructions": instructions}, readers | writers
        commands = {name: port.cmd for name, port in ports.items()}
        read, written = ({f"{name}_word": getattr(port, kind) for name, port in part.items()}
                         for part, kind in ((readers, "rdata"), (writers, "wdata")))
        self.ios |= add_ports(
            self,
            members(masters, "cyc adr cti") | members({"data": data}, "we dat_w sel") | members(commands, "valid addr")
            | members(written, "data"),
            members(masters, "ack dat_r") | members(commands, "ready") | members(read, "valid data") | members(written, "ready")
            | {"refreshed": [self.memory.controller.refresher.cmd.last]})


def write(folder):
    """Writes the machine as Verilog to `folder` and returns the path."""
    machine = _Machine()
    path = folder / f"{NAME}.v"
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(str(verilog.convert(machine, machine.ios, name=NAME)))
    return path

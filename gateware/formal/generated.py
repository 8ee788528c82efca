"""Verilog for the proofs of modules that are written in Python."""

import runpy
from types import SimpleNamespace

from litedram.common import LiteDRAMNativePort, cmd_request_rw_layout
from litedram.phy.dfi import Interface
from litex.soc.interconnect import stream, wishbone
from migen import Module, Signal
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


class _Multiplexer(Module):
    """A multiplexer of the class `multiplexer` between three banks, a refresher and a memory, with addresses of 4 bits."""

    def __init__(self, multiplexer):
        commands = [stream.Endpoint(cmd_request_rw_layout(4, 2)) for _ in range(4)]
        banks = [SimpleNamespace(cmd=cmd, refresh_req=Signal(), refresh_gnt=Signal()) for cmd in commands[:3]]
        refresh = commands[3]
        settings = SimpleNamespace(
            timing=SimpleNamespace(tRRD=2, tFAW=10, tCCD=2, tWTR=1), phy=SimpleNamespace(cwl=1, nphases=1, read_latency=4),
            read_time=8, write_time=8)
        dfi, interface = Interface(4, 2, 1, 8, 1), SimpleNamespace(rdata=Signal(8), wdata=Signal(8), wdata_we=Signal())
        self.submodules.multiplexer = multiplexer(settings, banks, SimpleNamespace(cmd=refresh), dfi, interface)
        self.comb += (cmd.ba.eq(number) for number, cmd in enumerate(commands[:3]))
        (phase,) = dfi.phases
        inputs = {name: [getattr(bank.cmd, name) for bank in banks] for name in ("valid", "cas", "ras", "we", "a")} | {
            "refresh_gnt": [bank.refresh_gnt for bank in banks],
            "refresh_valid": [refresh.valid],
            "refresh_last": [refresh.last],
            "refresh_levels": [refresh.we, refresh.cas, refresh.ras],
            "refresh_a": [refresh.a],
        }
        outputs = {
            "ready": [bank.cmd.ready for bank in banks],
            "refresh_req": [bank.refresh_req for bank in banks],
            "refresh_ready": [refresh.ready],
        } | {name: [getattr(phase, name)] for name in ("ras_n", "cas_n", "we_n", "bank", "address", "rddata_en", "wrdata_en")}
        self.ios = add_ports(self, inputs, outputs)


class _AxiPorts(Module):
    """The class `joined` between two readers, two writers and an AXI port, with words of 16 bits, addresses of 3 bits, an origin, and at most
    two pending writes of a port."""

    def __init__(self, joined):
        readers, writers = ([LiteDRAMNativePort(mode, 3, 16) for _ in range(2)] for mode in ("read", "write"))
        self.submodules.ports = ports = joined([*readers, *writers], _ORIGIN, most_writes=2)
        axi = ports.axi
        native = _native(readers, writers)
        self.ios = add_ports(
            self, native[0] | _channels(axi, "ar_ready aw_ready w_ready r_valid r_id r_data r_resp b_valid b_id b_resp"),
            native[1] | _channels(axi, "ar_valid ar_addr ar_id ar_len ar_size ar_burst aw_valid aw_addr aw_id aw_len aw_size aw_burst "
                                       "w_valid w_data w_strb w_last r_ready b_ready")
            | {"pending": [ports.pending], "error": [ports.error]})


class _WishbonePorts(Module):
    """The class `joined` between two readers, two writers and a Wishbone port, with words and addresses as in `_AxiPorts`."""

    def __init__(self, joined):
        readers, writers = ([LiteDRAMNativePort(mode, 3, 16) for _ in range(2)] for mode in ("read", "write"))
        self.submodules.ports = ports = joined([*readers, *writers], _ORIGIN)
        native, bus = _native(readers, writers), {"bus": ports.bus}
        self.ios = add_ports(self, native[0] | members(bus, "ack err dat_r"),
                             native[1] | members(bus, "cyc stb we adr dat_w sel") | {"error": [ports.error]})


_ORIGIN = 0x40


def _native(readers, writers):
    """Returns the inputs and the outputs of native ports, with an element for each port, the readers first."""
    ports = [*readers, *writers]
    return {
        "cmd_valid": [port.cmd.valid for port in ports],
        "cmd_addr": [port.cmd.addr for port in ports],
        "wdata_valid": [port.wdata.valid for port in writers],
        "wdata": [port.wdata.data for port in writers],
        "wdata_we": [port.wdata.we for port in writers],
    }, {
        "cmd_ready": [port.cmd.ready for port in ports],
        "wdata_ready": [port.wdata.ready for port in writers],
        "rdata_valid": [port.rdata.valid for port in readers],
        "rdata": [port.rdata.data for port in readers],
    }


def _channels(axi, names):
    """Returns the ports for the given signals of AXI channels, each named CHANNEL_SIGNAL."""
    return {f"axi_{name}": [getattr(getattr(axi, channel), signal)]
            for name in names.split() for channel, _, signal in [name.partition("_")]}


_MODULES = {
    "axi_ports": (_AxiPorts, "AxiPorts"),
    "wishbone_ports": (_WishbonePorts, "WishbonePorts"),
    "memory_crossbar": (_Crossbar, "MemoryCrossbar"),
    "memory_multiplexer": (_Multiplexer, "MemoryMultiplexer"),
    "cpu_bus": (_CpuBus, "CpuBus"),
}
"""The modules by the names of their files, each with the ports of its proof and the name of its class."""


def write(source, folder):
    """Writes the module in the file `source`, one of `_MODULES` or a mutation of it, as Verilog to `folder`, and returns the path."""
    ports, name = _MODULES[source.stem]
    # This module name makes relative imports work for mutated copies outside of the package too.
    module = ports(runpy.run_path(str(source), run_name=f"glint_soc.{source.stem}")[name])
    path = folder / f"{source.stem}.v"
    path.write_text(str(verilog.convert(module, module.ios, name=source.stem)))
    return path

"""Ports of modules in Python, for test benches and proofs in other languages."""

from migen import Cat, Signal


def add_ports(module, inputs, outputs):
    """Adds ports to a module, each of the given name with the given signals, the first one in the lowest bits. Returns the ports."""
    ports = set()
    for names, is_input in (inputs, True), (outputs, False):
        for name, signals in names.items():
            port = Signal(sum(map(len, signals)), name=name)
            ports.add(port)
            module.comb += Cat(*signals).eq(port) if is_input else port.eq(Cat(*signals))
    return ports


def members(buses, names):
    """Returns the ports for the given members of buses, each named BUS_MEMBER."""
    return {f"{bus}_{name}": [getattr(interface, name)] for bus, interface in buses.items() for name in names.split()}

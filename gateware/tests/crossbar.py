"""A memory crossbar with its ports, for tests and proofs."""

from litedram.common import LiteDRAMInterface
from litedram.core.controller import ControllerSettings


class _Settings:
    """Settings of a small memory, an object with the given members."""

    def __init__(self, **members):
        self.__dict__.update(members)


def connect(crossbar, modes, latencies, depth, bits, column_bits, bank_bits):
    """Returns a crossbar of the class `crossbar` with a port for each mode, the interface to the bank machines, and the ports.
    `latencies` are the read and the write latency in clocks, `depth` is the depth of the queues. The memory has words of
    `bits` bits, and two rows."""
    settings = ControllerSettings(cmd_buffer_depth=depth)
    settings.phy = _Settings(nranks=1, dfi_databits=bits, nphases=1, read_latency=latencies[0], write_latency=latencies[1])
    settings.geom = _Settings(rowbits=1, colbits=column_bits, bankbits=bank_bits)
    controller = LiteDRAMInterface(0, settings)
    crossbar = crossbar(controller)
    ports = [crossbar.get_port(mode) for mode in modes]
    return crossbar, controller, ports

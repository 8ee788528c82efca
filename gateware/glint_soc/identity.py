"""Who this gateware is: firmware compares it with what it was built for."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRStatus


class Identity(LiteXModule):
    """Two constant registers: the build id and the blocks that this build has."""

    def __init__(self, build_id, blocks):
        self.build_id = CSRStatus(
            32, reset=build_id, description="CRC-32 of the register map of the full build.")
        self.blocks = CSRStatus(
            32, reset=blocks, description="Accelerators in this build, a bit each: 0 scan-out, 1 triangle engine.")

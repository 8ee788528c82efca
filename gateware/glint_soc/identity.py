"""Identity of the gateware, which the firmware compares with its own."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRStatus

from .register_map import OPTIONAL_BLOCKS


class Identity(LiteXModule):
    """Two constant registers: the build id and the blocks that this build has."""

    def __init__(self, build_id, blocks):
        self.build_id = CSRStatus(
            32, reset=build_id, description="CRC-32 of the register map of the full build.")
        self.blocks = CSRStatus(
            32, reset=blocks, description="Optional blocks of this build, a bit each: "
            + ", ".join(f"{bit} `{name}`" for name, bit in OPTIONAL_BLOCKS.items()) + ".")

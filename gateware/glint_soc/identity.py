"""Identity of the gateware: values that the firmware checks or uses."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRStatus

from .register_map import OPTIONAL_BLOCKS


class Identity(LiteXModule):
    """Constant registers: the build id, the blocks that this build has, its clock frequency and the size of its memory.

    The parent module sets the memory size by `add_main_ram`.
    """

    def __init__(self, build_id, blocks, sys_clk_freq):
        self.build_id = CSRStatus(
            32, reset=build_id, description="CRC-32 of the register map of the full build.")
        self.blocks = CSRStatus(
            32, reset=blocks, description="Optional blocks of this build, a bit each: "
            + ", ".join(f"{bit} `{name}`" for name, bit in OPTIONAL_BLOCKS.items()) + ".")
        self.clock = CSRStatus(
            32, reset=sys_clk_freq, description="Frequency of the system clock in Hz.")

    def add_main_ram(self, size):
        """Adds the register with the size of main memory in bytes."""
        self.main_ram = CSRStatus(
            32, reset=size, description="Size of main memory in bytes.")

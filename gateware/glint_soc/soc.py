"""The SoC that all boards share: CPU, memory controller, peripherals and accelerators.

A board adds its platform, its clocks (domains `sys` and `pix`), its memory with a PHY, and its video output. All other parts
that are visible to firmware are in this module.
"""

from litex.soc.cores.gpio import GPIOIn, GPIOOut
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCCore
from litex.soc.interconnect import wishbone
from migen import Cat, Constant, ResetInserter, Signal

from .constants import FLASH_BYTES, FLASH_FIRMWARE
from .cpu_bus import BusSelections, CpuBus
from .digits import Digits
from .flash import FlashReader
from .gesture import GestureEngine
from .i2c import I2CMaster
from .identity import Identity
from .raymarch import Fields, Raymarcher
from .memory_bridge import MemoryBridge
from .memory_controller import MemoryController
from .parameters import without_reading
from .register_bus import RegisterBus
from .register_map import CSR_MAP, CSR_PAGING, OPTIONAL_BLOCKS, PINNED
from .scanout import Scanout
from .triangle import TriangleEngine, memory_ports
from .video import CEA_1280X720

SYS_CLK_FREQ = 81.25e6
"""System clock in Hz. With this clock, DDR3-650 and the logic meet the specification of the -1 speed grade."""

CLOCK_UNIT = 250e3
"""The clock must be a multiple of this, because the firmware converts between time and cycles by a whole number of cycles per 4 µs."""

CPU_VARIANTS = ("lite", "standard", "full", "imac", "linux", "linux+no-dsp", "secure")
"""LiteX's variants of VexRiscv with the instructions of the firmware, rv32im. `minimal` does not multiply. Variants with a debug port, or
with custom instructions (CFU), are otherwise equal to one of these."""

CPU_VARIANT = "full"
"""The default variant of the CPU."""

_FLASH = 0x4000_0000 - FLASH_BYTES
"""Address of the window of the SPI flash. Main memory follows, so a wrong firmware length never makes the BIOS read beyond memory."""

_PORT_BITS = 128
"""Width of the memory ports of the accelerators."""


class GlintSoC(SoCCore):
    """VexRiscv with BIOS in ROM, main memory without a second cache level, and Glint's peripherals.

    `blocks` names the optional blocks of this build. Line engine and raymarcher draw through the triangle engine. Without the block
    `triangle`, the parts of the engine that draw triangles are left out: with `line`, the parts for lines and all registers remain; with
    `raymarch` alone, the raster pass, the band buffer and all registers. `build_id` is the checksum of the register map of the full build
    (see `register_map.build_id`). `smooth` adds smooth shading to the triangle engine, `texture` adds textures, and `fog` adds fog. A
    build with triangles may omit `sky`, the sky behind them. Each build may omit `antialiasing`, pictures with four samples a pixel.
    `geometry` is the geometry pass, which a build without lines may omit, and `depths` the depth memory, which a build without triangles
    may omit.
    `fields` are the build options of the raymarcher. `mode` is the video mode, which also limits the picture sizes. `cpu` is the
    variant of VexRiscv.
    """

    csr_map = CSR_MAP
    possible_blocks = frozenset(OPTIONAL_BLOCKS)
    """The optional blocks for which the board has pins."""
    default_blocks = possible_blocks
    """The default optional blocks of a build."""

    def __init__(self, platform, crg, build_id, blocks, uart_name, smooth=False, texture=False, sky=True, fog=False,
                 antialiasing=True, geometry=True, depths=True, fields=None, sys_clk_freq=SYS_CLK_FREQ, mode=CEA_1280X720, cpu=CPU_VARIANT):
        unknown = set(blocks) - self.possible_blocks
        if unknown:
            raise ValueError(f"blocks {sorted(unknown)}: expected some of {sorted(self.possible_blocks)}")
        if cpu not in CPU_VARIANTS:
            raise ValueError(f"CPU variant {cpu!r}: expected a variant with rv32im, one of {', '.join(CPU_VARIANTS)}")
        if "line" in blocks and not geometry:
            raise ValueError("no geometry pass: expected a build without the block 'line', because lines need this pass")
        if texture and smooth:
            raise ValueError("textures: expected a build without smooth shading, because the engine has one shader for groups")
        if texture and "triangle" not in blocks:
            raise ValueError("textures: expected a build with the block 'triangle', because only meshes have textures")
        if fog and "triangle" not in blocks:
            raise ValueError("fog: expected a build with the block 'triangle', because this option adds fog to meshes")
        if "triangle" in blocks and not depths:
            raise ValueError("no depths: expected a build without the block 'triangle', because meshes need depths")
        if sys_clk_freq % CLOCK_UNIT:
            raise ValueError(f"system clock of {sys_clk_freq / 1e6} MHz: expected a multiple of {CLOCK_UNIT / 1e6} MHz")
        self.draws_triangles = "triangle" in blocks
        self.draws_lines = "line" in blocks
        self.blocks = frozenset({*blocks, "triangle"} if {"line", "raymarch"} & set(blocks) else blocks)
        self.mode = mode
        self.smooth = smooth
        self.texture = texture
        self.sky = sky and self.draws_triangles
        self.fog = fog
        self.antialiasing = antialiasing
        self.geometry = geometry
        self.depths = depths
        self.fields = fields or Fields()
        # This must be set before SoCCore adds `uart` and `timer0`, because SoCCore keeps interrupt numbers that are already assigned.
        self.interrupt_map = {
            name: location.irq for name, location in PINNED.items()
            if location.irq is not None and (name not in OPTIONAL_BLOCKS or name in self.blocks)
        }
        # LiteX finalizes submodules in the order in which they were added.
        self.register_bus = RegisterBus(lambda: self.csr_bankarray.banks)
        self.crg = crg
        SoCCore.__init__(
            self, platform, clk_freq=int(sys_clk_freq),
            cpu_type="vexriscv", cpu_variant=cpu,
            integrated_rom_size=0x8000, integrated_sram_size=0x2000,
            csr_paging=CSR_PAGING,
            uart_name=uart_name, uart_baudrate=115200,
            timer_uptime=True,
        )
        # Software does not read back these registers.
        for name in ("_load", "_reload"):
            setattr(self.timer0, name, without_reading(getattr(self.timer0, name)))
        # The BIOS's banner would take 60 ms on the serial line, and its build time would make every build different.
        self.add_config("BIOS_NO_PROMPT")
        # The interrupt handler of the BIOS drops bytes that do not fit its buffer. With polling, unread bytes stay in the UART
        # and stall the sender.
        self.add_constant("UART_POLLING")
        # The BIOS tests 2 MiB of memory by default, which takes most of a second.
        self.add_constant("MEMTEST_DATA_SIZE", 8 * 1024)
        self.add_constant("MEMTEST_ADDR_SIZE", 8 * 1024)
        self.add_constant("BUILD_ID", build_id)

        enabled = sum(1 << OPTIONAL_BLOCKS[name] for name in set(blocks))
        self.identity = Identity(build_id, enabled, self.sys_clk_freq)
        if "i2c" in self.blocks:
            self.i2c = I2CMaster(platform, platform.request("i2c"), sys_clk_freq)
        self.buttons = GPIOIn(self._inputs("buttons", 4), with_irq=True)
        self.switches = GPIOIn(self._inputs("switches", 16))
        self.leds = GPIOOut(self._outputs("leds", 16))
        if "digits" in self.blocks:
            self.digits = Digits(platform.request("digits"))
        if "gesture" in self.blocks:
            self.gesture = GestureEngine(platform, platform.request("camera"), sys_clk_freq)
        if "flash" in self.blocks:
            self.flash = FlashReader(platform, platform.request("flash"))
            self.bus.add_slave("flash", self.flash.bus, SoCRegion(origin=_FLASH, size=FLASH_BYTES, mode="rx"))
            # If no host answers, the BIOS starts the firmware at this address.
            self.add_constant("FLASH_BOOT_ADDRESS", _FLASH + FLASH_FIRMWARE)

    def add_cpu(self, *arguments, **options):
        """Adds the CPU, with one bus master instead of two."""
        SoCCore.add_cpu(self, *arguments, **options)
        self.bus.masters.clear()
        self.cpu_bus = ResetInserter()(CpuBus(self.cpu.dbus, self.cpu.ibus))
        self.comb += self.cpu_bus.reset.eq(self.cpu.reset)
        self.bus.add_master("cpu", self.cpu_bus.bus)
        self.bus_selections = BusSelections(self.cpu_bus)

    def add_csr_bridge(self, name="csr", origin=None, register=False):
        """Adds the bridge to the registers, and the decoder of the bus. LiteX calls this when it finalizes the SoC, after all other slaves
        of the bus were added. It adds no interconnect of its own, because its list of the masters of registers is empty."""
        self.bus.add_slave(name, self.register_bus.bridge.wishbone, SoCRegion(
            origin=origin, size=2**(self.csr.address_width + 2), cached=False, decode=self.cpu.csr_decode))
        self.add_config("CSR_DATA_WIDTH", self.csr.data_width)
        self.add_config("CSR_ALIGNMENT", self.csr.alignment)
        # `BusSelections` already stores the selections in flip-flops.
        self.bus.interconnect_register = False
        for region in self.bus.regions.values():
            region.decoder = lambda bus, decoder=region.decoder: self.bus_selections.stored(decoder(bus))

    def _inputs(self, name, bits):
        """Returns the input pins `name`, extended to `bits` bits; bits without a pin on the board are 0."""
        pads = self.platform.request(name)
        return Cat(pads, Constant(0, bits - len(pads))) if len(pads) < bits else pads

    def _outputs(self, name, bits):
        """Returns a signal of `bits` bits that drives the output pins `name`; bits without a pin on the board have no effect."""
        pads = self.platform.request(name)
        if len(pads) == bits:
            return pads
        driven = Signal(bits)
        self.comb += pads.eq(driven)
        return driven

    def add_dram(self, phy, module):
        """Adds the controller of the memory `module` over the board's PHY, then the blocks that access memory."""
        self.sdram = MemoryController(phy, module, self.sys_clk_freq)
        # The BIOS does not read back these registers of each phase.
        for injector in (getattr(self.sdram.dfii, f"pi{phase}") for phase in range(phy.settings.nphases)):
            for name in ("_command", "_address", "_baddress", "_wrdata"):
                setattr(injector, name, without_reading(getattr(injector, name)))
        size = module.nbanks * module.nrows * module.ncols * phy.settings.databits // 8
        main_ram = SoCRegion(origin=self.mem_map["main_ram"], size=size, mode="rwx")
        bus = wishbone.Interface(data_width=32, address_width=32, addressing="word")
        # LiteDRAM inserts a width converter between a port and a narrower memory.
        width = self.sdram.crossbar.controller.data_width
        port = self.sdram.crossbar.get_port("both", max(width, bus.data_width))
        self.identity.add_main_ram(size)
        self.memory_bridge = MemoryBridge(bus, port, main_ram.origin, early=width < bus.data_width)
        self.bus.add_slave("main_ram", bus, main_ram)
        if "scanout" in self.blocks:
            self.scanout = Scanout(self.platform, self._port("read"), self.mode)
        if "triangle" in self.blocks:
            readers, writers = memory_ports(self._port, main_ram, self.draws_triangles, self.texture, self.draws_lines, self.geometry)
            self.triangle = TriangleEngine(self.platform, readers, writers, main_ram, self.mode.sizes,
                                           self.draws_triangles, self.smooth, self.texture, self.sky, self.fog, self.antialiasing,
                                           "raymarch" in self.blocks, self.draws_lines, self.geometry, self.depths)
        if "raymarch" in self.blocks:
            self.raymarch = Raymarcher(self.platform, self.fields, self.triangle)

    def _port(self, mode):
        """Returns a memory port of 128 bits for an accelerator; `mode` is `"read"` or `"write"`."""
        return self.sdram.crossbar.get_port(mode, _PORT_BITS)

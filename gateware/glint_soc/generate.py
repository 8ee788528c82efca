"""Generates a core without a processor from a short description: `glint_gen core.yml --output FOLDER`.

The folder contains NAME.sv with all modules, csr.json and csr.h with the addresses of the registers, NAME.core for FuseSoC, and a test
bench: testbench.cpp for Verilator, and stimulus.txt. With `--simulate` the test bench is built and run. docs/integrate.md describes the
keys of the description, and gateware/examples has examples.
"""

import argparse
import logging
import re
import sys
from pathlib import Path

import yaml
from jinja2 import Environment, PackageLoader, StrictUndefined
from litedram.common import LiteDRAMNativePort
from litex.build.generic_platform import GenericPlatform, Pins, Subsignal
from litex.gen import LiteXModule
from litex.soc.integration.export import get_csr_header, get_csr_json
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCMini
from litex.soc.interconnect import wishbone
from litex.soc.interconnect.axi import AXILiteInterface
from migen import ClockDomain, log2_int

from . import vectors
from .axi_ports import AxiPorts
from .gesture import IDENT as GESTURE, GestureEngine
from .i2c import I2CMaster
from .raymarch import Raymarcher, build
from .register_map import CSR_MAP, CSR_PAGING
from .scanout import VIDEO_LAYOUT, Scanout
from .simulate import simulate
from .triangle import TriangleEngine, memory_ports
from .video import CEA_640X480, CEA_1280X720
from .wishbone_ports import WishbonePorts

_WIRES = [(f"{wire}_{way}", 1) for wire in ("scl", "sda") for way in ("out", "in")]

_PINS = {
    "i2c": _WIRES,
    "gesture": [*((name, 1) for name in ("pclk", "href", "vsync", "xclk", "reset_n", "power_down")), ("d", 8), *_WIRES],
}
"""Pins of the blocks that control an external device. The wires of I2C are open drain: an output of 0 pulls the wire low, and an input is
its state."""

MODES = {"1280x720": CEA_1280X720, "640x480": CEA_640X480}
"""Video modes of the scan-out."""

_KEYS = {
    "name": "glint",
    "clock": 100.0,
    "registers": "axi-lite",
    "memory": {"bus": "axi", "origin": 0x4000_0000, "size": 128 << 20},
    "blocks": {},
}
_BLOCKS = {
    "scanout": {"mode": "1280x720"},
    "triangle": dict.fromkeys(("smooth", "texture", "sky", "fog", "antialiasing", "lines"), False),
    "raymarch": {"fields": "faces"},
    "gesture": {"moments": False},
    "i2c": {},
}
_CHOICES = {"registers": ("axi-lite", "wishbone"), "bus": ("axi", "wishbone"), "mode": tuple(MODES)}


def description(given):
    """Returns the complete description of a core, with the defaults for missing keys."""
    core = _complete("the description", given, _KEYS)
    core["memory"] = _complete("memory", core["memory"], _KEYS["memory"])
    unknown = set(core["blocks"]) - set(_BLOCKS)
    if unknown or not core["blocks"]:
        raise ValueError(f"blocks {sorted(unknown)}: expected some of {', '.join(_BLOCKS)}")
    core["blocks"] = {name: _complete(name, core["blocks"][name] or {}, _BLOCKS[name]) for name in _BLOCKS if name in core["blocks"]}
    if "raymarch" in core["blocks"] and "triangle" not in core["blocks"]:
        raise ValueError("raymarch: expected the block triangle too, which draws the raymarcher's pixels")
    if (triangle := core["blocks"].get("triangle", {})).get("smooth") and triangle["texture"]:
        raise ValueError("textures: expected no smooth shading, because the engine has one shader for groups")
    if not re.fullmatch(r"[a-z]\w*", str(core["name"])):
        raise ValueError(f"name {core['name']!r}: expected small letters, digits and underscores")
    size, origin = core["memory"]["size"], core["memory"]["origin"]
    if size not in (1 << bits for bits in range(21, 28)) or origin % size:
        raise ValueError(f"memory of {size} bytes at {origin:#x}: expected a power of two from 2 MiB to 128 MiB, and an origin that is a "
                         "multiple of the size")
    return core


def _complete(what, given, defaults):
    if not isinstance(given, dict) or set(given) - set(defaults):
        raise ValueError(f"{what}: expected some of the keys {', '.join(defaults)}, got {given!r}")
    for key, value in given.items():
        if key in _CHOICES and value not in _CHOICES[key]:
            raise ValueError(f"{key} {value!r}: expected one of {', '.join(_CHOICES[key])}")
        if not isinstance(value, type(defaults[key])) and not (isinstance(value, int) and isinstance(defaults[key], float)):
            raise ValueError(f"{key} {value!r} of {what}: expected a {type(defaults[key]).__name__}")
    return {**defaults, **given}


class _Platform(GenericPlatform):
    """Platform of a core, whose ports have no pins of an FPGA."""

    def __init__(self, name):
        GenericPlatform.__init__(self, device="", io=[("clk", 0, Pins(1)), ("rst", 0, Pins(1))], name=name)

    def add(self, ports):
        """Adds ports and returns their signals."""
        self.add_extension(ports)
        return self.request(ports[0][0])


class Clocks(LiteXModule):
    """Clock domains, each given by its name, its clock and its reset."""

    def __init__(self, *domains):
        for name, clk, rst in domains:
            domain = ClockDomain(name)
            setattr(self, f"cd_{name}", domain)
            self.comb += [domain.clk.eq(clk), domain.rst.eq(rst)]


class Core(SoCMini):
    """The registers and the memory port of some engines, from a description as `description` returns it.

    The ports are `clk` and `rst` of the domain `sys`, `registers_*`, an interrupt of each block, and `memory_*` for blocks that use memory;
    with the scan-out also `pix_clk`, `pix_rst` and `video_*`, and the pins of other blocks' devices. The registers of a block have the same
    window as in Glint's own SoC.
    """

    mem_map = {"csr": 0}
    csr_map = {name: CSR_MAP[name] for name in _BLOCKS} | {"memory": 16}

    def __init__(self, core):
        platform = _Platform(core["name"])
        clocks = [("sys", platform.request("clk"), platform.request("rst"))]
        if "scanout" in core["blocks"]:
            clocks.append(("pix", *(platform.add([(f"pix_{name}", 0, Pins(1))]) for name in ("clk", "rst"))))
        self.crg = Clocks(*clocks)
        SoCMini.__init__(self, platform, core["clock"] * 1e6, bus_standard=core["registers"], csr_paging=CSR_PAGING, with_ctrl=False,
                         bus_timeout=None)
        registers = AXILiteInterface(32, 32) if core["registers"] == "axi-lite" else \
            wishbone.Interface(data_width=32, address_width=32, addressing="word")
        self.comb += registers.connect_to_pads(platform.add(registers.get_ios("registers")), mode="slave")
        self.bus.add_master("registers", registers)

        region = SoCRegion(origin=core["memory"]["origin"], size=core["memory"]["size"])
        ports = []

        def port(mode):
            ports.append(LiteDRAMNativePort(mode, log2_int(region.size // 16), 128))
            return ports[-1]

        blocks = core["blocks"]
        if "scanout" in blocks:
            mode = MODES[blocks["scanout"]["mode"]]
            self.scanout = Scanout(platform, port("read"), mode)
            video = platform.add([("video", 0, *(Subsignal(name, Pins(bits)) for name, bits in VIDEO_LAYOUT))])
            self.comb += [getattr(video, name).eq(getattr(self.scanout.video, name)) for name, _ in VIDEO_LAYOUT]
        if "triangle" in blocks:
            options = dict(blocks["triangle"])
            readers, writers = memory_ports(port, region, texture=options["texture"], lines=options["lines"])
            sizes = MODES[blocks["scanout"]["mode"]].sizes if "scanout" in blocks else CEA_1280X720.sizes
        if ports:
            is_axi = core["memory"]["bus"] == "axi"
            self.memory = (AxiPorts if is_axi else WishbonePorts)(ports, region.origin)
            bus = self.memory.axi if is_axi else self.memory.bus
            self.comb += bus.connect_to_pads(platform.add(bus.get_ios("memory")), mode="master")
        if "triangle" in blocks:
            written = self.memory.pending
            self.triangle = TriangleEngine(
                platform, readers, writers, region, sizes, smooth=options["smooth"], texture=options["texture"], has_sky=options["sky"],
                has_fog=options["fog"], averages=options["antialiasing"], lines=options["lines"], fields="raymarch" in blocks,
                pending=(written[0:2] != 0, written[2:4] != 0))
        if "raymarch" in blocks:
            self.raymarch = Raymarcher(platform, build(blocks["raymarch"]["fields"]), self.triangle)
        pins = {name: platform.add([(name, 0, *(Subsignal(pin, Pins(bits)) for pin, bits in _PINS[name]))]) for name in _PINS if name in blocks}
        if "gesture" in blocks:
            self.gesture = GestureEngine(platform, pins["gesture"], self.sys_clk_freq, **blocks["gesture"])
        if "i2c" in blocks:
            self.i2c = I2CMaster(platform, pins["i2c"], self.sys_clk_freq)
        for name in blocks:
            self.comb += platform.add([(f"{name}_irq", 0, Pins(1))]).eq(getattr(self, name).ev.irq)


def verilog(soc, name, **options):
    """Returns the files of a finalized SoC by name: NAME.sv with all modules, of which `name` is the top module, and initial contents of
    memories."""
    soc.platform.finalize(soc)
    design = soc.platform.get_verilog(soc, name=name, **options)
    sources = dict.fromkeys(path for path, *_ in soc.platform.sources)
    text = "\n".join([*(Path(path).read_text() for path in sources), _without_time(design.main_source)])
    return {f"{name}.sv": text, **design.data_files}


def _without_time(text):
    """Returns a text of LiteX without the lines with the build time, so that equal descriptions give equal files, and without its time
    scale, which the other modules do not have."""
    return re.sub(r"^(// ?(Date |.*Auto-[Gg]enerated by )|`timescale ).*\n", "", text, flags=re.M)


def generate(core, folder):
    """Writes the core of a complete description to `folder`. Returns the names of the written files."""
    soc = Core(core)
    soc.finalize()
    video = MODES[core["blocks"]["scanout"]["mode"]] if "scanout" in core["blocks"] else None
    if not hasattr(soc, "memory"):
        core = core | {"memory": {**core["memory"], "bus": "none"}}
    return write(soc, verilog(soc, core["name"]), core, video, folder)


def write(soc, design, core, video, folder):
    """Writes a SoC with the files `design` to `folder`, with its exports and its test bench. Returns the names of the written files.

    `core` is a description, or the part of a description that the test bench needs. A memory with the bus `host` is reached through the bus
    of the registers.
    """
    registers, origin = vectors.registers(soc), core["memory"]["origin"]
    stimulus = []
    if core["blocks"].get("raymarch") == {"fields": "faces"}:
        stimulus += vectors.resolved(vectors.SPONGE.read_text(), registers, origin)
    if "triangle" in core["blocks"]:
        stimulus += vectors.resolved(vectors.CUBE.read_text(), registers, origin)
    if video:
        stimulus += vectors.resolved(vectors.shown_frame(video, "triangle" in core["blocks"]), registers, origin)
    # Blocks without a picture: checks only that the block responds.
    answers = {"gesture": f"expect gesture_ident ffffffff {GESTURE:x}", "i2c": "expect i2c_status 8 0"}
    stimulus += [line for name, text in answers.items() if name in core["blocks"] for line in vectors.resolved(text, registers, origin)]
    if core["memory"]["bus"] in ("axi", "wishbone"):
        # Stops the scan-out first, because its reads could add errors.
        stop = ["write scanout_control 0", "wait scanout_status 3"] if video else []
        stimulus += vectors.resolved("\n".join([*stop, "errors memory_errors"]), registers, origin)
    files = {
        **design,
        "csr.json": get_csr_json(soc.csr_regions, soc.constants, soc.mem_regions),
        # Without LiteX's headers, software has only the addresses and fields.
        "csr.h": _without_time(get_csr_header(soc.csr_regions, soc.constants, with_access_functions=core["memory"]["bus"] == "host")),
        f"{core['name']}.core": _template("core.core.jinja", core=core),
        "testbench.cpp": _template("testbench.cpp.jinja", core=core, video=video),
        "stimulus.txt": "\n".join(stimulus) + "\n",
    }
    folder.mkdir(parents=True, exist_ok=True)
    for file, content in files.items():
        (folder / file).write_text(content)
    return list(files)


def _template(name, **values):
    environment = Environment(loader=PackageLoader("glint_soc"), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
                              keep_trailing_newline=True)
    return environment.get_template(name).render(**values)


def main():
    """Parses the command line, and generates the core."""
    parser = argparse.ArgumentParser(prog="glint_gen", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("description", type=Path, help="the description of the core, YAML")
    parser.add_argument("--output", type=Path, help="folder to write to (default: the name of the core)")
    parser.add_argument("--simulate", action="store_true", help="build the test bench with Verilator, and run it")
    arguments = parser.parse_args()
    logging.disable(logging.INFO) # LiteX logs each step
    try:
        core = description(yaml.safe_load(arguments.description.read_text()))
        folder = arguments.output or Path(core["name"])
        for file in generate(core, folder):
            print(folder / file)
    except (ValueError, yaml.YAMLError, OSError) as error:
        parser.error(f"{arguments.description}: {error}")
    return simulate(folder, core["name"]) if arguments.simulate else 0


if __name__ == "__main__":
    sys.exit(main())

"""Checks of the ULX3S's generated files against facts recorded independently of the platform file."""

import json
import random
import re
from collections import Counter

from litex.soc.integration.builder import Builder
from migen import Signal, run_simulation

from ecp5.netlist import Netlist
from glint_soc.ecp5_hdmi import Serializer
from glint_soc.ulx3s import Ulx3sSoC

import boards
from tools import BUILD, TESTS, run_yosys

_OUTPUT = BUILD / "ulx3s"
_GATEWARE = _OUTPUT / "gateware"
_PINS = TESTS / "ulx3s_pins.csv"
_TOP = "glint_ulx3s"

# Clocks that the FPGA's PLLs must generate exactly: frequency in MHz and phase in degrees.
_CLOCKS = Counter({(40.0, 0.0): 1, (40.0, 90.0): 1, (25.2, 0.0): 1, (126.0, 0.0): 1})

# Limits of a PLL in MHz: its phase detector, its VCO, its outputs.
_DETECTOR, _VCO, _OUTPUTS = (10, 400), (400, 800), (3.125, 400)

# Capability bits: the sizes 320x180 and 640x360, and the scales 1 and 2.
_CAPABILITIES = {"SIZES": 0b011, "MEMORY_BITS": 21, "H_ACTIVE": 640, "V_ACTIVE": 360, "V_BORDER": 60}

# Values of the board's identity registers, in Hz and bytes.
_IDENTITY = {"clock": 40_000_000, "main_ram": 32 << 20}


def generate():
    """Elaborates the board (no BIOS, no synthesis) and returns its constraints, Verilog and Yosys script as text."""
    soc = Ulx3sSoC(build_id=0, blocks=Ulx3sSoC.possible_blocks)
    Builder(soc, output_dir=str(_OUTPUT), compile_software=False, compile_gateware=False).build()
    return tuple((_GATEWARE / f"{_TOP}.{kind}").read_text() for kind in ("lpf", "v", "ys"))


def check_pins(lpf, verilog, _script):
    """Checks that the ports of the design have exactly the pins and properties of ulx3s_pins.csv, and no pin is used twice."""
    found = {port: {"LOC": pin} for port, pin in re.findall(r'^LOCATE COMP "(\S+)" SITE "(\w+)";$', lpf, re.M)}
    for port, key, value in re.findall(r'^IOBUF PORT "(\S+)" (\w+)=(\w+);$', lpf, re.M):
        found.setdefault(port, {})["IOSTANDARD" if key == "IO_TYPE" else key] = value
    return boards.check_pins(found, _PINS, boards.ports(verilog, _TOP))


def check_constraints(lpf, verilog, script):
    """Checks the constraint of the input clock, the sources of the script, and the limits imposed by video and memory."""
    problems = [f"not in the constraints: {line}" for line in ('FREQUENCY PORT "clk25" 25.0 MHz;', "BLOCK ASYNCPATHS;")
                if line not in lpf.splitlines()]
    problems += [f"not in the Yosys script: {word}" for word in ("scanout.sv", "VexRiscv_Full.v", f"{_TOP}.v") if word not in script]
    for name, value in _CAPABILITIES.items():
        found = re.findall(rf"\.{name}\s+\(\d+'d(\d+)\)", verilog)
        if found != [str(value)]:
            problems.append(f"{name}: expected {value} once, got {found}")
    return problems


def check_identity(*_files):
    """Checks the clock frequency and the memory size in the board's identity registers."""
    identity = Ulx3sSoC(build_id=0, blocks=Ulx3sSoC.possible_blocks).identity
    stated = {name: getattr(identity, name).status.reset.value for name in _IDENTITY}
    return [] if stated == _IDENTITY else [f"expected {_IDENTITY}, got {stated}"]


def check_clocks(_lpf, verilog, _script):
    """Checks that the parameters of the PLLs give exactly the intended frequencies, within the PLLs' limits."""
    problems, found = [], Counter()
    for asked, text in re.findall(r'FREQUENCY_PIN_CLKI = "([\d.]+)".*?^EHXPLLL #\((.*?)^\) ', verilog, re.M | re.S):
        numbers = {name: int(value) for name, value in re.findall(r"\.(\w+)\s+\(\d+'d(\d+)\)", text)}
        (feedback,) = re.findall(r'FEEDBK_PATH\s+\("INT_O(\w+)"\)', text)
        detector = float(asked) / numbers["CLKI_DIV"]
        vco = detector * numbers["CLKFB_DIV"] * numbers[f"CLKO{feedback}_DIV"]
        outputs = {name: vco / divide for name, divide in numbers.items() if re.fullmatch(r"CLKO\w+_DIV", name)}
        problems += [f"a PLL has {value} MHz, outside {low} to {high}"
                     for (low, high), values in ((_DETECTOR, [detector]), (_VCO, [vco]), (_OUTPUTS, outputs.values()))
                     for value in values if not low <= value <= high]
        for name, frequency in outputs.items():
            output = name.removesuffix("_DIV")
            if output != f"CLKO{feedback}":
                # The phase is in eighths of a VCO cycle; phase 0 is the value one less than the divider.
                eighths = 8 * (numbers[f"{output}_CPHASE"] + 1 - numbers[name]) + numbers[f"{output}_FPHASE"]
                found[frequency, 45.0 * eighths / numbers[name]] += 1
    if found != _CLOCKS:
        problems.append(f"expected the clocks (MHz, phase) {sorted(_CLOCKS)}, got {sorted(found.elements())}")
    return problems


def check_complete(_lpf, _verilog, script):
    """Checks that each instantiated module exists, including the FPGA's primitives, and has the connected ports."""
    sources = re.findall(r"^read_verilog (?:.* )?(\S+)$", script, re.M)
    run_yosys(f"read_verilog -lib +/lattice/cells_sim_ecp5.v +/lattice/cells_bb_ecp5.v; hierarchy -check -top {_TOP}",
              sources, folder=_GATEWARE) # where its memory images are
    return []


def check_serializer(_lpf, _verilog, _script):
    """Checks that the serializer sends each word completely, in order, with the lowest bit first, at any offset of the clocks."""
    problems = []
    for offset in range(5):
        rng = random.Random(offset)
        words = [rng.getrandbits(10) for _ in range(50)]
        word = Signal(10)
        serializer, sent = Serializer([word]), []

        def send():
            for value in words:
                yield word.eq(value)
                yield

        def watch():
            for _ in range(5 * len(words)):
                pair = yield serializer.pairs[0]
                sent.extend([pair & 1, pair >> 1])
                yield

        run_simulation(serializer, {"pix": [send()], "pix5x": [watch()]}, clocks={"pix": (50, 5 + 10 * offset), "pix5x": (10, 5)})
        bits = "".join(map(str, sent))
        expected = "".join(f"{value:010b}"[::-1] for value in words[2:40])
        if expected not in bits:
            problems.append(f"offset {offset}: the words were not sent in order")
    return problems


def check_netlist(*_files):
    """Checks that a LUT reads the reset from the input of the reset's global buffer, and that no other cell changes."""
    def cell(kind, **ports):
        directions = {port: "output" if port in ("CLKO", "Z") else "input" for port in ports}
        return {"type": kind, "port_directions": directions, "connections": ports}

    cells = {"buffer": cell("DCCA", CLKI=[2], CLKO=[3]), "clock": cell("DCCA", CLKI=[5], CLKO=[6]),
             "flip_flop": cell("TRELLIS_FF", CLK=[6], LSR=[3], DI=[4]), "lut": cell("LUT4", A=[3], B=[6], Z=[4])}
    modules = {"LUT4": {"attributes": {}, "cells": {}}, "top": {"attributes": {"top": 1}, "cells": cells}}
    path = _GATEWARE / "netlist.json"
    path.write_text(json.dumps({"modules": modules}))
    netlist = Netlist(path)
    netlist.take_logic_off_resets()
    netlist.write(path)
    cells["lut"]["connections"]["A"] = [2]
    found = json.loads(path.read_text())["modules"]
    return [] if found == modules else [f"expected {modules}, got {found}"]


CHECKS = {
    "pins as in the table, both ways": check_pins,
    "constraints, script and capabilities": check_constraints,
    "identity": check_identity,
    "clocks exact": check_clocks,
    "serializer": check_serializer,
    "netlist": check_netlist,
    "design complete": check_complete,
}

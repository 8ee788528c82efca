"""Checks of the ULX3S's generated files against facts recorded independently of the platform file."""

import json
import random
import re
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import pytest
from litex.soc.integration.builder import Builder
from migen import Signal

from ecp5.netlist import Netlist
from glint_soc.ecp5_hdmi import Serializer
from glint_soc.ulx3s import Ulx3sSoC

import boards
from resources.tools import BUILD, run_yosys
from simulation import run_simulation

_OUTPUT = BUILD / "ulx3s"
_GATEWARE = _OUTPUT / "gateware"
_PINS = Path(__file__).with_name("ulx3s_pins.csv")
_TOP = "glint_ulx3s"

pytestmark = pytest.mark.xdist_group("ulx3s")

# Clocks that the FPGA's PLLs must generate exactly: frequency in MHz and phase in degrees.
_CLOCKS = Counter({(40.0, 0.0): 1, (40.0, 90.0): 1, (25.2, 0.0): 1, (126.0, 0.0): 1})

# Limits of a PLL in MHz: its phase detector, its VCO, its outputs.
_DETECTOR, _VCO, _OUTPUTS = (10, 400), (400, 800), (3.125, 400)

# Capability bits: the sizes 320x180 and 640x360, and the scales 1 and 2.
_CAPABILITIES = {"SIZES": 0b011, "MEMORY_BITS": 21, "H_ACTIVE": 640, "V_ACTIVE": 360, "V_BORDER": 60}

# Values of the board's identity registers, in Hz and bytes.
_IDENTITY = {"clock": 40_000_000, "main_ram": 32 << 20}


@pytest.fixture(scope="module", name="board")
def _board():
    """The board elaborated (no BIOS, no synthesis): its constraints, Verilog and Yosys script as text."""
    soc = Ulx3sSoC(build_id=0, blocks=Ulx3sSoC.possible_blocks)
    Builder(soc, output_dir=str(_OUTPUT), compile_software=False, compile_gateware=False).build()
    return SimpleNamespace(soc=soc, **{kind: (_GATEWARE / f"{_TOP}.{kind}").read_text() for kind in ("lpf", "v", "ys")})


def test_pins(board):
    """Checks that the ports of the design have exactly the pins and properties of ulx3s_pins.csv, and no pin is used twice."""
    found = {port: {"LOC": pin} for port, pin in re.findall(r'^LOCATE COMP "(\S+)" SITE "(\w+)";$', board.lpf, re.M)}
    for port, key, value in re.findall(r'^IOBUF PORT "(\S+)" (\w+)=(\w+);$', board.lpf, re.M):
        found.setdefault(port, {})["IOSTANDARD" if key == "IO_TYPE" else key] = value
    boards.check_pins(found, _PINS, boards.ports(board.v, _TOP))


def test_constraints(board):
    """Checks the constraint of the input clock, the sources of the script, and the limits imposed by video and memory."""
    assert {'FREQUENCY PORT "clk25" 25.0 MHz;', "BLOCK ASYNCPATHS;"} <= set(board.lpf.splitlines())
    assert [word for word in ("scanout.sv", "VexRiscv_Full.v", f"{_TOP}.v") if word not in board.ys] == []
    found = {name: re.findall(rf"\.{name}\s+\(\d+'d(\d+)\)", board.v) for name in _CAPABILITIES}
    assert found == {name: [str(value)] for name, value in _CAPABILITIES.items()}


def test_identity(board):
    """Checks the clock frequency and the memory size in the board's identity registers."""
    assert {name: getattr(board.soc.identity, name).status.reset.value for name in _IDENTITY} == _IDENTITY


def test_clocks(board):
    """Checks that the parameters of the PLLs give exactly the intended frequencies, within the PLLs' limits."""
    found = Counter()
    for asked, text in re.findall(r'FREQUENCY_PIN_CLKI = "([\d.]+)".*?^EHXPLLL #\((.*?)^\) ', board.v, re.M | re.S):
        numbers = {name: int(value) for name, value in re.findall(r"\.(\w+)\s+\(\d+'d(\d+)\)", text)}
        (feedback,) = re.findall(r'FEEDBK_PATH\s+\("INT_O(\w+)"\)', text)
        detector = float(asked) / numbers["CLKI_DIV"]
        vco = detector * numbers["CLKFB_DIV"] * numbers[f"CLKO{feedback}_DIV"]
        outputs = {name: vco / divide for name, divide in numbers.items() if re.fullmatch(r"CLKO\w+_DIV", name)}
        for (low, high), values in ((_DETECTOR, [detector]), (_VCO, [vco]), (_OUTPUTS, outputs.values())):
            assert low <= min(values) <= max(values) <= high, "MHz of a PLL"
        for name, frequency in outputs.items():
            output = name.removesuffix("_DIV")
            if output != f"CLKO{feedback}":
                # The phase is in eighths of a VCO cycle; phase 0 is the value one less than the divider.
                eighths = 8 * (numbers[f"{output}_CPHASE"] + 1 - numbers[name]) + numbers[f"{output}_FPHASE"]
                found[frequency, 45.0 * eighths / numbers[name]] += 1
    assert found == _CLOCKS


def test_complete(board):
    """Checks that each instantiated module exists, including the FPGA's primitives, and has the connected ports."""
    sources = re.findall(r"^read_verilog (?:.* )?(\S+)$", board.ys, re.M)
    run_yosys(f"read_verilog -lib +/lattice/cells_sim_ecp5.v +/lattice/cells_bb_ecp5.v; hierarchy -check -top {_TOP}",
              sources, folder=_GATEWARE) # the folder with the memory images


@pytest.mark.parametrize("offset", range(5))
def test_serializer(offset):
    """Checks that the serializer sends each word completely, in order, with the lowest bit first, at any offset of the clocks."""
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
    assert "".join(f"{value:010b}"[::-1] for value in words[2:40]) in "".join(map(str, sent))


def test_netlist(tmp_path):
    """Checks that a LUT reads the reset from the input of the reset's global buffer, and that no other cell changes."""
    def cell(kind, **ports):
        directions = {port: "output" if port in ("CLKO", "Z") else "input" for port in ports}
        return {"type": kind, "port_directions": directions, "connections": ports}

    cells = {"buffer": cell("DCCA", CLKI=[2], CLKO=[3]), "clock": cell("DCCA", CLKI=[5], CLKO=[6]),
             "flip_flop": cell("TRELLIS_FF", CLK=[6], LSR=[3], DI=[4]), "lut": cell("LUT4", A=[3], B=[6], Z=[4])}
    modules = {"LUT4": {"attributes": {}, "cells": {}}, "top": {"attributes": {"top": 1}, "cells": cells}}
    path = tmp_path / "netlist.json"
    path.write_text(json.dumps({"modules": modules}))
    netlist = Netlist(path)
    netlist.take_logic_off_resets()
    netlist.write(path)
    cells["lut"]["connections"]["A"] = [2]
    assert json.loads(path.read_text())["modules"] == modules

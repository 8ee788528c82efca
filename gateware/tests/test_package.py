"""Tests of the installed package: cores without LiteX, and the engines in ordinary LiteX SoCs, generated from an installation and
simulated. Pictures equal those of the model."""

import fcntl
import json
import os
import random
import re
import shutil
import subprocess
import sys

import pytest
import yaml
from litedram.common import LiteDRAMNativePort
from migen import passive

from glint_soc import generate, packages, vectors
from glint_soc.axi_ports import AxiPorts
from resources.tools import run_yosys
from simulation import run_simulation
from verilate.programs import GATEWARE, digest, files_below, is_current, run_verilator

_EXAMPLES = GATEWARE / "examples"
_FOLDER = GATEWARE.parent / "target" / "gateware" / "package"
_INSTALLED = _FOLDER / "installed"

# Needed only by the example of the Arty A7; requirements.txt pins the other packages.
_BOARDS = ["litex-boards==2023.12", "liteeth==2024.12"]


@pytest.fixture(scope="module")
def installed():
    """Installs the package and the boards of LiteX to a folder, unless they are up to date. Returns the environment of programs that use
    them. Several processes of a test run may install them, one after the other."""
    _FOLDER.parent.mkdir(parents=True, exist_ok=True)
    with open(_FOLDER.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        _install()
    return os.environ | {"PYTHONPATH": str(_INSTALLED)}


def _install():
    sources = [GATEWARE / "glint_soc", GATEWARE / "rtl", GATEWARE / "pyproject.toml"]
    stamp, inputs = _FOLDER / "inputs", digest(files_below(*sources), _BOARDS)
    if not is_current(stamp, inputs, _INSTALLED):
        shutil.rmtree(_FOLDER, ignore_errors=True)
        # The build leaves files in the folder of the sources.
        for source in sources:
            copy = _FOLDER / "sources" / source.name
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copytree(source, copy, ignore=shutil.ignore_patterns("__pycache__")) if source.is_dir() else shutil.copy(source, copy)
        _run(sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--target", _INSTALLED,
             _FOLDER / "sources", *_BOARDS)
        stamp.write_text(inputs)


def _run(*command, environment=None):
    """Runs a program, in a folder from which Python imports nothing, and returns its output."""
    done = subprocess.run([str(word) for word in command], cwd=_FOLDER, env=environment, check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert done.returncode == 0, done.stdout
    return done.stdout


@pytest.mark.parametrize(("name", "equal"), [
    ("scanout", ["a frame of 1280 x 720 pixels, shown in 1280 x 720"]),
    ("triangle", ["320 x 180 pixels"]),
    ("sensors", []),
    ("triangle_wishbone", ["320 x 180 pixels", "a frame of 320 x 180 pixels, shown in 640 x 360"]),
])
def test_core(installed, name, equal):
    """Draws and shows pictures with a generated core whose memory stalls at random, and answers some accesses with errors."""
    program = _INSTALLED / "bin" / "glint_gen"
    output = _run(sys.executable, program, _EXAMPLES / f"{name}.yml", "--output", _FOLDER / name, "--simulate",
                  environment=installed)
    found = [line.removeprefix("equal: ") for line in output.splitlines() if line.startswith("equal: ")]
    assert found[:len(equal)] == equal
    # Cores whose blocks do not use memory report no errors of memory.
    assert [int(line.removesuffix(" errors of memory")) > 10 for line in found[len(equal):]] == [True] * bool(equal)
    assert output.endswith("passed\n")


def test_litex_soc(installed):
    """Draws two pictures and shows one, with the engines in a SoC of LiteX's and LiteDRAM's own classes."""
    output = _run(sys.executable, _EXAMPLES / "litex_sim.py", _FOLDER / "litex_sim", environment=installed)
    assert output.count("equal: 320 x 180 pixels\n") == 2
    assert "equal: a frame of 320 x 180 pixels, shown in 320 x 180\n" in output
    assert output.endswith("passed\n")


def test_litex_program(installed):
    """Draws a picture with a C program on the processor of a LiteX SoC; an interrupt reports the end of a pass to the program."""
    output = _run(sys.executable, _EXAMPLES / "litex_cpu.py", _FOLDER / "litex_cpu", environment=installed)
    assert "equal: 320 x 180 pixels\n" in output
    assert output.endswith("passed\n")


_ELABORATION = r"""
import logging, sys
logging.disable(logging.INFO)
sys.path.insert(0, sys.argv[1])
import arty
soc = arty.GlintSoC(sys.argv[2] == "raymarch")
soc.finalize()
soc.platform.finalize(soc)
text = soc.platform.get_verilog(soc, name="arty").main_source
print(*(name for name in ("scanout", "triangle_engine", "raymarcher") if f"\n{name} " in text))
print(*soc.irq.locs)
"""


@pytest.mark.parametrize(("engines", "modules", "interrupts"), [
    ("triangle", "scanout triangle_engine", "uart timer0 scanout triangle"),
    ("raymarch", "scanout triangle_engine raymarcher", "uart timer0 scanout triangle raymarch"),
])
def test_arty(installed, engines, modules, interrupts):
    """Writes the Verilog of the example on the Arty A7, with the SoC of litex-boards."""
    output = _run(sys.executable, "-c", _ELABORATION, _EXAMPLES, engines, environment=installed)
    assert output.splitlines()[-2:] == [modules, interrupts]


def test_registers(tmp_path):
    """Checks that the registers of a core have the same addresses as in Glint's own SoC, so that its drivers work, and that the exports
    contain these addresses."""
    names = ("scanout", "triangle", "raymarch", "gesture", "i2c")
    core, full = generate.description({"blocks": {name: {} for name in names}}), packages.full_soc()
    soc = generate.Core(core)
    soc.finalize()
    generate.write(soc, {}, core, None, tmp_path)
    found, expected = vectors.registers(soc), vectors.registers(full)
    own = {"memory", "memory_errors"}
    base = full.mem_map["csr"]
    assert {name: base + place for name, place in found.items() if name not in own} == {
        name: place for name, place in expected.items() if name in found.keys() - own}
    assert {name for name in expected if name.startswith(names)} == found.keys() - own
    registers = {name: place for name, place in found.items() if name not in ("memory", *names)}
    exported = json.loads((tmp_path / "csr.json").read_text())["csr_registers"]
    assert {name: register["addr"] for name, register in exported.items()} == registers
    header = (tmp_path / "csr.h").read_text()
    base = int(re.search(r"#define CSR_BASE (0x\w+)L", header)[1], 16)
    places = {name.lower(): base + int(offset, 16)
              for name, offset in re.findall(r"#define CSR_(\w+)_ADDR \(CSR_BASE \+ (0x\w+)L\)", header)}
    assert places == registers


@pytest.mark.parametrize("name", ["scanout", "sensors"])
def test_read_by_yosys(tmp_path, name):
    """Checks that Yosys reads a core, and that every bit in its top module has one driver. Cores with larger engines would take too long
    here; Yosys reads the modules of these engines in test_modules.py."""
    core = generate.description(yaml.safe_load((_EXAMPLES / f"{name}.yml").read_text()))
    generate.generate(core, tmp_path)
    top = core["name"]
    run_yosys(f"hierarchy -check -top {top}; proc {top}; check -assert {top}", [tmp_path / f"{top}.sv"], tmp_path)


@pytest.mark.parametrize("rest", [
    "blocks: {scanout: {}, triangle: {smooth: true, lines: true}}",
    "blocks: {triangle: {texture: true, sky: true, fog: true, antialiasing: true}}",
    "memory: {bus: wishbone}, blocks: {scanout: {}}",
])
def test_options(tmp_path, rest):
    """Generates cores with other options, which Verilator reads; equal descriptions give equal files."""
    core = generate.description(yaml.safe_load(f"{{name: core, {rest}}}"))
    for folder in ("first", "second"):
        generate.generate(core, tmp_path / folder)
    assert all((tmp_path / "second" / path.name).read_text() == path.read_text() for path in (tmp_path / "first").iterdir())
    run_verilator("--lint-only", "-Wno-fatal", "-Wno-lint", "--top-module", "core", tmp_path / "first" / "core.sv")


@pytest.mark.parametrize(("text", "expected"), [
    ("{}", "blocks []: expected some of scanout, triangle, raymarch, gesture, i2c"),
    ("blocks: {line: {}}", "blocks ['line']: expected some of scanout, triangle, raymarch, gesture, i2c"),
    ("blocks: {raymarch: {}}", "raymarch: expected the block triangle too"),
    ("{blocks: {triangle: {}}, speed: 3}", "the description: expected some of the keys name, clock, registers, memory, blocks"),
    ("{blocks: {triangle: {}}, registers: apb}", "registers 'apb': expected one of axi-lite, wishbone"),
    ("{blocks: {triangle: {smooth: 1}}}", "smooth 1 of triangle: expected a bool"),
    ("{blocks: {triangle: {}}, name: 3d}", "name '3d': expected small letters"),
    ("{blocks: {triangle: {}}, memory: {size: 0x10000000}}", "memory of 268435456 bytes at 0x40000000: expected a power of two"),
    ("{blocks: {triangle: {}}, memory: {origin: 0x41000000}}", "and an origin that is a multiple of the size"),
    ("{blocks: {triangle: {smooth: true, texture: true}}}", "textures: expected no smooth shading"),
])
def test_refusals(text, expected):
    """Checks that mistakes in a description are named."""
    with pytest.raises(ValueError) as refusal:
        generate.description(yaml.safe_load(text))
    assert expected in str(refusal.value)


def test_errors_of_memory():
    """Counts the accesses that an AXI memory answers with an error; all accesses continue, and each port receives its own words."""
    rng = random.Random(3)
    reader, other, writer = (LiteDRAMNativePort(mode, 17, 128) for mode in ("read", "read", "write"))
    dut = AxiPorts([reader, other, writer], 0x4000_0000)
    axi = dut.axi
    asked, found, failed = {0: [], 1: []}, {0: [], 1: []}, []

    def commands(number, port):
        for _ in range(60):
            address = rng.getrandbits(17)
            asked[number].append(address)
            yield port.cmd.addr.eq(address)
            yield port.cmd.valid.eq(1)
            yield
            while not (yield port.cmd.ready):
                yield
            yield port.cmd.valid.eq(0)
            for _ in range(rng.randrange(3)):
                yield
        for _ in range(60):
            yield

    @passive
    def words(number, port):
        while True:
            if (yield port.rdata.valid):
                found[number].append((yield port.rdata.data))
            yield

    @passive
    def memory():
        pending = {0: [], 1: []}
        while True:
            if (yield axi.ar.valid) and (yield axi.ar.ready):
                pending[(yield axi.ar.id)].append((yield axi.ar.addr))
            yield axi.ar.ready.eq(rng.random() < 0.6)
            yield axi.r.valid.eq(0)
            identifiers = [identifier for identifier, queue in pending.items() if queue]
            if identifiers and rng.random() < 0.7:
                identifier = rng.choice(identifiers)
                failed.append(rng.random() < 0.3)
                yield axi.r.valid.eq(1)
                yield axi.r.id.eq(identifier)
                yield axi.r.data.eq(pending[identifier].pop(0))
                yield axi.r.resp.eq(0b10 if failed[-1] else 0)
            yield

    run_simulation(dut, [commands(0, reader), commands(1, other), words(0, reader), words(1, other), memory(), _check_errors(dut, failed)])
    assert found == {number: [0x4000_0000 + 16 * address for address in addresses] for number, addresses in asked.items()}


def _check_errors(dut, failed):
    for _ in range(1500):
        yield
    assert (yield dut._errors.status) == sum(failed) > 0

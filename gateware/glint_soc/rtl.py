"""The SystemVerilog files of a module, found in the folder `gateware/rtl`, or in `glint_soc/sources` of an installed package.

Every module or package has a file of its own name. A module's sources are its file and those of all packages that it names
and modules that it instantiates, recursively. LiteX, Yosys, the Verilator benches and the proofs all use `sources`.
"""

import re
from functools import cache
from pathlib import Path

_INSTALLED = Path(__file__).resolve().parent / "sources"

ROOT = Path(__file__).resolve().parent.parent.parent
RTL = _INSTALLED if _INSTALLED.is_dir() else ROOT / "gateware" / "rtl"
CORE = ROOT / "firmware" / "core" / "src" / "gateware"

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
_DEFINITION = re.compile(r"^\s*(module|package)\s+(\w+)", re.M)
_PACKAGE_USE = re.compile(r"\b(\w+)::")
# Matches the name of a module before its parameters, or before an instance name with ports, but no block label.
_INSTANCE = re.compile(r"(?<!: )\b(\w+)\s+(?:#\s*\(|\w+\s*\()")


@cache
def _library():
    """Returns the path of the file of each module and package, by name."""
    paths = {}
    for path in sorted(RTL.glob("*/*.sv")):
        if _definitions(path) != [path.stem]:
            raise ValueError(f"{path}: expected one module or package, {path.stem}, found {_definitions(path)}")
        if path.stem in paths:
            raise ValueError(f"{path.stem} is defined by {paths[path.stem]} and by {path}")
        paths[path.stem] = path
    return paths


@cache
def _text(path):
    return _COMMENT.sub("", path.read_text())


def _definitions(path):
    return [name for _, name in _DEFINITION.findall(_text(path))]


def sources(*tops, others=()):
    """Returns the files that the modules `tops` need, each after those that it depends on.

    `others` are files outside `gateware/rtl`: further modules, and modules that replace the modules of the same names.
    """
    library = _library() | {name: path for path in others for name in _definitions(path)}
    found = {}

    def visit(name):
        path = library[name]
        if path in found:
            return
        found[path] = None
        text = _text(path)
        uses = {*_PACKAGE_USE.findall(text), *_INSTANCE.findall(text)} & library.keys()
        for use in sorted(uses - {name}):
            visit(use)
        # Moves the file to the end of `found`, after the files that it depends on.
        del found[path]
        found[path] = None

    for top in tops:
        if top not in library:
            raise ValueError(f"no module {top!r} in {RTL}")
        visit(top)
    return list(found)


def add_sources(platform, *tops):
    """Adds the files of modules to a LiteX platform."""
    for path in sources(*tops):
        platform.add_source(str(path))

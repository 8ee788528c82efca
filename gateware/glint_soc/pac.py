"""The register access crate of the firmware and the page docs/registers.md, generated from the SoC with all blocks.

The templates are in the folder `templates`. A block (a `LiteXModule` with registers) may have two attributes in addition to its registers:

* `counters`: its free-running counters in the order of the output: an object whose `registers` are a dictionary by
name, or a list of names;
* `constants`: numbers that software uses, as a dictionary of name to (value, text).
"""

import json
import re
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from .register_map import access, build_id
from .rtl import ROOT

_WORD = 32

_EVENTS = {
    "ev_status": "Level of each event's trigger.",
    "ev_pending": "Events that have occurred; writing a 1 clears an event.",
    "ev_enable": "Events that raise the interrupt.",
}
"""Descriptions of the registers of an event manager, because LiteX's descriptions only describe the last event."""

_KEYWORDS = {"in", "loop", "mod", "type", "use"}
"""Names in the gateware that are keywords of Rust, and therefore cannot be names of functions."""


@dataclass(frozen=True)
class Value:
    """A named value of a field."""

    value: int
    name: str
    text: str


@dataclass(frozen=True)
class Field:
    """A named range of bits in a register. `values` is empty for a field that is a number or a flag."""

    name: str
    lsb: int
    width: int
    description: str
    values: tuple

    def __post_init__(self):
        beyond = [value.name for value in self.values if value.value >> self.width]
        if beyond:
            raise ValueError(f"values {beyond} of the field {self.name!r}: expected numbers of {self.width} bits")


@dataclass(frozen=True)
class Register:
    """A register of one 32-bit word, or of two words, the high word first. `fields` is empty for a plain number."""

    name: str
    offset: int
    width: int
    access: str
    reset: int
    description: str
    fields: tuple

    def __post_init__(self):
        if self.words > 2:
            raise ValueError(f"register {self.name!r} of {self.words} words: expected one or two")

    @property
    def words(self):
        """Number of words of the register."""
        return -(-self.width // _WORD)


@dataclass(frozen=True)
class Enumeration:
    """The named values that some fields share. `places` are these fields, as `register.field`."""

    kind: str
    width: int
    values: tuple
    places: tuple

    @property
    def is_total(self):
        """Whether every number that fits the field is a named value."""
        return len(self.values) == 1 << self.width


@dataclass(frozen=True)
class Peripheral:
    """A block of registers in the CPU's address space. `counters` are registers, `constants` are named numbers."""

    name: str
    base: int
    interrupt: int | None
    registers: tuple
    counters: tuple
    constants: tuple

    def __post_init__(self):
        for register in self.counters:
            if register.width != _WORD or register.fields:
                raise ValueError(f"counter {register.name!r} of {self.name!r}: expected a plain register of {_WORD} bits")

    @property
    def enumerations(self):
        """The enumerations, by the width and the values of their fields. The name of an enumeration consists of the last words
        that the names of its fields have in common."""
        shared = {}
        for register in self.registers:
            for field in register.fields:
                if field.values:
                    shared.setdefault((field.width, field.values), []).append((register, field))
        taken = {"", "Counters", *(camel(name) for name in [self.name, *(register.name for register in self.registers)])}
        found = {}
        for (width, values), members in shared.items():
            kind = camel(common_suffix([field.name for _, field in members]))
            places = tuple(f"{register.name}.{field.name}" for register, field in members)
            if kind in taken:
                raise ValueError(f"values of {', '.join(places)} of {self.name!r} would be the type {kind!r}: expected a name that is not "
                                 "taken")
            taken.add(kind)
            found[width, values] = Enumeration(kind, width, values, places)
        return found


def peripheral(name, block, region, interrupt):
    """Returns the description of `block` with the registers of a LiteX region."""
    registers, offset = {}, 0
    for csr in region.obj:
        registers[csr.name] = register = _register(csr, offset)
        offset += 4 * register.words
    counters = getattr(block, "counters", [])
    counters = list(getattr(counters, "registers", counters))
    unknown = sorted(set(counters) - registers.keys())
    if unknown:
        raise ValueError(f"counters {unknown} of {name!r} are not registers, expected some of {list(registers)}")
    constants = getattr(block, "constants", {}).items()
    return Peripheral(name, region.origin, interrupt, tuple(registers.values()), tuple(registers[counter] for counter in counters),
                      tuple(Value(value, name, text) for name, (value, text) in constants))


def _register(csr, offset):
    fields = csr.fields.fields if hasattr(csr, "fields") else []
    signal = getattr(csr, "storage", getattr(csr, "status", None))
    return Register(
        csr.name, offset, csr.size, access(csr), signal.reset.value if signal is not None else 0,
        _EVENTS.get(csr.name) or _flowed(getattr(csr, "description", None)),
        tuple(Field(field.name, field.offset, field.size, _flowed(field.description), _values(field)) for field in fields))


def _values(field):
    """Returns the named values of `field`. LiteX also allows values without a name, which are documentation only."""
    return tuple(Value(int(entry[0], 0), *entry[1:]) for entry in field.values or [] if len(entry) == 3)


def _flowed(text):
    """Returns a description on one line, with the code quotes of Markdown, and without LiteX's sentence on the trigger of an event,
    which names a falling edge for every event."""
    return " ".join((text or "").split()).replace("``", "`").split(" This Event is triggered")[0]


def camel(name):
    """Returns a name in Rust's form for types: `ev_pending` becomes `EvPending`."""
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def common_suffix(names):
    """Returns the longest sequence of whole words, separated by `_`, in which all names end."""
    words = zip(*(reversed(name.split("_")) for name in names))
    return "_".join(reversed([word for word, *_ in takewhile(lambda same: len(set(same)) == 1, words)]))


def _hex(value):
    return f"{value >> 16:#06x}_{value & 0xffff:04x}" if value >> 16 else f"{value:#x}"


def _documented(text):
    """Escapes a description for rustdoc, which would read brackets outside code as links and tags."""
    parts = text.split("`")
    parts[::2] = [part.translate({ord(bracket): f"\\{bracket}" for bracket in "[]<>"}) for part in parts[::2]]
    return "`".join(parts)


def _sentence(text):
    text = text.rstrip(".")
    return f"{text[:1].upper()}{text[1:]}."


def _integer(width):
    """Returns the smallest Rust type that holds `width` bits."""
    return next(kind for most, kind in [(1, "bool"), (8, "u8"), (16, "u16"), (64, "u32")] if width <= most)


def files(soc):
    """Returns the texts of the generated files of a finalized SoC, by path."""
    peripherals = [peripheral(name, getattr(soc, name, None), region, soc.irq.locs.get(name)) for name, region in soc.csr.regions.items()]
    # The interrupt numbers are part of the peripherals instead, and the settings of the BIOS's memory test differ between boards.
    constants = {name.lower(): value for name, value in soc.constants.items()
                 if isinstance(value, int) and name != "BUILD_ID" and not re.match("MEMTEST_|.*_INTERRUPT$", name)}
    contents = {
        "build_id": build_id(soc),
        "constants": sorted(constants.items()),
        "interrupts": sorted((one.interrupt, one.name) for one in peripherals if one.interrupt is not None),
        "memories": sorted((region.origin, name, region.size) for name, region in soc.mem_regions.items() if name != "csr"),
        "peripherals": sorted(peripherals, key=lambda one: one.base),
    }
    templates = Environment(loader=FileSystemLoader(Path(__file__).parent / "templates"), undefined=StrictUndefined, trim_blocks=True,
                            lstrip_blocks=True, keep_trailing_newline=True)
    templates.filters.update(
        camel=camel, hex=_hex, decimal="{:_}".format, doc=_documented, sentence=_sentence, integer=_integer, quoted=json.dumps,
        identifier=lambda name: f"{name}_" if name in _KEYWORDS else name, cell=lambda text: text.replace("|", "\\|"))
    paths = {"generated.rs": ROOT / "firmware" / "litex-pac" / "src" / "generated.rs", "registers.md": ROOT / "docs" / "registers.md"}
    return {path: templates.get_template(f"{name}.jinja").render(contents) for name, path in paths.items()}

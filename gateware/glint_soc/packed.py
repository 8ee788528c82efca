"""Packed structs of the ports between a block's LiteX description and its RTL, whose members are connected by name.

A description builds each `Struct` from the signals of its registers. `Package` writes the SystemVerilog type of each struct
to a package in the block's RTL folder, so positions and widths of members are never written by hand.
`cargo xtask pac` writes the packages of all blocks.
"""

from migen import Cat, Signal


class Struct:
    """A packed struct: its type in SystemVerilog, and the values of its members.

    A member is a Migen value, a `Struct`, or a list of members of one type (a packed array, element 0 in the lowest bits).
    `text` is the comment of the type.
    """

    def __init__(self, name, text, members):
        self.name = name
        self.text = text
        self._members = dict(members)

    def __getitem__(self, member):
        return self._members[member]

    def signals(self):
        """Returns a struct of the same type whose members are new signals."""
        return Struct(self.name, self.text, {
            member: _signals(member, value) for member, value in self._members.items()})

    @property
    def value(self):
        """All members as one value for a port of this type, an input or an output."""
        # A packed struct in SystemVerilog lists its members from the highest bits down, Cat in Migen from the lowest bits up.
        return Cat(*(_flat(value) for value in reversed(self._members.values())))

    def typedef(self):
        """Returns the definition of the type in SystemVerilog."""
        lines = [f"        {_type(value)} {member};" for member, value in self._members.items()]
        return "\n".join([*_comment(self.text), "    typedef struct packed {", *lines, f"    }} {self.name};"])


def _signals(name, value):
    if isinstance(value, list):
        return [_signals(f"{name}{i}", element) for i, element in enumerate(value)]
    return value.signals() if isinstance(value, Struct) else Signal(len(value), name=name)


def _flat(value):
    if isinstance(value, list):
        return Cat(*(_flat(element) for element in value))
    return value.value if isinstance(value, Struct) else value


def _type(value):
    if isinstance(value, Struct):
        return value.name
    if isinstance(value, list):
        element, = {_type(element) for element in value}
        # SystemVerilog writes the dimension of the array before the dimensions of its elements.
        name, *dimensions = element.split(" ")
        return f"{name} {''.join([f'[{len(value) - 1}:0]', *dimensions])}"
    return "logic" if len(value) == 1 else f"logic [{len(value) - 1}:0]"


class Enumeration:
    """Enumerated values of a register field: a list of names and texts; the index of an entry is its value."""

    def __init__(self, name, text, values):
        self.name = name
        self.text = text
        self._values = dict(values)
        self.bits = (len(values) - 1).bit_length()

    @property
    def values(self):
        """The values in the form that `CSRField` takes."""
        return [(str(number), name, text) for number, (name, text) in enumerate(self._values.items())]

    def __getitem__(self, name):
        """Returns the number of the value `name`."""
        return list(self._values).index(name)

    def constants(self):
        """Returns the values as constants in SystemVerilog."""
        return "\n".join([*_comment(self.text), *(
            f"    localparam logic [{self.bits - 1}:0] {self.name.upper()}_{name.upper()} = {self.bits}'d{number};"
            for number, name in enumerate(self._values))])


class Package:
    """The SystemVerilog package that holds the types and constants of one block's description.

    `numbers` are constants by name; `enumerations` and `structs` follow them in the order of their lists.
    """

    def __init__(self, block, numbers=None, enumerations=(), structs=()):
        self.block = block
        self.name = f"{block}_registers_pkg"
        self._numbers = numbers or {}
        self._enumerations = enumerations
        self._structs = structs

    def text(self):
        """Returns the text of the package's file."""
        return package(
            self.name, f"{self.block}.py",
            "Constants and types of the block's ports. docs/registers.md describes the registers.", [
                *(["\n".join(number(name, value) for name, value in self._numbers.items())] if self._numbers else []),
                *(enumeration.constants() for enumeration in self._enumerations),
                *(struct.typedef() for struct in self._structs),
            ])


def package(name, source, text, parts):
    """Returns the text of a SystemVerilog package with `parts`, separated by empty lines. `text` is its comment, and `source`
    the file of this folder from which it is generated."""
    return "\n".join([
        generated("//", source),
        *(f"//{line}" for line in lines_of(text)),
        "",
        "`default_nettype none",
        "",
        f"package {name};",
        "    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.",
        "    /* verilator lint_off UNUSEDPARAM */",
        "\n\n".join(parts),
        "    /* verilator lint_on UNUSEDPARAM */",
        "endpackage",
        "",
        "`default_nettype wire",
        "",
    ])


def number(name, value, text=""):
    """Returns a constant of a package, with a comment."""
    return "\n".join([*(_comment(text) if text else []), f"    localparam int unsigned {name} = {value};"])


def generated(mark, source):
    """Returns the comment that a file is generated from `source`; `mark` begins a comment."""
    return f"{mark} Generated from gateware/glint_soc/{source} by `cargo xtask pac`. Do not edit."


def _comment(text):
    return [f"    //{line}" for line in lines_of(text)]


def lines_of(text):
    """Returns a text split into lines of about 120 characters, each preceded by a blank."""
    words, lines = text.split(), [""]
    for word in words:
        if len(lines[-1]) + len(word) > 120:
            lines.append("")
        lines[-1] += f" {word}"
    return lines

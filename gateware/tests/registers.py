"""Checks of the SystemVerilog that is generated from the blocks' descriptions: register packages, structs, enumerations."""

from migen import Cat, Signal

from glint_soc import packages
from glint_soc.packed import Enumeration, Struct


def check_packages():
    """Checks that the committed SystemVerilog packages equal the packages generated from the descriptions."""
    stale = packages.stale(packages.full_soc())
    return [f"{path} is out of date: `{packages.WRITER}` writes it" for path in stale]


def check_struct():
    """Checks that type and value of a struct agree: SystemVerilog's first member is the highest, element 0 of an array the
    lowest."""
    low, high, flag, inner = Signal(3), Signal(3), Signal(), Signal(5)
    nested = Struct("inner_t", "Inside.", {"inner": inner})
    struct = Struct("outer_t", "Outside.", {"flag": flag, "pair": [low, high], "nested": nested})
    expected = """    // Outside.
    typedef struct packed {
        logic flag;
        logic [1:0][2:0] pair;
        inner_t nested;
    } outer_t;"""
    problems = []
    if struct.typedef() != expected:
        problems.append(f"expected {expected}, got {struct.typedef()}")
    if _signals(struct.value) != [inner, low, high, flag]:
        problems.append(f"from the lowest: {_signals(struct.value)}")
    if [len(signal) for signal in _signals(struct.signals().value)] != [5, 3, 3, 1]:
        problems.append("new signals of another shape")
    return problems


def _signals(value):
    return [signal for part in value.l for signal in _signals(part)] if isinstance(value, Cat) else [value]


def check_enumeration():
    """Checks that the values are numbered from 0, with the number of bits that the last number needs."""
    values = Enumeration("error", "Errors.", {"none": "no error", "size": "wrong size", "late": "too late"})
    expected = "    // Errors.\n" + "\n".join(
        f"    localparam logic [1:0] ERROR_{name} = 2'd{number};" for number, name in enumerate(("NONE", "SIZE", "LATE")))
    problems = [] if values.constants() == expected else [f"expected {expected}, got {values.constants()}"]
    if values["late"] != 2 or values.values[1] != ("1", "size", "wrong size"):
        problems.append(f"late is {values['late']}, the values are {values.values}")
    return problems


CHECKS = {
    "packages of the RTL up to date": check_packages,
    "packed structs": check_struct,
    "enumerations": check_enumeration,
}

"""Checks of the files that are generated from the descriptions: whether they are up to date, and the parts of their generators."""

from types import SimpleNamespace

from litex.soc.interconnect.csr import CSRField, CSRStatus
from migen import Cat, Signal

from glint_soc import packages, pac
from glint_soc.packed import Enumeration, Struct


def check_packages():
    """Checks that the committed files are those that the descriptions generate."""
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


def check_refusals():
    """Checks that the generator of the register access crate refuses what it cannot print."""
    def status(name, size=32, **options):
        return CSRStatus(size, name=name, **options)

    def field(name, values):
        return CSRField(name, size=2, values=[(str(value), f"is{value}", "") for value in values])

    problems = []
    for expected, csrs, more in [
        ("counters ['hits'] of 'lamp' are not registers", [status("count")], {"counters": ["hits"]}),
        ("counter 'count' of 'lamp': expected a plain register of 32 bits", [status("count", 8)], {"counters": ["count"]}),
        ("counter 'count' of 'lamp': expected a plain register of 32 bits",
         [status("count", fields=[CSRField("part", size=32)])], {"counters": ["count"]}),
        ("register 'wide' of 3 words", [status("wide", 65)], {}),
        ("values ['is4'] of the field 'state': expected numbers of 2 bits", [status("control", fields=[field("state", [3, 4])])], {}),
        ("values of control.state of 'lamp' would be the type 'State'",
         [status("state"), status("control", fields=[field("state", [1])])], {}),
        ("values of control.lamp of 'lamp' would be the type 'Lamp'", [status("control", fields=[field("lamp", [1])])], {}),
        ("values of control.mistake, control.stake of 'lamp' would be the type ''",
         [status("control", fields=[field("mistake", [1]), field("stake", [1])])], {}),
        ("values of control.b_state, control.c_state of 'lamp' would be the type 'State'",
         [status("control", fields=[field("state", [1]), field("a_state", [1]), field("b_state", [2]), field("c_state", [2])])], {}),
    ]:
        try:
            region = SimpleNamespace(origin=0, obj=csrs)
            found = str(list(pac.peripheral("lamp", SimpleNamespace(**more), region, None).enumerations))
        except ValueError as error:
            found = str(error)
        if not found.startswith(expected):
            problems.append(f"expected {expected}, got {found}")
    return problems


def check_suffixes():
    """Checks the words in which all names end."""
    cases = {("geometry_error", "raster_error"): "error", ("size", "size"): "size", ("frame_size", "size"): "size", ("mistake", "stake"): ""}
    return [f"{names}: expected {expected}, got {found}" for names, expected in cases.items()
            if (found := pac.common_suffix(names)) != expected]


CHECKS = {
    "up to date": check_packages,
    "refused descriptions": check_refusals,
    "names of shared values": check_suffixes,
    "packed structs": check_struct,
    "enumerations": check_enumeration,
}

"""Tests of the files that are generated from the descriptions, and of their generators."""

import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from litex.soc.interconnect.csr import CSRField, CSRStatus
from migen import Cat, Signal

from glint_soc import packages, pac
from glint_soc.packed import Enumeration, Struct
from glint_soc.virtual import VirtualSoC


def test_up_to_date():
    """Checks that the committed files are those that the descriptions generate."""
    assert list(packages.stale(packages.full_soc())) == [], f"`{packages.WRITER}` writes them"


def test_struct():
    """Checks that type and value of a struct agree: SystemVerilog's first member is the highest, element 0 of an array the
    lowest."""
    low, high, flag, inner = Signal(3), Signal(3), Signal(), Signal(5)
    nested = Struct("inner_t", "Inside.", {"inner": inner})
    struct = Struct("outer_t", "Outside.", {"flag": flag, "pair": [low, high], "nested": nested})
    assert struct.typedef() == """    // Outside.
    typedef struct packed {
        logic flag;
        logic [1:0][2:0] pair;
        inner_t nested;
    } outer_t;"""
    assert [id(signal) for signal in _signals(struct.value)] == [id(signal) for signal in (inner, low, high, flag)]
    assert [len(signal) for signal in _signals(struct.signals().value)] == [5, 3, 3, 1]


def _signals(value):
    return [signal for part in value.l for signal in _signals(part)] if isinstance(value, Cat) else [value]


def test_enumeration():
    """Checks that the values are numbered from 0, with the number of bits that the last number needs."""
    values = Enumeration("error", "Errors.", {"none": "no error", "size": "wrong size", "late": "too late"})
    assert values.constants() == "    // Errors.\n" + "\n".join(
        f"    localparam logic [1:0] ERROR_{name} = 2'd{number};" for number, name in enumerate(("NONE", "SIZE", "LATE")))
    assert values["late"] == 2
    assert values.values[1] == ("1", "size", "wrong size")


def _status(name, size=32, **options):
    return CSRStatus(size, name=name, **options)


def _control(**fields):
    """A register with fields of 2 bits that have these named values."""
    return _status("control", fields=[CSRField(name, size=2, values=[(str(value), f"is{value}", "") for value in values])
                                      for name, values in fields.items()])


@pytest.mark.parametrize(("expected", "csrs", "counters"), [
    ("counters ['hits'] of 'lamp' are not registers", [_status("count")], ["hits"]),
    ("counter 'count' of 'lamp': expected a plain register of 32 bits", [_status("count", 8)], ["count"]),
    ("counter 'count' of 'lamp': expected a plain register of 32 bits", [_status("count", fields=[CSRField("part", size=32)])], ["count"]),
    ("register 'wide' of 3 words", [_status("wide", 65)], []),
    ("values ['is4'] of the field 'state': expected numbers of 2 bits", [_control(state=[3, 4])], []),
    ("values of control.state of 'lamp' would be the type 'State'", [_status("state"), _control(state=[1])], []),
    ("values of control.lamp of 'lamp' would be the type 'Lamp'", [_control(lamp=[1])], []),
    ("values of control.mistake, control.stake of 'lamp' would be the type ''", [_control(mistake=[1], stake=[1])], []),
    ("values of control.b_state, control.c_state of 'lamp' would be the type 'State'",
     [_control(state=[1], a_state=[1], b_state=[2], c_state=[2])], []),
])
def test_refusals(expected, csrs, counters):
    """Checks that the generator of the register access crate rejects unsupported descriptions."""
    with pytest.raises(ValueError, match=re.escape(expected)):
        assert pac.peripheral("lamp", SimpleNamespace(counters=counters), SimpleNamespace(origin=0, obj=csrs), None).enumerations


@pytest.mark.parametrize(("names", "suffix"), [
    (["geometry_error", "raster_error"], "error"), (["size", "size"], "size"), (["frame_size", "size"], "size"), (["mistake", "stake"], "")])
def test_suffixes(names, suffix):
    """Checks the search for the last words that names have in common."""
    assert pac.common_suffix(names) == suffix


def test_variants_of_the_cpu():
    """Checks that a build has the requested variant of the CPU, and that a variant without the firmware's instructions is rejected."""
    soc = VirtualSoC(0, (), cpu="lite")
    soc.finalize()
    sources = {Path(source).name for source, *_ in soc.platform.sources}
    assert "VexRiscv_Lite.v" in sources
    assert "VexRiscv_Full.v" not in sources
    with pytest.raises(ValueError, match="CPU variant 'minimal': expected a variant with rv32im, one of lite, "):
        VirtualSoC(0, (), cpu="minimal")

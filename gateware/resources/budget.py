"""Limits of the gateware's resources: `gateware/budget.toml`."""

import tomllib
from dataclasses import dataclass

from verilate.programs import GATEWARE

from .blocks import FLAT, FLAT_PARTS, ROWS, SOC
from .modules import CORES
from .route import REFERENCE
from .tools import ToolError

PATH = GATEWARE / "budget.toml"

RESOURCES = {"lut": "LUT", "ff": "FF", "dsp48": "DSP48", "ramb36": "RAMB36", "carry4": "CARRY4", "path": "path",
             "control_sets": "control sets", "slices": "slices"}
"""Limited resources in the order of the tables, with their names in tables and messages. The last two limit the placement."""


def number(count):
    """Formats a count with commas between its thousands, and a half as `.5`."""
    return f"{int(count):,}{'.5' if count % 1 else ''}"


def amounts(size):
    """Returns the amounts of the limited resources of a block, from its cell counts; a RAMB18 counts as 0.5 RAMB36."""
    sums = {"lut": size["logic"] + size["srl"] + size["lutram"], "ramb36": size["ramb36"] + size["ramb18"] / 2}
    return {resource: sums.get(resource, size.get(resource)) for resource in RESOURCES}


def with_flat_build(sizes):
    """Returns `sizes`, and the sum `FLAT` if all of its parts are measured. The path of the sum is the longest path of the parts. A
    control set that several parts have counts once for each part."""
    parts = [size for size in sizes if size["name"] in FLAT_PARTS]
    if len(parts) != len(FLAT_PARTS):
        return sizes
    others = {cell for part in parts for cell in part["others"]}
    fan_outs = [(f"{part['name']}.{net}", loads) for part in parts for net, loads in part["fan_outs"]]
    counts = ("logic", "srl", "lutram", "ff", "dsp48", "ramb36", "ramb18", "carry4", "control_sets", "small_set_ff", "slices")
    return [*sizes, {
        "name": FLAT, "yosys": parts[0]["yosys"], **{count: sum(part[count] for part in parts) for count in counts},
        "path": max(part["path"] for part in parts),
        "others": {cell: sum(part["others"].get(cell, 0) for part in parts) for cell in sorted(others)},
        "fan_outs": sorted(fan_outs, key=lambda net: -net[1])[:len(parts[0]["fan_outs"])], "instances": []}]


@dataclass(frozen=True)
class Budget:
    """The contents of the file. `device`: resources of the FPGA, which are the limits of the SoC. `own`: limits of every other block.
    `block`: limits of single blocks, and `ratio`, the minimum ratio of a block's clock rate to that of the soft core. `reference`:
    clock rate of the soft core with the first seed of the placer, and the version of nextpnr that reached it."""

    device: dict
    own: dict
    block: dict
    reference: dict

    def __post_init__(self):
        for name, limits in {"device": self.device, "own": self.own, **self.block}.items():
            known = {*RESOURCES, "ratio"} if name in self.block else {*RESOURCES}
            for resource, limit in limits.items():
                if resource not in known or limit < 0:
                    raise ToolError(f"{PATH.name}: {resource} = {limit} of {name}: expected 0 or more of {', '.join(sorted(known))}")
        for name in self.block:
            if name not in ROWS:
                raise ToolError(f"{PATH.name}: unknown block {name}: expected one of {' '.join(ROWS)}")

    @classmethod
    def parse(cls, text):
        """Returns the limits from the text of a budget file."""
        try:
            return cls(**tomllib.loads(text))
        except TypeError as error:
            raise ToolError(f"{PATH.name}: {error}") from error

    @classmethod
    def read(cls):
        """Returns the limits in `gateware/budget.toml`."""
        return cls.parse(PATH.read_text())

    def limits(self, block):
        """Returns the limits of a block. A limit of the single block replaces the default limit, which is that of the device
        for the SoC and that of `own` for other blocks. Variants of the soft core have none."""
        if any(block == core.name for core in CORES):
            return {}
        limits = (self.device if block == SOC else self.own) | self.block.get(block, {})
        return {resource: limits[resource] for resource in RESOURCES if resource in limits}

    def ratio(self, block):
        """Returns the minimum ratio of a block's clock rate to that of the soft core, or None."""
        return self.block.get(block, {}).get("ratio")

    def routed(self):
        """Returns the blocks that have a minimum ratio."""
        return sorted(name for name in self.block if self.ratio(name) is not None)

    def excesses(self, sizes):
        """Returns every resource of every block that exceeds its limit."""
        return [{"block": size["name"], "resource": resource, "budget": limit, "measured": amounts(size)[resource]}
                for size in sizes for resource, limit in self.limits(size["name"]).items() if amounts(size)[resource] > limit]

    def shortfalls(self, rates, reference):
        """Returns the blocks below their minimum ratios to `reference`, the soft core's rate in MHz."""
        return [{"block": rate["name"], "minimum": minimum, "measured": rate["mhz"] / reference}
                for rate in rates if (minimum := self.ratio(rate["name"])) is not None and rate["mhz"] / reference < minimum]

    def stale_reference(self, rates):
        """Yields a line if the measured rate of the soft core differs from the reference in the budget, and a line for each rate by
        another version of nextpnr, because only rates by the same version can be compared."""
        mhz, nextpnr = self.reference["mhz"], self.reference["nextpnr"]
        for rate in rates:
            if rate["name"] == REFERENCE and (rate["seeds"][0], rate["nextpnr"]) != (mhz, nextpnr):
                yield (f"{REFERENCE}: the reference is {mhz} MHz by nextpnr {nextpnr}, expected the measured {rate['seeds'][0]} MHz by "
                       f"nextpnr {rate['nextpnr']}")
            elif rate["nextpnr"] != nextpnr:
                yield (f"{rate['name']}: routed by nextpnr {rate['nextpnr']}, expected {nextpnr} as for the reference; `cargo xtask resources "
                       f"--route {REFERENCE}` measures that again")

    def problems(self, sizes, rates):
        """Returns a line for each resource above its limit, and for each rate below its limit. If `rates` does not include the soft
        core, the budget's rate is used."""
        reference = next((rate["mhz"] for rate in rates if rate["name"] == REFERENCE), self.reference["mhz"])
        return [
            *(f"{excess['block']}: {RESOURCES[excess['resource']]}: budget {number(excess['budget'])}, measured "
              f"{number(excess['measured'])}" for excess in self.excesses(sizes)),
            *(f"{short['block']}: ratio to {REFERENCE}: at least {short['minimum']:.2f}, measured {short['measured']:.2f}"
              for short in self.shortfalls(rates, reference)),
            *self.stale_reference(rates)]

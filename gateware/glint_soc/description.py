"""The parts of the SoC's description that LiteX's exports leave out: reset values, enumerated values, counters, constants.

A block (a `LiteXModule` with registers) may have two attributes beside its registers:

* `counters`: its free-running counters, an object with `registers` by name, or the names alone; shown in this order;
* `constants`: numbers that software relies on, name to (value, text).

`cargo xtask pac` joins this description with `soc.svd` and `csr.json` and fails when they disagree.
"""

import json

def describe(soc):
    """Returns the description of the blocks of a finalized SoC as plain data."""
    return {"blocks": {name: _block(getattr(soc, name, None), region.obj) for name, region in soc.csr.regions.items()}}


def write(soc, path):
    """Writes the description of `soc` to `path` as JSON."""
    path.write_text(json.dumps(describe(soc), indent=1) + "\n")


def _block(block, registers):
    names = [register.name for register in registers]
    counters = getattr(block, "counters", [])
    counters = list(getattr(counters, "registers", counters))
    unknown = sorted(set(counters) - set(names))
    if unknown:
        raise ValueError(f"counters {unknown} of {type(block).__name__} are not registers, expected some of {names}")
    return {
        "registers": [_register(register) for register in registers],
        "counters": counters,
        "constants": [
            {"name": name, "value": value, "text": text}
            for name, (value, text) in getattr(block, "constants", {}).items()
        ],
    }


def _register(register):
    fields = getattr(register, "fields", None)
    fields = fields.fields if fields else []
    return {
        "name": register.name,
        "width": register.size,
        "fields": [
            {
                "name": field.name,
                "lsb": field.offset,
                "width": field.size,
                "reset": field.reset_value,
                "values": _values(field),
            }
            for field in fields
        ],
    }


def _values(field):
    """Returns the named values of `field`. Values without a name, which LiteX allows as documentation, are omitted."""
    named = [entry for entry in field.values or [] if len(entry) == 3]
    return [{"value": int(value, 0), "name": name, "text": text} for value, name, text in named]

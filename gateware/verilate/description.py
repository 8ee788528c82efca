"""Describes the ports and packed types of a design as Verilator resolves them.

A type is one of
    {"width": 18, "signed": true}                           a vector
    {"name": "pkg::state_t", "width": 2, "values": {"MISS": 0}}
                                                            an enumeration
    {"count": 3, "lowest": 0, "element": TYPE}              a packed array
    {"name": "pkg::ray_t", "members": [["start", TYPE], …]} a packed structure, the member in the highest bits first
"""

import json

from .programs import ToolError, run_verilator

# Widths of the integer types without a declared range.
_WIDTHS = {"logic": 1, "bit": 1, "byte": 8, "shortint": 16, "int": 32, "integer": 32, "longint": 64}


def describe(top, sources, parameters, folder):
    """Returns the ports of a design with the given parameters, in order of declaration, and the named types of all packages."""
    run_verilator("--json-only", "-Wno-fatal", "--prefix", "Vmodel", "--Mdir", folder, "--top-module", top,
                  *(f"-G{key}={value}" for key, value in parameters.items()), *sources)
    tree = json.loads((folder / "Vmodel.tree.json").read_text())
    table = next(entry for entry in tree["miscsp"] if entry["type"] == "TYPETABLE")["typesp"]
    types = {entry["addr"]: entry for entry in table}
    # Deletes the syntax tree, which is larger than the model.
    for left_over in folder.glob("Vmodel.tree*.json"):
        left_over.unlink()
    module = next(module for module in tree["modulesp"] if module["type"] == "MODULE" and module["level"] == 1)
    ports = [{"name": port["name"], "output": port["direction"] == "OUTPUT", "type": _type(types, port["dtypep"])}
             for port in module["stmtsp"] if port["type"] == "VAR" and port["direction"] in ("INPUT", "OUTPUT")]
    named = {entry["name"]: _type(types, entry["addr"]) for entry in table
             if entry["type"] in ("STRUCTDTYPE", "ENUMDTYPE") and "::" in entry["name"]}
    return {"ports": ports, "types": named}


def _type(types, address):
    entry = types[address]
    match entry["type"]:
        case "BASICDTYPE":
            return {"width": _width(entry), "signed": entry.get("signed", False)}
        case "PACKARRAYDTYPE":
            left, right = (int(bound) for bound in entry["declRange"].strip("[]").split(":"))
            return {"count": abs(left - right) + 1, "lowest": min(left, right), "element": _type(types, entry["refDTypep"])}
        case "STRUCTDTYPE":
            members = [[member["name"], _type(types, member["dtypep"])] for member in entry["membersp"]]
            return {"name": entry["name"], "members": members}
        case "ENUMDTYPE":
            values = {item["name"]: int(item["valuep"][0]["name"].split("h")[1], 16) for item in entry["itemsp"]}
            return {"name": entry["name"], "width": _type(types, entry["refDTypep"])["width"], "values": values}
        case "REFDTYPE":
            return _type(types, entry["refDTypep"])
        case kind:
            raise ToolError(f"no description of a {kind}: {entry['name']}")


def _width(entry):
    if "range" in entry:
        left, right = (int(bound) for bound in entry["range"].split(":"))
        return abs(left - right) + 1
    return _WIDTHS[entry["keyword"]]

"""The flat fields of the raymarcher, with one description for each.

`cargo xtask pac` generates `rtl/raymarch/fields_pkg.sv` (numbers, latency, kind of faces) and
`rtl/raymarch/flat_fields.sv` (instances, delays, choice) from the descriptions. The descriptions also determine the values of
`solid.kind` and the bits of `caps.flat`, with the PAC and the driver's checks; the builds; and the variants that are tested
and whose size is measured. docs/adding-a-field.md lists the steps to add a field.
"""

from dataclasses import dataclass, field

from .packed import generated, number, package
from .rtl import RTL


@dataclass(frozen=True)
class FlatField:
    """A flat field. Its module has the name `field_NAME`.

    `text` is the plural of the fields that use the module, for error messages. `clocks` is the latency as a SystemVerilog
    expression of LEVELS. `ports` connects the ports other than `clk`, `point`, `distance` and `surface` to members of `solid_t`;
    `parameters` are the parameters of the instance. With `octants`, faces are perpendicular to the diagonals (±1, ±1, ±1), and
    `surface` is {z, y, x}, 1 where the normal is positive. Otherwise faces are perpendicular to the axes, and `surface` is
    {axis, positive}. `inside` is the name of a field whose module serves this field too, in builds with both.
    """

    name: str
    text: str
    clocks: str
    ports: dict
    parameters: dict = field(default_factory=dict)
    octants: bool = False
    inside: str = ""


_BOX = {port: f"solid.{port}" for port in ("half", "has", "room", "repeated")}

FLAT_FIELDS = (
    FlatField("menger", "sponges", clocks="3 * LEVELS + 3", parameters={"LEVELS": "LEVELS", "BOX": "(FIELDS & 2) != 0"},
              ports={"is_box": "solid.kind == 2'd1", "levels": "solid.levels[LEVELS-1:0]", "cube_half": "solid.cube_half", **_BOX}),
    FlatField("box", "boxes, cubes and planes", clocks="3", ports=_BOX, inside="menger"),
    FlatField("octahedron", "octahedra", clocks="5", ports={"size": "solid.half[0]"}, octants=True),
)
"""All flat fields, by their numbers in `solid.kind`. Field 0 is the sponge; the build sets its number of levels."""

NAMES = tuple(flat.name for flat in FLAT_FIELDS)

KIND_BITS = max(1, (len(FLAT_FIELDS) - 1).bit_length())
"""Width of `solid.kind` in bits."""


def mask(names):
    """Returns the parameter FIELDS of a build with the fields `names`: bit k is set if field k is built."""
    return sum(1 << NAMES.index(name) for name in names)


def has_octants(names):
    """Returns whether a build with the fields `names` has fields whose faces are perpendicular to the diagonals."""
    return any(flat.octants for flat in FLAT_FIELDS if flat.name in names)


def files():
    """Returns the text of each generated file, by path."""
    return {RTL / "raymarch" / "fields_pkg.sv": _package(), RTL / "raymarch" / "flat_fields.sv": _module()}


def _package():
    inside = "\n".join(
        f"        if ((fields & {1 << _host(flat)}) != 0) instances = instances & ~32'd{1 << number};"
        for number, flat in enumerate(FLAT_FIELDS) if flat.inside)
    clocks = "\n".join(
        f"        if ((instances(fields) & {1 << number}) != 0 && {flat.clocks.replace('LEVELS', 'levels')} > flat_clocks) "
        f"flat_clocks = {flat.clocks.replace('LEVELS', 'levels')};" for number, flat in enumerate(FLAT_FIELDS))
    octants = [number for number, flat in enumerate(FLAT_FIELDS) if flat.octants]
    is_octant = " || ".join(f"kind == {_number(number)}" for number in octants) or "1'b0 && kind == '0"
    return package("fields_pkg", "fields.py", "Properties of the flat fields. A field is selected by its number.", [
        "\n".join([
            number("KIND_BITS", KIND_BITS),
            number("ALL", mask(NAMES), "Masks of all fields, and of the fields whose faces are perpendicular to the diagonals."),
            number("OCTANTS", sum(1 << field for field in octants)),
            *(number(flat.name.upper(), 1 << field, "Mask of each field." if field == 0 else "")
              for field, flat in enumerate(FLAT_FIELDS)),
        ]),
        f"""    // Whether the faces of a kind of field are perpendicular to the diagonals.
    function automatic logic has_octants(input logic [KIND_BITS-1:0] kind);
        has_octants = {is_octant};
    endfunction""",
        f"""    // Returns the mask of the fields that have their own instance in a build with the fields of the mask `fields`. The module of
    // another field also computes the distances to the remaining fields.
    function automatic int unsigned instances(input int unsigned fields);
        instances = fields;
{inside}
    endfunction""",
        f"""    // Returns the number of clocks from a point to its distance, including the clock of the multiplexer, if there is one.
    function automatic int unsigned flat_clocks(input int unsigned levels, input int unsigned fields);
        flat_clocks = 0;
{clocks}
        if ((instances(fields) & (instances(fields) - 1)) != 0) flat_clocks = flat_clocks + 1;
    endfunction""",
    ])


def _host(flat):
    """Number of the field whose module also computes this field, in builds with both."""
    return NAMES.index(flat.inside)


def _number(number):
    return f"{KIND_BITS}'d{number}"


def _instance(number, flat):
    connections = "".join(f" .{port}({value})," for port, value in flat.ports.items())
    parameters = ", ".join(f".{name}({value})" for name, value in flat.parameters.items())
    return f"""
    if ((INSTANCES & {1 << number}) != 0) begin : {flat.name}
        localparam int unsigned CLOCKS = {flat.clocks};
        logic [24:0] early;

        field_{flat.name} {f"#({parameters}) " if parameters else ""}field (
            .clk, .point,{connections}
            .distance(early[24:3]), .surface(early[2:0])
        );
        if (KNOWN > CLOCKS) begin : late
            delay #(.WIDTH(25), .CLOCKS(KNOWN - CLOCKS)) waiting (.clk, .enable(1'b1), .in(early), .out(found[{number}]));
        end else begin : in_time
            assign found[{number}] = early;
        end
    end else begin : no_{flat.name}
        assign found[{number}] = '0;
    end
"""


def _is_kind(number):
    """Condition that the drawn field is a field of this module."""
    served = [other for other, flat in enumerate(FLAT_FIELDS) if flat.inside == NAMES[number]]
    return " || ".join(f"solid.kind == {_number(kind)}" for kind in (number, *served))


def _module():
    instances = "".join(_instance(number, flat) for number, flat in enumerate(FLAT_FIELDS))
    choice = "\n".join(f"        if ({_is_kind(number)}) chosen = chosen | found[{number}];" for number in range(len(FLAT_FIELDS)))
    single = "\n".join(f"        chosen = chosen | found[{number}];" for number in range(len(FLAT_FIELDS)))
    return f"""{generated("//", "fields.py")}
// Computes the distances to all flat fields of a build in parallel, and selects one of the distances by `solid.kind`.
//
// Bit k of FIELDS is set if field k is built. A field that is not built takes no LUTs; a single instance needs no multiplexer.
// Latency fields_pkg::flat_clocks(LEVELS, FIELDS), throughput one point per clock, no handshake; `solid` must hold.

`default_nettype none

module flat_fields #(
    parameter int unsigned LEVELS = 4,
    parameter int unsigned FIELDS = 1
) (
    input  wire                                clk,
    input  wire raymarch_registers_pkg::solid_t solid,
    input  wire  [2:0][21:0]                   point,
    output logic signed [21:0]                 distance,
    output logic [2:0]                         surface
);
    localparam int unsigned INSTANCES = fields_pkg::instances(FIELDS);
    localparam bit          CHOICE    = (INSTANCES & (INSTANCES - 1)) != 0;
    localparam int unsigned KNOWN     = fields_pkg::flat_clocks(LEVELS, FIELDS) - (CHOICE ? 1 : 0);

    // Distance and surface of each instance (`found`) and of the selected instance (`chosen`).
    logic [{len(FLAT_FIELDS) - 1}:0][24:0] found;
    logic [24:0] chosen;
{instances}
    if (CHOICE) begin : choice
        always_comb begin
            chosen = '0;
{choice.replace("        if", "            if")}
        end
        always_ff @(posedge clk) {{distance, surface}} <= chosen;
    end else begin : single
        always_comb begin
            chosen = '0;
{single.replace("        chosen", "            chosen")}
        end
        assign {{distance, surface}} = chosen;
    end

    wire _unused = &{{1'b0, clk, point, solid}};
endmodule

`default_nettype wire
"""

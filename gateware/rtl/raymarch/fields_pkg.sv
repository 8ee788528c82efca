// Generated from gateware/glint_soc/fields.py by `cargo xtask pac`. Do not edit.
// Properties of the flat fields. A field is selected by its number.

`default_nettype none

package fields_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    localparam int unsigned KIND_BITS = 2;
    // Masks of all fields, and of the fields whose faces are perpendicular to the diagonals.
    localparam int unsigned ALL = 7;
    localparam int unsigned OCTANTS = 4;
    // Mask of each field.
    localparam int unsigned MENGER = 1;
    localparam int unsigned BOX = 2;
    localparam int unsigned OCTAHEDRON = 4;

    // Whether the faces of a kind of field are perpendicular to the diagonals.
    function automatic logic has_octants(input logic [KIND_BITS-1:0] kind);
        has_octants = kind == 2'd2;
    endfunction

    // Returns the mask of the fields that have their own instance in a build with the fields of the mask `fields`. The module of
    // another field also computes the distances to the remaining fields.
    function automatic int unsigned instances(input int unsigned fields);
        instances = fields;
        if ((fields & 1) != 0) instances = instances & ~32'd2;
    endfunction

    // Returns the number of clocks from a point to its distance, including the clock of the multiplexer, if there is one.
    function automatic int unsigned flat_clocks(input int unsigned levels, input int unsigned fields);
        flat_clocks = 0;
        if ((instances(fields) & 1) != 0 && 3 * levels + 3 > flat_clocks) flat_clocks = 3 * levels + 3;
        if ((instances(fields) & 2) != 0 && 3 > flat_clocks) flat_clocks = 3;
        if ((instances(fields) & 4) != 0 && 5 > flat_clocks) flat_clocks = 5;
        if ((instances(fields) & (instances(fields) - 1)) != 0) flat_clocks = flat_clocks + 1;
    endfunction
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

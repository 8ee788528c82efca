// Generated from gateware/glint_soc/fields.py by `gateware/tests/run.py --packages`. Do not edit.
// What the raymarcher needs to know of flat fields, by their numbers.

`default_nettype none

package fields_pkg;
    // Each module uses some.
    /* verilator lint_off UNUSEDPARAM */
    localparam int unsigned KIND_BITS = 1;
    // The bits of all fields, and of those whose faces are perpendicular to the diagonals.
    localparam int unsigned ALL       = 3;
    localparam int unsigned OCTANTS   = 0;
    /* verilator lint_on UNUSEDPARAM */

    // Whether faces of a kind are perpendicular to the diagonals.
    function automatic logic has_octants(input logic [KIND_BITS-1:0] kind);
        has_octants = 1'b0 && kind == '0;
    endfunction

    // Clocks from a point to its distance, of a choice between several fields.
    function automatic int unsigned flat_clocks(input int unsigned levels, input int unsigned fields);
        flat_clocks = 0;
        if ((fields & 1) != 0 && 3 * levels + 3 > flat_clocks) flat_clocks = 3 * levels + 3;
        if ((fields & 2) != 0 && 3 > flat_clocks) flat_clocks = 3;
        if ((fields & (fields - 1)) != 0) flat_clocks = flat_clocks + 1;
    endfunction
endpackage

`default_nettype wire

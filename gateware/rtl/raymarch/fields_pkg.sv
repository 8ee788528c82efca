// Generated from gateware/glint_soc/fields.py by `cargo xtask pac`. Do not edit.
// Masks of flat fields.

`default_nettype none

package fields_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Masks of all fields, of fields with faces perpendicular to the diagonals, and of fields that fillets can join with
    // spheres.
    localparam int unsigned ALL = 7;
    localparam int unsigned OCTANTS = 4;
    localparam int unsigned MARCHED = 3;
    // Mask of each field.
    localparam int unsigned MENGER = 1;
    localparam int unsigned BOX = 2;
    localparam int unsigned OCTAHEDRON = 4;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

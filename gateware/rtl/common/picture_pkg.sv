// Generated from gateware/glint_soc/constants.py by `cargo xtask pac`. Do not edit.
// Sizes of pictures. Code s is the first size times 2^s.

`default_nettype none

package picture_pkg;
    // A module uses only some of these constants.
    /* verilator lint_off UNUSEDPARAM */
    localparam int unsigned WIDTH = 320;
    localparam int unsigned HEIGHT = 180;

    // 128-bit words of a frame of the first size, RGB565.
    localparam int unsigned FRAME_WORDS = 7200;

    // Cones across and down, of an eye that looks alone at a size above the first; half of each otherwise.
    localparam int unsigned CONES_ACROSS = 160;
    localparam int unsigned CONES_DOWN = 90;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

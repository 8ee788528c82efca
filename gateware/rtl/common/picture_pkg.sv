// Generated from gateware/glint_soc/constants.py by `cargo xtask pac`. Do not edit.
// Sizes of pictures. Code s is the first size times 2^s.

`default_nettype none

package picture_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    localparam int unsigned WIDTH = 320;
    localparam int unsigned HEIGHT = 180;

    // Number of 128-bit words of an RGB565 frame of the first size.
    localparam int unsigned FRAME_WORDS = 7200;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

// Types of the values that the modules of the gesture engine exchange. docs/formats/gesture.md, "Gestures", explains them.

`default_nettype none

package gesture_pkg;
    /* verilator lint_off UNUSEDPARAM */
    localparam logic [1:0] TOKEN_PIXEL = 2'd0;
    localparam logic [1:0] TOKEN_LINE  = 2'd1; // the end of a line
    localparam logic [1:0] TOKEN_FRAME = 2'd2; // the end of a frame, and the start of the next one
    /* verilator lint_on UNUSEDPARAM */

    // A token from the image sensor. The `data` of a pixel is its RGB565 colour. In the `data` of a line, bit 0 is set if the line had an
    // odd number of bytes, and bit 1 if VSYNC cut the line off. `lost` is set if tokens before this token are missing.
    typedef struct packed {
        logic        lost;
        logic [1:0]  kind;
        logic [15:0] data;
    } token_t;

    // The contents of a clock in the pipeline: at most one of the first five bits is set. A line is followed by 14 clocks with `blank` and
    // one clock with `next`, which act as unmarked pixels after the line's end; a frame is followed by 15 clocks without any of these bits.
    typedef struct packed {
        logic pixel;
        logic line;
        logic blank;
        logic next;
        logic frame;
        logic lost;
        logic odd;
        logic cut;
    } item_t;
endpackage

`default_nettype wire

// Types and numbers of clocks that the modules of the texture unit share. docs/formats/texture.md explains the values.

`default_nettype none

package texture_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // How a texture is read, from its header; constant while a quad is inside.
    typedef struct packed {
        logic [1:0]      format;     // 0 RGB565, 1 indices of 256 colours, 2 indices of 16
        logic [1:0][3:0] side_log2;  // base-2 logarithms of width (0) and height (1) of level 0, 3 to 10
        logic [3:0]      last_level;
        logic [1:0][1:0] wrap;       // across (0), down (1): 0 repeat, 1 mirror, 2 clamp
        logic            bilinear;
        logic            cut_out;
        logic [15:0]     key;
    } sampler_t;

    // Position of a pixel on an axis.
    typedef struct packed {
        logic        below;    // below 0 (only matters with clamp)
        logic        past;     // at or above 1
        logic        odd;      // number of the repeat is odd (mirror)
        logic [17:0] fraction; // of a repeat, u0.18, rounded down
    } position_t;

    // Clocks in texture_filter from a step to its light, and to its colours.
    localparam int unsigned LIGHT  = 6;
    localparam int unsigned FILTER = 9;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

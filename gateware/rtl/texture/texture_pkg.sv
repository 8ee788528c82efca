// Types of the values that the modules of the texture unit exchange. docs/formats/texture.md explains the number formats.

`default_nettype none

package texture_pkg;
    // How a texture is read (records_pkg::texture_header_t).
    typedef struct packed {
        logic [1:0]      format;     // 0 RGB565, 1 indices of 256 colours, 2 indices of 16 colours
        logic [1:0][3:0] side_log2;  // base-2 logarithms of the width (0) and the height (1) of level 0, 3 to 10
        logic [3:0]      last_level;
        logic [1:0][1:0] wrap;       // across (0) and down (1): 0 repeat, 1 mirror, 2 clamp
        logic            bilinear;
        logic            cut_out;    // texels with the value `key` are transparent
        logic [15:0]     key;
    } sampler_t;

    // Position of a pixel on an axis of a texture, in repeats.
    typedef struct packed {
        logic        below;    // below 0, as far as clamping needs it
        logic        past;     // 1 or more
        logic        odd;      // the number of the repeat is odd
        logic [17:0] fraction; // u0.18, rounded down
    } position_t;
endpackage

`default_nettype wire

// Types and sizes of the texture unit (docs/formats/texture.md, "On a triangle").

`default_nettype none

package texture_pkg;
    // How a texture is read. Constant while a quad is inside the sampler.
    typedef struct packed {
        logic [1:0]      format;     // 0 RGB565, 1 indices of 256 colours, 2 indices of 16
        logic [1:0][3:0] side_log2;  // base-2 logarithms of width (0) and height (1) of level 0, 3 to 10
        logic [3:0]      last_level;
        logic [1:0][1:0] wrap;       // across (0) and down (1): 0 repeat, 1 mirror, 2 clamp
        logic            bilinear;
        logic            cut_out;
        logic [15:0]     key;        // value of a transparent texel, if `cut_out`
        logic [3:0]      blend;      // 0 opaque; 1 to 7 opacity in eighths; from 8 on, added to the colours behind
    } sampler_t;

    // Position of a pixel on an axis.
    typedef struct packed {
        logic        below;    // below 0
        logic        past;     // at or above 1
        logic        odd;      // the number of the repeat is odd
        logic [14:0] fraction; // position in the repeat, u0.15, rounded down
    } position_t;

    // An item: four columns and four rows of texels, the slots, which a quad of pixels or a pair of pixels needs. With nearest filtering,
    // slot i is the texel of pixel i of a quad. With bilinear filtering, slots 2j and 2j+1 are the neighbours u and u+1 (or v and v+1) of
    // pixel j of a pair.
    typedef struct packed {
        logic [3:0]           mask;    // covered pixels; of a pair, bits 0 and 1
        logic                 half;
        logic                 last;
        logic                 second;  // the pair of the quad's lanes 2 and 3
        logic [3:0]           level;
        logic [1:0][1:0][3:0] weights; // pixel, axis
        logic [1:0][1:0]      upper;   // pixel, axis: the nearest texel is the one at u+1
        logic [1:0][3:0][9:0] texels;  // axis, slot
    } item_t;

    // A step: pixels of an item whose texels are in 2x2 neighbouring blocks, and the fields that select these texels in the cache. x is a
    // column and y a row within a block.
    typedef struct packed {
        logic [3:0]           served;
        logic                 half;
        logic                 last;
        logic                 second;
        logic [1:0][1:0][3:0] weights;
        logic [1:0][1:0]      upper;
        logic [1:0][3:0]      parity;  // axis, slot: of the block's column or row
        logic [3:0][2:0]      x;
        logic [3:0][2:0]      y;
    } step_t;

    // The block columns and block rows of a step: the even one at index 0, the odd one at index 1. A class of blocks has the
    // number {parity of the row, parity of the column}.
    typedef struct packed {
        logic [3:0]           level;
        logic [1:0][1:0][7:0] places;  // axis, parity: the texel's column or row without the lowest two bits
    } blocks_t;

    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Clocks in texture_filter from a step to its light, and to its colours.
    localparam int unsigned LIGHT  = 5;
    localparam int unsigned FILTER = 9;
    // Maximum number of steps that wait for their texels in the sampler's queue.
    localparam int unsigned STEPS  = 256;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

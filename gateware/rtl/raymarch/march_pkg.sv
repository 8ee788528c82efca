// What the parts of the raymarcher have in common (docs/formats.md, "Distance fields").

`default_nettype none

package march_pkg;
    // Each module uses some.
    /* verilator lint_off UNUSEDPARAM */
    // t, u11.12; a coordinate of a point as fields see it, s10.12, and before that, s13.12; a direction, s1.17.
    localparam int unsigned T_BITS         = 23;
    localparam int unsigned POINT_BITS     = 22;
    localparam int unsigned WIDE_BITS      = 25;
    localparam int unsigned DIRECTION_BITS = 18;

    // A pixel: its band's parity, its line in the band, its column, and the eye: 0 the left one, or the only one.
    typedef struct packed {
        logic        odd;
        logic        eye;
        logic [5:0]  line;
        logic [10:0] column;
    } place_t;

    localparam int unsigned PLACE_BITS = 19;

    // A ray at its beginning.
    typedef struct packed {
        place_t                    place;
        logic [9:0]                length;
        logic [T_BITS-1:0]         start;
        logic [2:0][DIRECTION_BITS-1:0] direction;
    } ray_t;

    typedef enum logic [1:0] {MISS = 2'd0, HIT = 2'd1, UNDECIDED = 2'd2} state_t;

    // Its end. `surface` is {axis, positive}; `gap` and `slope` say how far it is from `t` and how steeply the ray goes there. Of a miss,
    // `t` is the sine above the horizon in 8 bits, 0 below it.
    typedef struct packed {
        place_t            place;
        logic [9:0]        length;
        logic [T_BITS-1:0] t;
        logic [7:0]        steps;
        state_t            state;
        logic [2:0]        surface;
        logic [11:0]       gap;
        logic [9:0]        slope;
    } end_t;
    localparam int unsigned END_BITS = PLACE_BITS + 10 + T_BITS + 8 + 2 + 3 + 12 + 10;

    // What there is; all of it holds while a frame is drawn.
    typedef struct packed {
        // A box, or else the sponge.
        logic                       is_box;
        // The sponge: which of its levels count, the first in bit 0, and half the side of the cubes that are left.
        logic [5:0]                 levels;
        logic [POINT_BITS-1:0]      cube_half;
        // The box: half its sides, which of them there are, whether the solid is what is outside, and whether it repeats itself.
        logic [2:0][POINT_BITS-1:0] box_half;
        logic [2:0]                 box_has;
        logic                       room;
        logic                       repeated;
    } solid_t;

    // How finely.
    typedef struct packed {
        logic [15:0]       threshold;
        logic [3:0]        footprint;
        logic [7:0]        cap;
        logic [T_BITS-1:0] far_limit;
    } tuning_t;

    // Clocks from a point to its distance, of fields with so many levels of the sponge, with boxes or without.
    function automatic int unsigned field_clocks(input int unsigned levels, input bit boxes);
        field_clocks = levels == 0 ? 3 : 3 * levels + 3 + (boxes ? 1 : 0);
    endfunction
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

// What the parts of the raymarcher have in common (docs/formats.md, "Distance fields").

`default_nettype none

package raymarch_pkg;
    // Each module uses some.
    /* verilator lint_off UNUSEDPARAM */
    // t, u11.12; a coordinate of a point as fields see it, s10.12, and before that, s13.12; a direction, s1.17.
    localparam int unsigned T_BITS         = 23;
    localparam int unsigned POINT_BITS     = 22;
    localparam int unsigned WIDE_BITS      = 25;
    localparam int unsigned DIRECTION_BITS = 18;
    // How much wider a cone gets with each step of t, u0.16.
    localparam int unsigned SPREAD_BITS    = 16;
    // The evaluations after which a cone ends at the latest.
    localparam int unsigned CONE_STEPS     = 192;

    // A pixel: its band's parity, its line in the band, its column, and the eye: 0 the left one, or the only one.
    typedef struct packed {
        logic        odd;
        logic        eye;
        logic [5:0]  line;
        logic [10:0] column;
    } place_t;

    localparam int unsigned PLACE_BITS = 19;

    // A ray at its beginning, or a cone: then its number is in the low bits of its place, and `spread` is not 0.
    typedef struct packed {
        logic [SPREAD_BITS-1:0]    spread;
        place_t                    place;
        logic [9:0]                length;
        logic [T_BITS-1:0]         start;
        logic [2:0][DIRECTION_BITS-1:0] direction;
    } ray_t;

    typedef enum logic [1:0] {MISS = 2'd0, HIT = 2'd1, UNDECIDED = 2'd2} state_t;

    // Its end. `surface` is {axis, positive}, or a sphere's number; `gap` and `slope` say how far the face is from `t` and how steeply the
    // ray goes there; only a sphere's light wants to know the direction. Between a face and a sphere, `face` is the former's {axis,
    // positive} and `share` is the latter's part, u0.8. Of a miss, `t` is the sine above the horizon in 8 bits, 0 below it.
    typedef struct packed {
        logic [2:0]        face;
        logic [7:0]        share;
        logic [2:0][DIRECTION_BITS-1:0] direction;
        logic              round;
        place_t            place;
        logic [9:0]        length;
        logic [T_BITS-1:0] t;
        logic [7:0]        steps;
        state_t            state;
        logic [2:0]        surface;
        logic [11:0]       gap;
        logic [9:0]        slope;
    } end_t;
    localparam int unsigned FLAT_END_BITS  = PLACE_BITS + 10 + T_BITS + 8 + 2 + 3 + 12 + 10;
    localparam int unsigned ROUND_END_BITS = FLAT_END_BITS + 1 + 3 * DIRECTION_BITS;
    localparam int unsigned END_BITS       = ROUND_END_BITS + 8 + 3;

    // What there is; all of it holds while a frame is drawn.
    typedef struct packed {
        // What is between what is flat and what is round: its width, u5.12, 0 where there is none, and 1 over twice that, u1.16.
        logic [16:0]                blend_width;
        logic [16:0]                blend_inverse;
        // Spheres: whether the flat solid is there beside them, whether there are any, whether they repeat themselves, and the last
        // one's number, 0 without them.
        logic                       flat_too;
        logic                       is_round;
        logic                       balls_repeated;
        logic [2:0]                 last_ball;
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

    // A sphere: its material, {blue, green, red}; the inverse of its radius and a shift (docs/formats.md, "Light"); its radius, and
    // its centre.
    typedef struct packed {
        logic [23:0]                material;
        logic [4:0]                 shift;
        logic [16:0]                inverse;
        logic [20:0]                radius;
        logic [2:0][POINT_BITS-1:0] centre;
    } ball_t;

    // The nearest sphere of those that have been looked at: its distance and its number.
    typedef struct packed {
        logic signed [POINT_BITS-1:0] distance;
        logic [2:0]                   number;
    } nearest_t;

    localparam int unsigned NEAREST_BITS = POINT_BITS + 3;

    // What shines on spheres: the last light's number, ambient light, and lights in their colours from their directions, s1.16.
    typedef struct packed {
        logic [1:0]            last_light;
        logic [23:0]           ambient;
        logic [3:0][23:0]      colours;
        logic [3:0][2:0][17:0] directions;
    } lights_t;

    // How finely.
    typedef struct packed {
        logic [15:0]       threshold;
        logic [3:0]        footprint;
        logic [7:0]        cap;
        logic [T_BITS-1:0] far_limit;
    } tuning_t;

    // The bits of an end that there are in a lane with spheres and fillets or without.
    function automatic int unsigned end_bits(input bit round, input bit blend);
        end_bits = blend ? END_BITS : round ? ROUND_END_BITS : FLAT_END_BITS;
    endfunction

    // Clocks from a point to its distance, of fields with so many levels of the sponge, with boxes, spheres and fillets or without.
    function automatic int unsigned flat_clocks(input int unsigned levels, input bit boxes);
        flat_clocks = levels == 0 ? 3 : 3 * levels + 3 + (boxes ? 1 : 0);
    endfunction
    function automatic int unsigned field_clocks(input int unsigned levels, input bit boxes, input bit round, input bit blend);
        field_clocks = flat_clocks(levels, boxes);
        if (round && field_clocks < 19) field_clocks = 19;
        if (round && (levels > 0 || boxes)) field_clocks = field_clocks + (blend ? 8 : 1);
    endfunction
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

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

    // The nearest sphere of those that have been looked at: its distance and its number.
    typedef struct packed {
        logic signed [POINT_BITS-1:0] distance;
        logic [2:0]                   number;
    } nearest_t;

    localparam int unsigned NEAREST_BITS = POINT_BITS + 3;

    // The bits of an end that there are in a lane with spheres and fillets or without.
    function automatic int unsigned end_bits(input bit round, input bit blend);
        end_bits = blend ? END_BITS : round ? ROUND_END_BITS : FLAT_END_BITS;
    endfunction

    // Clocks from a point to its distance: levels of the sponge, flat fields by their bits, spheres and fillets or none.
    function automatic int unsigned field_clocks(input int unsigned levels, input int unsigned fields, input bit round, input bit blend);
        field_clocks = fields_pkg::flat_clocks(levels, fields);
        if (round && field_clocks < 19) field_clocks = 19;
        if (round && fields != 0) field_clocks = field_clocks + (blend ? 8 : 1);
    endfunction
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

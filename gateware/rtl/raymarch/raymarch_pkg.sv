// Shared constants and types of the raymarcher (docs/formats/raymarch.md, "Distance fields").

`default_nettype none

package raymarch_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Widths of: the parameter T of a marching ray, u14.10; a point's coordinate at the input of a field, s10.12; an eye's coordinate, s13.12;
    // and a component of a ray's direction, s1.17.
    localparam int unsigned T_BITS         = 24;
    localparam int unsigned POINT_BITS     = 22;
    localparam int unsigned WIDE_BITS      = 25;
    localparam int unsigned DIRECTION_BITS = 18;
    // Width of T at the end of a ray, u14.14.
    localparam int unsigned END_T_BITS     = 28;

    // Position of a pixel: parity of its band's number, eye (0 for the left or only eye), line in the band, and column.
    typedef struct packed {
        logic        odd;
        logic        eye;
        logic [5:0]  line;
        logic [10:0] column;
    } place_t;

    localparam int unsigned PLACE_BITS = 19;

    // A marching ray before its first step; `height` is the result of sky_height. A ray with `over` does not meet the box around the field,
    // and its `start` has no meaning.
    typedef struct packed {
        logic                           over;
        logic [T_BITS-1:0]              start;
        place_t                         place;
        logic [7:0]                     height;
        logic [2:0][DIRECTION_BITS-1:0] direction;
    } ray_t;

    localparam int unsigned RAY_BITS = 1 + T_BITS + PLACE_BITS + 8 + 3 * DIRECTION_BITS;

    // The state of an end. SHADED is a hit on a face in the shadow of the first light. The lowest bit is 1 for hits.
    typedef enum logic [1:0] {MISS = 2'd0, HIT = 2'd1, UNDECIDED = 2'd2, SHADED = 2'd3} state_t;

    // The result of a ray that has ended at T = `t` after `steps` evaluations. `surface` is {axis, positive} of a face, or the number of a
    // sphere. For a miss, `t` holds the 8-bit result of sky_height. `round` marks an end on a sphere or a fillet; only the light on
    // spheres uses `direction`. On a fillet, `face` is the face's {axis, positive} and `share` is the sphere's weight, u0.8.
    typedef struct packed {
        logic [2:0]        face;
        logic [7:0]        share;
        logic [2:0][DIRECTION_BITS-1:0] direction;
        logic              round;
        place_t            place;
        logic [END_T_BITS-1:0] t;
        logic [7:0]        steps;
        state_t            state;
        logic [2:0]        surface;
    } end_t;
    localparam int unsigned EXIT_END_BITS  = PLACE_BITS + END_T_BITS + 8 + 2 + 3;
    localparam int unsigned ROUND_END_BITS = EXIT_END_BITS + 1 + 3 * DIRECTION_BITS;
    localparam int unsigned END_BITS       = ROUND_END_BITS + 8 + 3;

    // The nearest sphere among the spheres evaluated so far for a point: its distance and its number.
    typedef struct packed {
        logic signed [POINT_BITS-1:0] distance;
        logic [2:0]                   number;
    } nearest_t;

    localparam int unsigned NEAREST_BITS = POINT_BITS + 3;

    // Comparison of the low bits of two coordinates a and b: a > b, a = b, a > ~b, a = ~b. These results also determine the order of a and
    // b after mirroring, which complements all bits of a coordinate.
    typedef struct packed {
        logic above;
        logic equal;
        logic above_mirror;
        logic equal_mirror;
    } pair_t;

    // The comparisons of the low bits of three coordinates.
    typedef struct packed {
        pair_t z_x;
        pair_t z_y;
        pair_t x_y;
    } order_t;

    localparam int unsigned ORDER_BITS = 12;
    // Number of low bits that are compared.
    localparam int unsigned LOW_BITS   = 11;
    localparam order_t ALL_EQUAL = {3{4'b0101}};

    // Returns the comparison of b and a from the comparison of a and b.
    function automatic pair_t swapped(input pair_t pair);
        swapped = {!pair.above && !pair.equal, pair.equal, pair.above_mirror, pair.equal_mirror};
    endfunction

    // Returns the low bits of the coordinate that increases in the world direction `grow`, {axis, positive}.
    function automatic logic [LOW_BITS-1:0] low_part(input logic [2:0][LOW_BITS-1:0] low, input logic [2:0] grow);
        low_part = (grow[2] ? low[2] : grow[1] ? low[1] : low[0]) ^ {LOW_BITS{!grow[0]}};
    endfunction

    // Returns whether the low bits of a exceed the low bits of b. The low bits of a coordinate are mirrored if the coordinate is not
    // positive.
    function automatic logic low_above(input pair_t pair, input logic a_positive, input logic b_positive);
        unique case ({a_positive, b_positive})
            2'b11: low_above = pair.above;
            2'b00: low_above = !pair.above && !pair.equal;
            2'b10: low_above = pair.above_mirror;
            2'b01: low_above = !pair.above_mirror && !pair.equal_mirror;
        endcase
    endfunction

    // Returns the number of low bits of an end_t that a build uses, which depends on whether it has spheres (`round`) and fillets (`blend`).
    function automatic int unsigned end_bits(input bit round, input bit blend);
        end_bits = blend ? END_BITS : round ? ROUND_END_BITS : EXIT_END_BITS;
    endfunction

    // Returns the number of clocks from a point to its distance from a sponge with this number of levels, or from a box without levels.
    function automatic int unsigned flat_clocks(input int unsigned levels);
        flat_clocks = 3 * levels + 3;
    endfunction

    // The same with spheres, joined by a fillet.
    function automatic int unsigned field_clocks(input int unsigned levels);
        field_clocks = flat_clocks(levels);
        if (field_clocks < 19) field_clocks = 19;
        field_clocks = field_clocks + 8;
    endfunction
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

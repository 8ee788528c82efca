// Types of rays that leave empty prisms (docs/raymarch-exits.md).

`default_nettype none

package exit_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Widths of: the parameter T of a ray, u14.14; a coordinate from the solid's centre, s12.12; a coordinate of a point from the solid's
    // lower corner, s15.12; half the side of a solid, u9.12; the coordinate of a plane of the solid from its centre, s9.12; the magnitude
    // of a direction's component, u0.23, which stands for the middle of its interval.
    localparam int unsigned T_BITS      = 28;
    localparam int unsigned PLANE_BITS  = 25;
    localparam int unsigned POINT_BITS  = 28;
    localparam int unsigned HALF_BITS   = 21;
    localparam int unsigned BORDER_BITS = 22;
    localparam int unsigned SPEED_BITS  = 23;
    // Widths of a raymarch_pkg::place_t and of a component of a direction there. Yosys accepts no name of another package here.
    localparam int unsigned PLACE_BITS     = 19;
    localparam int unsigned DIRECTION_BITS = 18;

    // Width of an exit: T, and a bit before it that is set if the exit exceeds the range of T. Its other bits are then arbitrary.
    localparam int unsigned EXIT_BITS = T_BITS + 1;

    // The solids. BOX is the inside of a box, or of an octahedron, which is a box along its four diagonals; PLANES the outside of the slab
    // between two planes perpendicular to z, SPONGE the Menger sponge, and CUBES are boxes repeated every 64 units, or spheres in cubes. Boxes
    // have no gaps along an axis on which their side is this period.
    typedef enum logic [1:0] {BOX = 2'd0, PLANES = 2'd1, SPONGE = 2'd2, CUBES = 2'd3} rule_t;

    // A solid: its rule; the number of levels of a sponge, which is 1 of BOX for an octahedron and of CUBES for spheres; half its side along
    // each axis, for CUBES that of one box; and the coordinate of a plane perpendicular to each axis: of a box and of a sponge the lower plane,
    // of PLANES the upper one, and of cubes the lower plane of the cube after the middle one, all below 2^21 - 2^15.
    typedef struct packed {
        rule_t                              rule;
        logic [2:0]                         levels;
        logic [2:0][HALF_BITS-1:0]          half;
        logic [2:0][BORDER_BITS-1:0]        border;
    } solid_t;

    // The interval of a coordinate between the planes of a solid, as a number that increases with the coordinate. The highest bit is 0
    // below the solid. The digits, the other bits, are
    // - for a sponge, the ternary digits of the smallest cell in two bits each, the first digit 3 above the sponge. A sponge of up to four
    //   levels has cells of 2^12 units of 2^-12 and four digits, one of five or six levels cells of 2^9 units and six digits;
    // - for a box and for planes, 0 inside, and ABOVE above;
    // - for cubes, the number of the cell in six bits, and a digit of two bits: 0 in the cube, 1 in the gap above the cube, and 2 after the
    //   gap. Cell -1 is all ones after a highest bit of 0, and cell 32 is beyond the far limit.
    // All other bits are 0.
    localparam int unsigned DIGIT_BITS    = 12;
    localparam int unsigned INTERVAL_BITS = 1 + DIGIT_BITS;
    localparam logic [DIGIT_BITS-1:0] ABOVE = 12'hC00;

    // The reciprocal of the magnitude of a direction's component: factor·2^-22·2^(8·scale), in the order {scale, factor}.
    localparam int unsigned FACTOR_BITS  = 30;
    localparam int unsigned SCALE_BITS   = 2;
    localparam int unsigned INVERSE_BITS = SCALE_BITS + FACTOR_BITS;

    // The square of a direction's length, of a lattice of spheres: the direction is doubled, `doublings` times, until its length is from 1 to
    // 2. `square` is the square of this length, u2.15. The reciprocal of this square, times 2^doublings, is
    // (1 + mantissa·2^-18)·2^(exponent - 2), the mantissa with a sign.
    localparam int unsigned DOUBLINGS_BITS = 2;
    localparam int unsigned SQUARE_BITS    = 17;
    localparam int unsigned MANTISSA_BITS  = 18;
    localparam int unsigned EXPONENT_BITS  = 3;

    typedef struct packed {
        logic [DOUBLINGS_BITS-1:0] doublings;
        logic [SQUARE_BITS-1:0]    square;
    } length_t;

    typedef struct packed {
        logic [EXPONENT_BITS-1:0] exponent;
        logic [MANTISSA_BITS-1:0] mantissa;
    } inverse_square_t;

    localparam int unsigned LENGTH_BITS         = DOUBLINGS_BITS + SQUARE_BITS;
    localparam int unsigned INVERSE_SQUARE_BITS = EXPONENT_BITS + MANTISSA_BITS;

    // The first sphere that a ray meets: whether there is one (`met`), its number, and T at the sphere, or the far limit.
    typedef struct packed {
        logic              met;
        logic [2:0]        number;
        logic [T_BITS-1:0] t;
    } meeting_t;

    localparam int unsigned MEETING_BITS = 1 + 3 + T_BITS;

    // A ray before its first evaluation; `place` is a raymarch_pkg::place_t. Axes along which it leads down are mirrored (`down`). `start`
    // is its T, `axis` the axis of the last plane that it has crossed, and `reached` has the intervals that it has reached, 0 where it has
    // crossed no plane. `height` is that of sky_height. A ray with `over` hits no flat solid; it ends without an evaluation. Other rays
    // start within their limit. In a build with spheres, `sphere` is the first one that the ray meets, and its T is the limit. Only rays in
    // a lattice have `inverse_square` and `length`. In an octahedron, the axes are the diagonals (-1, 1, 1), (1, -1, 1) and (1, 1, -1), each
    // divided by 4; the fourth, axis 3, is their sum, and `down_sum` says whether the ray leads down along it.
    typedef struct packed {
        meeting_t                      sphere;
        inverse_square_t               inverse_square;
        length_t                       length;
        logic                          down_sum;
        logic                          over;
        logic [PLACE_BITS-1:0]         place;
        logic [T_BITS-1:0]             start;
        logic [1:0]                    axis;
        logic [2:0][INTERVAL_BITS-1:0] reached;
        logic [2:0]                    down;
        logic [7:0]                    height;
        logic [2:0][SPEED_BITS-1:0]    speed;
        logic [2:0][INVERSE_BITS-1:0]  inverse;
    } ray_t;

    // Width of a ray without `sphere`, with faces perpendicular to axes, in an octahedron, and in a lattice.
    localparam int unsigned RAY_BITS = 1 + PLACE_BITS + T_BITS + 2 + 3 * INTERVAL_BITS + 3 + 8 + 3 * SPEED_BITS + 3 * INVERSE_BITS;
    localparam int unsigned DIAGONAL_RAY_BITS = RAY_BITS + 1;
    localparam int unsigned LATTICE_RAY_BITS  = DIAGONAL_RAY_BITS + LENGTH_BITS + INVERSE_SQUARE_BITS;

    // The terms of the quadratic equation of a ray in the box about a sphere of a lattice: q·D with the doubled direction, s7.14 without its
    // sign, which is negative; the complement of the square of the root, u12.20; and the reciprocal of the square of D.
    localparam int unsigned ALONG_BITS = 21;
    localparam int unsigned REST_BITS  = 32;

    typedef struct packed {
        inverse_square_t         inverse_square;
        logic [ALONG_BITS-1:0]   along;
        logic [REST_BITS-1:0]    rest;
    } equation_t;

    localparam int unsigned EQUATION_BITS = INVERSE_SQUARE_BITS + ALONG_BITS + REST_BITS;

    // The point of a hit, for a ray to the light: along each mirrored axis, the coordinate from the solid's lower corner, u7.12, 0 if it is
    // negative; and the mirrored axes.
    localparam int unsigned SPOT_BITS = 19;

    typedef struct packed {
        logic [2:0]                down;
        logic [2:0][SPOT_BITS-1:0] at;
    } spot_t;

    localparam int unsigned HIT_SPOT_BITS = 3 + 3 * SPOT_BITS;

    // The end of a ray: whether it has hit the solid, at which T (without a hit, its limit if rays have limits of their own, and any T
    // otherwise), the axis and the sign of the face's outward normal, the number of evaluations, and the ray's `height`. In a build with
    // spheres, `met` and `number` are those of the sphere that the ray meets at its limit, and `direction` is the ray's, s1.17. A hit on a
    // sphere of a lattice is `round`; its axis and sign have no meaning. Where the ray `lands`, T is that of the box about the sphere, and
    // `equation` determines that of the sphere: exit_landing adds the difference. In a build with spheres of both kinds, `limit` is the T at
    // which the ray meets the sphere of a list, or the far limit. In a build with shadows, `spot` is the point of a hit, until exit_shadow
    // replaces `height` of a hit by 1 in the shadow, and by 0 in the light.
    typedef struct packed {
        spot_t                 spot;
        logic [T_BITS-1:0]     limit;
        equation_t             equation;
        logic                  lands;
        logic [2:0][DIRECTION_BITS-1:0] direction;
        logic                  met;
        logic [2:0]            number;
        logic                  round;
        logic [PLACE_BITS-1:0] place;
        logic                  hit;
        logic [T_BITS-1:0]     t;
        logic [1:0]            axis;
        logic                  positive;
        logic [7:0]            steps;
        logic [7:0]            height;
    } end_t;

    // Width of an end on a flat solid, of one on any solid, of one that may land, and of one that may land before its limit.
    localparam int unsigned FLAT_END_BITS  = PLACE_BITS + 1 + T_BITS + 2 + 1 + 8 + 8;
    localparam int unsigned ROUND_END_BITS = FLAT_END_BITS + 1 + 4 + 3 * DIRECTION_BITS;
    localparam int unsigned LAND_END_BITS  = ROUND_END_BITS + 1 + EQUATION_BITS;
    localparam int unsigned LIMIT_END_BITS = LAND_END_BITS + T_BITS;
    localparam int unsigned END_BITS       = LIMIT_END_BITS + HIT_SPOT_BITS;

    // Returns the number of low bits of an end_t that a lane uses, which depends on whether there are spheres of a list (`round`) and of a
    // lattice. `spot` is apart.
    function automatic int unsigned end_bits(input bit round, input bit lattice);
        end_bits = lattice && round ? LIMIT_END_BITS : lattice ? LAND_END_BITS : round ? ROUND_END_BITS : FLAT_END_BITS;
    endfunction

    // The code of an octahedron's face, as in raymarch_pkg::end_t: bit i is set if component i of the outward normal is positive. `axis` is
    // that of an end, and `positive` is set if the normal leads up along it.
    function automatic logic [2:0] octant(input logic [1:0] axis, input logic positive);
        octant = {axis == 2'd2, axis == 2'd1, axis == 2'd0} ^ {3{positive}};
    endfunction
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

// Constants and types of rays by exits, which leave a whole empty prism in each evaluation (docs/raymarch-exits.md).

`default_nettype none

package exit_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Widths of: the parameter T of a ray, u14.14; a coordinate relative to the solid's centre, s12.12; a point's coordinate relative to
    // the solid's lower corner, s15.12; half the side of a solid, u9.12; a plane's coordinate relative to the solid's centre, s9.12; the
    // magnitude of a component of a direction, u0.23, where the integer k stands for k + 1/2.
    localparam int unsigned T_BITS      = 28;
    localparam int unsigned PLANE_BITS  = 25;
    localparam int unsigned POINT_BITS  = 28;
    localparam int unsigned HALF_BITS   = 21;
    localparam int unsigned BORDER_BITS = 22;
    localparam int unsigned SPEED_BITS  = 23;
    // Copies of PLACE_BITS and DIRECTION_BITS of raymarch_pkg, because Yosys accepts no name of another package here.
    localparam int unsigned PLACE_BITS     = 19;
    localparam int unsigned DIRECTION_BITS = 18;

    // Width of an exit: T, and above it a bit that is set if the exit exceeds the range of T. The bits of T are then arbitrary.
    localparam int unsigned EXIT_BITS = T_BITS + 1;

    // The solids. BOX is the inside of a box, or of an octahedron, which is handled as a box with four axes, its diagonals. PLANES is the
    // outside of the slab between two planes perpendicular to z. SPONGE is the Menger sponge. CUBES are boxes repeated every 64 field
    // units, or spheres in such cubes. Boxes have no gaps along an axis along which their side is 64 units.
    typedef enum logic [1:0] {BOX = 2'd0, PLANES = 2'd1, SPONGE = 2'd2, CUBES = 2'd3} rule_t;

    // A solid: its rule; the number of levels of a sponge (for BOX, 1 selects the octahedron; for CUBES, 1 selects spheres); half its side
    // along each axis, or half the side of one box for CUBES; and the coordinate of one plane perpendicular to each axis, below 2^21 -
    // 2^15: the lower plane of a box or sponge, the upper plane of PLANES, and for CUBES the lower plane of the cube after the middle cube.
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

    // The reciprocal of the magnitude of a component of a direction, factor·2^-22·2^(8·scale), as {scale, factor}.
    localparam int unsigned FACTOR_BITS  = 30;
    localparam int unsigned SCALE_BITS   = 2;
    localparam int unsigned INVERSE_BITS = SCALE_BITS + FACTOR_BITS;

    // The square of a direction's length, for lattices of spheres. The direction is doubled `doublings` times, so that its length is at
    // least 1 and below 2; `square` is the square of this length, u2.15. The reciprocal of this square, times 2^doublings, is (1 +
    // mantissa·2^-18)·2^(exponent - 2), with a signed mantissa.
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

    // The first sphere that a ray meets: whether the ray meets a sphere (`met`), the number of the sphere, and T at the
    // sphere, or the far limit if there is none.
    typedef struct packed {
        logic              met;
        logic [2:0]        number;
        logic [T_BITS-1:0] t;
    } meeting_t;

    localparam int unsigned MEETING_BITS = 1 + 3 + T_BITS;

    // A ray before its first evaluation; `place` is a raymarch_pkg::place_t. `down` marks the axes along which the ray's coordinate
    // decreases; these axes are mirrored. `start` is the ray's T, `axis` the axis of the last plane that it has crossed. `reached` has the
    // intervals that it has reached, 0 along an axis without a crossed plane. `height` is the result of sky_height. A ray with `over` hits
    // no flat solid, and ends without an evaluation; the T of any other ray is within its limit. In a build with spheres, `sphere` is the
    // first sphere that the ray meets, and the T of `sphere` is the limit. `inverse_square` and `length` are defined only for lattices. For
    // an octahedron, the axes are the diagonals (-1, 1, 1), (1, -1, 1) and (1, 1, -1), each divided by 4; the fourth axis, number 3, is
    // their sum, and `down_sum` is high if the ray's coordinate along it decreases.
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

    // Widths of a ray without `sphere`, for solids with faces perpendicular to the axes, for octahedra and for lattices.
    localparam int unsigned RAY_BITS = 1 + PLACE_BITS + T_BITS + 2 + 3 * INTERVAL_BITS + 3 + 8 + 3 * SPEED_BITS + 3 * INVERSE_BITS;
    localparam int unsigned DIAGONAL_RAY_BITS = RAY_BITS + 1;
    localparam int unsigned LATTICE_RAY_BITS  = DIAGONAL_RAY_BITS + LENGTH_BITS + INVERSE_SQUARE_BITS;

    // The terms of the quadratic equation for T of a ray in the box around a sphere of a lattice: q·D with the doubled direction, s7.14
    // without its sign bit, which is always 1; the complement of the number whose root is to be computed, u12.20; and the reciprocal of the
    // square of D's length.
    localparam int unsigned ALONG_BITS = 21;
    localparam int unsigned REST_BITS  = 32;

    typedef struct packed {
        inverse_square_t         inverse_square;
        logic [ALONG_BITS-1:0]   along;
        logic [REST_BITS-1:0]    rest;
    } equation_t;

    localparam int unsigned EQUATION_BITS = INVERSE_SQUARE_BITS + ALONG_BITS + REST_BITS;

    // The point of a hit, at which a ray to the light begins: its coordinates along the mirrored axes, relative to the solid's lower
    // corner, u7.12, with negative values replaced by 0; and the mask of the mirrored axes.
    localparam int unsigned SPOT_BITS = 19;

    typedef struct packed {
        logic [2:0]                down;
        logic [2:0][SPOT_BITS-1:0] at;
    } spot_t;

    localparam int unsigned HIT_SPOT_BITS = 3 + 3 * SPOT_BITS;

    // The end of a ray: whether it has hit the solid, its T, the axis and the sign of the face's outward normal, the number of evaluations,
    // and the ray's `height`. Without a hit, T is the ray's limit if each ray has its own limit, and undefined otherwise. In a build with
    // spheres, `met` and `number` describe the sphere that the ray meets at its limit, and `direction` is the ray's direction, s1.17. A hit
    // on a sphere of a lattice is marked by `round`; its axis and sign have no meaning. If `lands` is high, T is still the T at the box
    // around the sphere, and `equation` determines the T at the sphere: exit_landing adds the difference. In a build with both kinds of
    // spheres, `limit` is the T at which the ray meets the sphere of a list, or the far limit. In a build with shadows, `spot` is the point
    // of a hit; exit_shadow replaces the `height` of a hit by 1 in the shadow, and by 0 in the light.
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

    // Widths of an end in a build with flat solids only, with spheres of a list, with a lattice, and with both kinds of
    // spheres; and of a whole end_t.
    localparam int unsigned FLAT_END_BITS  = PLACE_BITS + 1 + T_BITS + 2 + 1 + 8 + 8;
    localparam int unsigned ROUND_END_BITS = FLAT_END_BITS + 1 + 4 + 3 * DIRECTION_BITS;
    localparam int unsigned LAND_END_BITS  = ROUND_END_BITS + 1 + EQUATION_BITS;
    localparam int unsigned LIMIT_END_BITS = LAND_END_BITS + T_BITS;
    localparam int unsigned END_BITS       = LIMIT_END_BITS + HIT_SPOT_BITS;

    // Returns the number of low bits of an end_t that a lane uses, which depends on whether there are spheres of a list (`round`) and of a
    // lattice. The field `spot` is not included.
    function automatic int unsigned end_bits(input bit round, input bit lattice);
        end_bits = lattice && round ? LIMIT_END_BITS : lattice ? LAND_END_BITS : round ? ROUND_END_BITS : FLAT_END_BITS;
    endfunction

    // Returns the code of an octahedron's face, as in raymarch_pkg::end_t: bit i is set if component i of the outward normal is positive.
    // `axis` is the axis of an end, and `positive` is high if the normal's component along this axis is positive.
    function automatic logic [2:0] octant(input logic [1:0] axis, input logic positive);
        octant = {axis == 2'd2, axis == 2'd1, axis == 2'd0} ^ {3{positive}};
    endfunction
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

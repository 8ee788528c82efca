// Lane of the raymarcher for solids with flat faces: a ring-shaped pipeline in which rays circulate, one evaluation in each round. An
// evaluation moves a ray to the end of the empty prism around its point (docs/raymarch-exits.md).
//
//   rays ──▶ slot ─▶ O + T·D ─▶ exit_borders ─▶ exit_quotient for each axis ─▶ exit_choice ─▶ hit? miss? ─┐
//             ▲                                                                                            ├─▶ fifo ─▶ ends
//             └──────────────────────── larger of T and the exit ◀────────────────────────────────────────┘
//
// The ring has SLOTS slots and never stalls. In the diagram, O is the position of the eye relative to the solid's lower corner, along
// the ray's mirrored axes; D has the magnitudes of the components of the ray's direction, and T is the ray's parameter. The point is
// computed again in each round, so errors do not accumulate. The interval numbers of a ray never decrease, and each evaluation increases
// at least one of them, so every ray ends.
//
// A slot whose ray ends receives the next ray in the same clock. A ray enters only if the FIFO of ends has a free entry for its end: the
// FIFO has PLACES entries, and each ray in the ring reserves one. `evaluates` is high in clocks in which a ray begins an evaluation,
// `waits` in clocks in which an empty slot cannot receive a ray because the FIFO has no free entry.
//
// With LATTICE, the repeated solids may be spheres instead of cubes. In the box around a sphere, a ray meets the sphere if the quadratic
// equation for T has solutions (`meets`). The end of such a ray contains the terms of the equation, from which exit_landing computes T.
//
// With OCTAHEDRON, a box may have a fourth pair of faces, perpendicular to the sum of its axes. A ray has already entered the slab of this
// pair when it leaves the prism around the eye (exit_start), so only the upper border of the slab is compared.
//
// With SPOT, the end of a ray includes the point of its hit. With CARRIED other than 0, the lane evaluates the rays from these points to
// the light (exit_shadow): each ray has its own origin, and CARRIED bits of the user travel with it. Only the field `hit` of these ends is
// defined. All these rays have the direction of `in_ray`, which must hold while rays are in the ring.
//
// Streams are valid/ready: each item moves in a clock in which both are high, payloads stay until then, and ready comes directly from
// registers. Parameters hold while rays are in the ring. `origins` has the position of each eye relative to the solid's centre. `rst`
// discards all rays.

`default_nettype none

module exit_lane #(
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1,
    parameter bit          STEREO = 1'b1,
    // Whether rays may meet spheres of a list. Each ray then has its own limit; otherwise `far_t` is the limit of all rays.
    parameter bit          ROUND  = 1'b0,
    // Whether there may be spheres of a lattice, with BOXES.
    parameter bit          LATTICE = 1'b0,
    // Whether there may be an octahedron, with BOXES.
    parameter bit          OCTAHEDRON = 1'b0,
    parameter bit SPOT = 1'b0,
    parameter int unsigned CARRIED = 0,
    // Depth of the FIFO of ends. The depth exceeds the number of slots, because some slots would otherwise stay empty.
    parameter int unsigned PLACES = 32
) (
    input  wire                                           clk,
    input  wire                                           rst,
    input  wire  [1:0][2:0][exit_pkg::PLANE_BITS-1:0]     origins,
    input  wire exit_pkg::solid_t                         solid,
    input  wire  [exit_pkg::T_BITS-1:0]                   far_t,
    // Rays.
    input  wire                                           in_valid,
    output logic                                          in_ready,
    input  wire exit_pkg::ray_t                           in_ray,
    // With CARRIED, the origin of the ray relative to the solid's centre.
    input  wire  [2:0][exit_pkg::PLANE_BITS-1:0]          in_origin,
    input  wire  [(CARRIED == 0 ? 1 : CARRIED)-1:0]       in_carried,
    // Ends.
    output logic                                          out_valid,
    input  wire                                           out_ready,
    output exit_pkg::end_t                                out_end,
    output logic [(CARRIED == 0 ? 1 : CARRIED)-1:0]       out_carried,
    // Events.
    output logic                                          evaluates,
    output logic                                          waits
);
    // Stages of the ring; the suffix of a name is the stage in which it is valid. LAST is the last stage.
    localparam int unsigned LAST       = 22;
    localparam int unsigned SLOTS      = LAST + 1;
    localparam int unsigned SLOT_BITS  = $clog2(SLOTS);
    localparam int unsigned COUNT_BITS = $clog2(PLACES + 1);

    logic [LAST:0]         occupied;
    logic [COUNT_BITS-1:0] places;
    logic                  enter, finished, again, ended, end_ready, gone_out;

    // Spheres of a lattice: whether the solid consists of them, whether a ray in the box around a sphere meets the
    // sphere (`meets`), and whether its T is still to be computed from `equation` (`lands`).
    logic               is_lattice, meets_21, lands_22;
    exit_pkg::equation_t equation_22;

    // An octahedron: whether the point is above the fourth slab, and whether the ray's coordinate along its axis decreases.
    logic beyond_21, down_sum_22;

    // State of a ray: its T, the axis of the last plane that it has crossed, the number of its evaluations including this round,
    // and whether it ends without an evaluation (`over`).
    logic [exit_pkg::T_BITS-1:0] t_0, t_21, t_22;
    logic [1:0]                  axis_0, axis_21, axis_22;
    logic [7:0]                  steps_0, steps_21, steps_22;
    logic                        over_0, over_21, over_22;

    // The exit from the prism around the point.
    logic [exit_pkg::EXIT_BITS-1:0] exit_21;
    logic [exit_pkg::T_BITS-1:0]    exit_22;
    logic [1:0]                     exit_axis_21, exit_axis_22;
    logic [2:0]                     crossed_21, crossed_22;
    logic                           hit_22, left_22, later_22;
    exit_pkg::end_t                 end_in;

    assign again    = occupied[LAST] && !finished;
    assign ended    = occupied[LAST] && finished;
    assign in_ready = !again && places != '0;
    assign enter    = in_valid && in_ready;
    assign gone_out = out_valid && out_ready;

    // T never decreases, although rounding may place an exit before the previous exit.
    always_ff @(posedge clk) begin
        occupied <= {occupied[LAST-1:0], again || enter};
        over_0   <= !again && in_ray.over;
        t_0      <= !again ? in_ray.start : later_22 ? exit_22 : t_22;
        axis_0   <= !again ? in_ray.axis : exit_axis_22;
        steps_0  <= (again ? steps_22 : '0) + 8'(again || !in_ray.over);
        if (enter != gone_out) places <= enter ? places - 1'b1 : places + 1'b1;

        evaluates <= occupied[0] && !over_0;
        waits     <= in_valid && !again && places == '0;

        if (rst) begin
            occupied <= '0;
            places   <= COUNT_BITS'(PLACES);
        end
    end

    // Values of the rays in the ring. A word of LUT memory for each slot is written when a ray enters, or at the end or beginning of a
    // round. Each stage that reads values has its own memory, and knows the number of the slot in this stage. Writes to an empty slot are
    // allowed.
    logic [SLOT_BITS-1:0] slot_0, slot_8, slot_12, slot_13, slot_14, slot_21, slot_22;

    function automatic logic [SLOT_BITS-1:0] following(input logic [SLOT_BITS-1:0] slot);
        following = slot == SLOT_BITS'(SLOTS - 1) ? '0 : slot + 1'b1;
    endfunction

    // A ray that is in the last stage enters the first stage with the next clock.
    always_ff @(posedge clk) begin
        slot_0  <= slot_22;
        slot_8  <= following(slot_8);
        slot_12 <= following(slot_12);
        slot_13 <= slot_12;
        slot_14 <= slot_13;
        slot_21 <= following(slot_21);
        slot_22 <= slot_21;
        if (rst) begin
            {slot_0, slot_8, slot_12}  <= {SLOT_BITS'(0), SLOT_BITS'(SLOTS - 8), SLOT_BITS'(SLOTS - 12)};
            {slot_13, slot_14}         <= {SLOT_BITS'(SLOTS - 13), SLOT_BITS'(SLOTS - 14)};
            {slot_21, slot_22}         <= {SLOT_BITS'(SLOTS - 21), SLOT_BITS'(SLOTS - 22)};
        end
    end

    localparam int unsigned AIM_BITS   = 4 + 3 * exit_pkg::SPEED_BITS;
    localparam int unsigned CARGO_BITS = raymarch_pkg::PLACE_BITS + 3 + 8;
    localparam int unsigned STATE_BITS = exit_pkg::T_BITS + 2 + 8 + 1;

    (* ram_style = "distributed" *) logic [CARGO_BITS-1:0]               cargos   [0:2**SLOT_BITS-1];
    (* ram_style = "distributed" *) logic [STATE_BITS-1:0]               states   [0:2**SLOT_BITS-1];

    logic                                   eye_0, eye_4, eye_13;
    logic [2:0]                             down_0, down_4, down_13, down_22;
    logic [2:0][exit_pkg::SPEED_BITS-1:0]   speed_0, speed_1;
    logic [2:0][exit_pkg::INVERSE_BITS-1:0] inverse_14;
    logic [raymarch_pkg::PLACE_BITS-1:0]    place_22;
    logic [7:0]                             height_22;

    if (CARRIED != 0) begin : one_direction
        assign {eye_0, down_0, speed_0} = {1'b0, in_ray.down, in_ray.speed};
        assign inverse_14               = in_ray.inverse;

        wire _unused = &{1'b0, slot_14};
    end else begin : own_directions
        (* ram_style = "distributed" *) logic [AIM_BITS-1:0]                 aims     [0:2**SLOT_BITS-1];
        (* ram_style = "distributed" *) logic [3*exit_pkg::INVERSE_BITS-1:0] inverses [0:2**SLOT_BITS-1];

        always_ff @(posedge clk) begin
            if (!again) aims[slot_22]     <= {in_ray.place[17], in_ray.down, in_ray.speed};
            if (!again) inverses[slot_22] <= in_ray.inverse;
        end
        assign {eye_0, down_0, speed_0} = aims[slot_0];
        assign inverse_14               = inverses[slot_14];
    end

    assign {place_22, down_22, height_22}       = cargos[slot_22];
    assign {t_21, axis_21, steps_21, over_21}   = states[slot_21];

    always_ff @(posedge clk) begin
        if (!again) cargos[slot_22] <= {in_ray.place, in_ray.down, in_ray.height};
        states[slot_0] <= {t_0, axis_0, steps_0, over_0};
        {t_22, axis_22, steps_22, over_22} <= {t_21, axis_21, steps_21, over_21};
    end

    // The limit of T, and the T of an end, which is the limit for a ray without a hit.
    logic [exit_pkg::T_BITS-1:0] limit_21, end_t_22;
    exit_pkg::meeting_t          sphere_22;

    if (ROUND) begin : own_limits
        (* ram_style = "distributed" *) logic [exit_pkg::MEETING_BITS-1:0] meetings [0:2**SLOT_BITS-1];
        exit_pkg::meeting_t sphere_21;

        assign sphere_21 = meetings[slot_21];
        assign limit_21  = sphere_21.t;
        assign end_t_22  = end_in.hit ? t_22 : sphere_22.t;

        always_ff @(posedge clk) begin
            if (!again) meetings[slot_22] <= in_ray.sphere;
            sphere_22 <= sphere_21;
        end
        wire _unused = &{1'b0, far_t};
    end else begin : one_limit
        assign limit_21  = far_t;
        assign end_t_22  = t_22;
        assign sphere_22 = '0;

        wire _unused = &{1'b0, in_ray.sphere, sphere_22.t};
    end

    // The light on a sphere needs the ray's direction.
    localparam int unsigned SIZE_BITS = exit_pkg::DIRECTION_BITS - 1;
    logic [2:0][exit_pkg::DIRECTION_BITS-1:0] direction_22;

    if (ROUND || LATTICE) begin : directions
        for (genvar i = 0; i < 3; i++) begin : axes
            (* ram_style = "distributed" *) logic [SIZE_BITS-1:0] sizes [0:2**SLOT_BITS-1];

            assign direction_22[i] = {1'b0, sizes[slot_22]} ^ {exit_pkg::DIRECTION_BITS{down_22[i]}};

            always_ff @(posedge clk) if (!again) sizes[slot_22] <= in_ray.speed[i][exit_pkg::SPEED_BITS-1 -: SIZE_BITS];
        end
    end else begin : no_directions
        assign direction_22 = '0;
    end

    delay #(.WIDTH(4), .CLOCKS(4)) signs (.clk, .enable(1'b1), .in({eye_0, down_0}), .out({eye_4, down_4}));
    delay #(.WIDTH(4), .CLOCKS(9)) signs_wait (.clk, .enable(1'b1), .in({eye_4, down_4}), .out({eye_13, down_13}));

    // The eye, or the origin of a ray to the light, relative to the solid's centre.
    logic [2:0][exit_pkg::PLANE_BITS-1:0] place_4, place_13;

    if (CARRIED != 0) begin : own_origins
        (* ram_style = "distributed" *) logic [3*exit_pkg::PLANE_BITS-1:0] near_places [0:2**SLOT_BITS-1];
        (* ram_style = "distributed" *) logic [3*exit_pkg::PLANE_BITS-1:0] far_places  [0:2**SLOT_BITS-1];

        logic [SLOT_BITS-1:0] slot_4;

        assign place_4  = near_places[slot_4];
        assign place_13 = far_places[slot_13];

        always_ff @(posedge clk) begin
            slot_4 <= following(slot_4);
            if (rst) slot_4 <= SLOT_BITS'(SLOTS - 4);
            if (!again) near_places[slot_22] <= in_origin;
            if (!again) far_places[slot_22]  <= in_origin;
        end
        wire _unused = &{1'b0, origins, eye_4, eye_13};
    end else begin : eyes
        assign place_4  = STEREO && eye_4 ? origins[1] : origins[0];
        assign place_13 = STEREO && eye_13 ? origins[1] : origins[0];

        wire _unused = &{1'b0, in_origin};
    end

    // The point O + T·D, from two products for each axis, rounded down, or to nearest in a lattice. O is half the side plus or minus the
    // eye's position. One extra bit below the lowest bit of these sums adds the 1 of the two's complement.
    logic [10:0] t_high_1;
    logic [2:0][exit_pkg::POINT_BITS-1:0] point_5;

    always_ff @(posedge clk) begin
        speed_1  <= speed_0;
        t_high_1 <= t_0[27:17];
    end

    for (genvar i = 0; i < 3; i++) begin : axes
        logic signed [47:0] low_3;
        logic signed [42:0] high_4;
        logic signed [exit_pkg::PLANE_BITS:0] origin_4;
        logic                                 unused_5;

        assign origin_4 = {place_4[i], 1'b0} ^ {exit_pkg::PLANE_BITS + 1{down_4[i]}};

        multiply_add low_part (
            .clk, .enable(1'b1), .a({1'b0, speed_0[i], 1'b1}), .b({1'b0, t_0[16:0]}), .c({1'b0, solid.half[i], is_lattice, 25'd0}), .p(low_3)
        );
        multiply_add #(.BITS(43)) high_part (
            .clk, .enable(1'b1), .a({1'b0, speed_1[i], 1'b1}), .b({7'd0, t_high_1}), .c({12'd0, low_3[47:17]}), .p(high_4)
        );
        always_ff @(posedge clk)
            {point_5[i], unused_5} <= {1'b0, high_4[35:9], 1'b1} + (exit_pkg::POINT_BITS + 1)'(origin_4);

        wire _unused = &{1'b0, low_3[16:0], high_4[42:36], high_4[8:0], unused_5};
    end

    // The planes around the point.
    logic [2:0][exit_pkg::INTERVAL_BITS-1:0] reached_8, next_12;
    logic [2:0] over_6, there_12, there_19, above_12, above_21;
    logic [1:0] choice_12, choice_19;
    logic       hit_12, hit_21, gone_12, gone_21;
    logic [2:0][exit_pkg::PLANE_BITS-1:0] at_13, distance_14;
    logic [2:0][exit_pkg::EXIT_BITS-1:0]  exit_19;

    exit_borders #(.LEVELS(LEVELS), .BOXES(BOXES), .LATTICE(LATTICE)) borders (
        .clk, .solid, .point(point_5), .reached_3(reached_8), .next(next_12), .there(there_12), .choice(choice_12), .above(above_12),
        .hit(hit_12), .gone(gone_12), .at(at_13), .over(over_6)
    );

    delay #(.WIDTH(5), .CLOCKS(7)) choice_waits (.clk, .enable(1'b1), .in({there_12, choice_12}), .out({there_19, choice_19}));
    delay #(.WIDTH(5), .CLOCKS(9)) ends_wait (.clk, .enable(1'b1), .in({above_12, hit_12, gone_12}), .out({above_21, hit_21, gone_21}));

    // Spheres of a lattice. Each axis has its own memory for its component of D, because the axes are processed in successive clocks.
    if (LATTICE) begin : lattice
        (* ram_style = "distributed" *) logic [exit_pkg::SPEED_BITS-1:0]          speeds_x  [0:2**SLOT_BITS-1];
        (* ram_style = "distributed" *) logic [exit_pkg::SPEED_BITS-1:0]          speeds_y  [0:2**SLOT_BITS-1];
        (* ram_style = "distributed" *) logic [exit_pkg::SPEED_BITS-1:0]          speeds_z  [0:2**SLOT_BITS-1];
        (* ram_style = "distributed" *) logic [exit_pkg::LENGTH_BITS-1:0]         lengths   [0:2**SLOT_BITS-1];
        (* ram_style = "distributed" *) logic [exit_pkg::INVERSE_SQUARE_BITS-1:0] quotients [0:2**SLOT_BITS-1];
        (* ram_style = "distributed" *) logic [exit_pkg::ALONG_BITS-1:0]          alongs    [0:2**SLOT_BITS-1];
        (* ram_style = "distributed" *) logic [exit_pkg::REST_BITS:0]             rests     [0:2**SLOT_BITS-1];

        logic [SLOT_BITS-1:0]            slot_7, slot_9, slot_15, slot_16;
        logic [exit_pkg::ALONG_BITS-1:0] along_13;
        logic [exit_pkg::REST_BITS-1:0]  rest_16;
        logic                            starts_16, meets_17;

        exit_sphere sphere (
            .clk, .half(solid.half[0]), .point(point_5), .over_1(over_6), .speed_x_2(speeds_x[slot_7]), .speed_y_3(speeds_y[slot_8]),
            .speed_z_4(speeds_z[slot_9]), .length_7(lengths[slot_12]), .along(along_13), .rest(rest_16), .starts(starts_16),
            .meets(meets_17)
        );
        delay #(.WIDTH(1), .CLOCKS(4)) meets_waits (.clk, .enable(1'b1), .in(meets_17), .out(meets_21));

        always_ff @(posedge clk) begin
            is_lattice <= solid.rule == exit_pkg::CUBES && solid.levels[0];
            slot_7     <= following(slot_7);
            slot_9     <= slot_8;
            slot_15    <= slot_14;
            slot_16    <= slot_15;
            if (rst) begin
                {slot_7, slot_9}   <= {SLOT_BITS'(SLOTS - 7), SLOT_BITS'(SLOTS - 9)};
                {slot_15, slot_16} <= {SLOT_BITS'(SLOTS - 15), SLOT_BITS'(SLOTS - 16)};
            end
            if (!again) speeds_x[slot_22]  <= in_ray.speed[0];
            if (!again) speeds_y[slot_22]  <= in_ray.speed[1];
            if (!again) speeds_z[slot_22]  <= in_ray.speed[2];
            if (!again) lengths[slot_22]   <= in_ray.length;
            if (!again) quotients[slot_22] <= in_ray.inverse_square;
            alongs[slot_13] <= along_13;
            rests[slot_16]  <= {!starts_16, rest_16};
        end

        assign equation_22.inverse_square   = quotients[slot_22];
        assign equation_22.along            = alongs[slot_22];
        assign {lands_22, equation_22.rest} = rests[slot_22];
    end else begin : no_lattice
        assign {is_lattice, meets_21, lands_22, equation_22} = '0;

        wire _unused = &{1'b0, in_ray.length, in_ray.inverse_square, over_6};
    end

    // The fourth slab of an octahedron. The point's coordinate along its axis is the signed sum of the other three coordinates, relative
    // to the centre.
    if (OCTAHEDRON) begin : diagonals
        (* ram_style = "distributed" *) logic down_sums [0:2**SLOT_BITS-1];

        logic [2:0] down_5;
        logic       is_octahedron, down_sum_6, beyond_9;

        exit_diagonal diagonal (
            .clk, .half(solid.half[0]), .point(point_5), .down(down_5), .down_sum_1(down_sum_6), .beyond(beyond_9)
        );
        delay #(.WIDTH(1), .CLOCKS(6)) sign_waits (.clk, .enable(1'b1), .in(down_sums[slot_0]), .out(down_sum_6));
        delay #(.WIDTH(1), .CLOCKS(12)) beyond_waits (.clk, .enable(1'b1), .in(is_octahedron && beyond_9), .out(beyond_21));

        always_ff @(posedge clk) begin
            is_octahedron <= solid.rule == exit_pkg::BOX && solid.levels[0];
            down_5        <= down_4;
            if (!again) down_sums[slot_22] <= in_ray.down_sum;
        end

        assign down_sum_22 = down_sums[slot_22];
    end else begin : no_diagonals
        assign {beyond_21, down_sum_22} = '0;

        wire _unused = &{1'b0, in_ray.down_sum};
    end

    // The intervals that a ray has reached. An interval is only stored when the ray crosses a plane: the points of later evaluations are
    // not below earlier points, and give at least the same interval. Only sponges of more than four levels use all digits.
    localparam int unsigned UNUSED    = LEVELS > 4 ? 0 : 4;
    localparam int unsigned USED_BITS = exit_pkg::INTERVAL_BITS - UNUSED;

    (* ram_style = "distributed" *) logic [3*(USED_BITS-1)-1:0] followed [0:2**SLOT_BITS-1];
    logic [2:0][USED_BITS-2:0] next_digits_12, next_digits_22;

    assign next_digits_22 = followed[slot_22];
    always_ff @(posedge clk) followed[slot_12] <= next_digits_12;

    for (genvar i = 0; i < 3; i++) begin : intervals
        (* ram_style = "distributed" *) logic [USED_BITS-1:0] reached [0:2**SLOT_BITS-1];

        // The highest bit of a next interval is 1.
        assign next_digits_12[i] = next_12[i][exit_pkg::INTERVAL_BITS-2:UNUSED];
        assign reached_8[i]      = exit_pkg::INTERVAL_BITS'(reached[slot_8]) << UNUSED;

        always_ff @(posedge clk)
            if (!again || crossed_22[i])
                reached[slot_22] <= again ? {1'b1, next_digits_22[i]} : in_ray.reached[i][exit_pkg::INTERVAL_BITS-1:UNUSED];
    end

    // The exits at the planes.
    for (genvar i = 0; i < 3; i++) begin : exits
        logic [exit_pkg::PLANE_BITS:0] origin_13;
        logic                          unused_14;

        assign origin_13 = {place_13[i], 1'b0} ^ {exit_pkg::PLANE_BITS + 1{!down_13[i]}};

        always_ff @(posedge clk)
            {distance_14[i], unused_14} <= {at_13[i], 1'b1} + origin_13;

        exit_quotient quotient (.clk, .distance(distance_14[i]), .inverse(inverse_14[i]), .t(exit_19[i]));

        wire _unused = &{1'b0, unused_14};
    end

    exit_choice leaving (
        .clk, .exits(exit_19), .there(there_19), .choice(choice_19), .t(exit_21), .axis(exit_axis_21), .crossed(crossed_21)
    );

    // A ray ends when it leaves the solid and cannot enter it again, or when its exit is beyond the limit, so no T in the ring exceeds the
    // limit.
    always_ff @(posedge clk) begin
        exit_22      <= exit_21[exit_pkg::T_BITS-1:0];
        exit_axis_22 <= exit_axis_21;
        crossed_22   <= crossed_21;
        later_22     <= exit_21 > {1'b0, t_21};
        hit_22       <= hit_21 && (!is_lattice || meets_21) && !beyond_21;
        left_22      <= gone_21 || hit_21 && beyond_21 || exit_21 > {1'b0, limit_21} || (above_21 & crossed_21) != '0;
    end

    assign finished = over_22 || hit_22 || left_22;

    // At a hit, the ray ends on the plane that it crossed before this evaluation.
    assign end_in.place     = place_22;
    assign end_in.hit       = hit_22 && !over_22;
    assign end_in.t         = end_t_22;
    assign end_in.axis      = axis_22;
    assign end_in.positive  = OCTAHEDRON && axis_22 == 2'd3 ? down_sum_22 : down_22[axis_22];
    assign end_in.steps     = steps_22;
    assign end_in.height    = height_22;
    assign end_in.round     = is_lattice;
    assign end_in.lands     = lands_22;
    assign end_in.equation  = equation_22;
    assign end_in.limit     = sphere_22.t;
    assign end_in.met       = sphere_22.met;
    assign end_in.number    = sphere_22.number;
    assign end_in.direction = direction_22;

    logic [2:0][exit_pkg::SPOT_BITS-1:0] at_6;

    if (SPOT) begin : spotted
        (* ram_style = "distributed" *) logic [3*exit_pkg::SPOT_BITS-1:0] spots [0:2**SLOT_BITS-1];

        logic [SLOT_BITS-1:0] slot_6;

        assign end_in.spot.at   = spots[slot_22];
        assign end_in.spot.down = down_22;

        always_ff @(posedge clk) begin
            slot_6 <= following(slot_6);
            if (rst) slot_6 <= SLOT_BITS'(SLOTS - 6);
            for (int i = 0; i < 3; i++)
                at_6[i] <= point_5[i][exit_pkg::SPOT_BITS-1:0] & {exit_pkg::SPOT_BITS{!point_5[i][exit_pkg::POINT_BITS-1]}};
            spots[slot_6] <= at_6;
        end
    end else begin : no_spot
        assign {end_in.spot, at_6} = '0;

        wire _unused = &{1'b0, at_6};
    end

    // `end_ready` is always high when a ray ends, because each ray has a reserved entry.
    if (CARRIED != 0) begin : carrying
        (* ram_style = "distributed" *) logic [CARRIED-1:0] loads [0:2**SLOT_BITS-1];
        logic hit;

        always_ff @(posedge clk) if (!again) loads[slot_22] <= in_carried;

        fifo #(.WIDTH(CARRIED + 1), .DEPTH(PLACES)) ends (
            .clk, .rst, .in_valid(ended), .in_ready(end_ready), .in_data({end_in.hit, loads[slot_22]}), .out_valid, .out_ready,
            .out_data({hit, out_carried})
        );

        always_comb begin
            out_end     = '0;
            out_end.hit = hit;
        end
    end else begin : ending
        localparam int unsigned KEPT_BITS = exit_pkg::end_bits(ROUND, LATTICE);
        localparam int unsigned HERE_BITS = SPOT ? exit_pkg::HIT_SPOT_BITS : 1;

        logic [KEPT_BITS-1:0] kept;
        logic [HERE_BITS-1:0] here;

        if (SPOT) begin : with_spot
            fifo #(.WIDTH(HERE_BITS + KEPT_BITS), .DEPTH(PLACES)) ends (
                .clk, .rst, .in_valid(ended), .in_ready(end_ready), .in_data({end_in.spot, KEPT_BITS'(end_in)}), .out_valid, .out_ready,
                .out_data({here, kept})
            );
        end else begin : alone
            fifo #(.WIDTH(KEPT_BITS), .DEPTH(PLACES)) ends (
                .clk, .rst, .in_valid(ended), .in_ready(end_ready), .in_data(KEPT_BITS'(end_in)), .out_valid, .out_ready, .out_data(kept)
            );
            assign here = '0;
        end

        assign out_end     = {exit_pkg::HIT_SPOT_BITS'(here), exit_pkg::LIMIT_END_BITS'(kept)};
        assign out_carried = '0;

        wire _unused = &{1'b0, in_carried};
    end

    wire _unused = &{1'b0, end_ready, end_in};
endmodule

`default_nettype wire

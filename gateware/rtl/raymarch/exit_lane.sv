// Lane of the raymarcher for solids with flat faces: a ring-shaped pipeline in which rays circulate, one evaluation in each round. An
// evaluation moves a ray to the end of the empty prism around its point (docs/raymarch-exits.md).
//
//   rays ──▶ slot ─▶ O + T·D ─▶ exit_borders ─▶ exit_quotient for each axis ─▶ exit_choice ─▶ hit? miss? ─┐
//             ▲                                                                                            ├─▶ fifo ─▶ ends
//             └──────────────────────── largest of T and the exit ◀────────────────────────────────────────┘
//
// The ring has SLOTS slots and never stalls. In the diagram, O is the eye from the solid's lower corner along the ray's mirrored axes, D the
// magnitude of the ray's direction, and T its parameter. The point is computed again in each round, so errors do not accumulate. Intervals
// of a ray only increase, each evaluation increases one, so every ray ends.
//
// A slot whose ray ends receives the next ray in the same clock. A ray enters only if the FIFO of ends has a free entry for its end: the
// FIFO has PLACES entries, and each ray in the ring reserves one. `evaluates` is high in clocks in which a ray begins an evaluation, `waits`
// in clocks in which an empty slot cannot receive a ray because the FIFO has no free entry.
//
// Streams are valid/ready: each item moves in a clock in which both are high, payloads stay until then, and ready comes directly from
// registers. Parameters hold while rays are in the ring. `corners` has the eye's position for each eye, and for each axis as it is and
// mirrored. `rst` discards all rays.

`default_nettype none

module exit_lane #(
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1,
    parameter bit          STEREO = 1'b1,
    // Depth of the FIFO of ends. The depth exceeds the number of slots, because some slots would otherwise stay empty.
    parameter int unsigned PLACES = 32
) (
    input  wire                                                  clk,
    input  wire                                                  rst,
    input  wire  [1:0][1:0][2:0][exit_pkg::CORNER_BITS-1:0]      corners,
    input  wire exit_pkg::solid_t                                solid,
    // Rays.
    input  wire                                                  in_valid,
    output logic                                                 in_ready,
    input  wire exit_pkg::ray_t                                  in_ray,
    // Ends.
    output logic                                                 out_valid,
    input  wire                                                  out_ready,
    output exit_pkg::end_t                                       out_end,
    // Events.
    output logic                                                 evaluates,
    output logic                                                 waits
);
    // Stages of the ring; the suffix of a name is the stage in which it is valid. LAST is the last stage.
    localparam int unsigned LAST       = 23;
    localparam int unsigned SLOTS      = LAST + 1;
    localparam int unsigned SLOT_BITS  = $clog2(SLOTS);
    localparam int unsigned COUNT_BITS = $clog2(PLACES + 1);

    logic [LAST:0]         occupied;
    logic [COUNT_BITS-1:0] places;
    logic                  enter, finished, again, ended, end_ready, gone_out;

    // State of the rays in the first and in the last stage.
    logic                       over_0, over_23;
    logic [exit_pkg::T_BITS-1:0] t_0, t_21, t_22, t_23;
    logic [1:0]                 axis_0, axis_22, axis_23;
    logic [2:0][exit_pkg::INTERVAL_BITS-1:0] reached_0, reached_22, reached_23;
    logic [7:0]                 steps_0, steps_22, steps_23;
    logic                       hit_23;

    // At a hit, the ray ends at the plane that it had crossed before this evaluation.
    logic [exit_pkg::T_BITS-1:0] from_22, from_23;
    logic [1:0]                  from_axis_22, from_axis_23;

    assign again    = occupied[LAST] && !finished;
    assign ended    = occupied[LAST] && finished;
    assign in_ready = !again && places != '0;
    assign enter    = in_valid && in_ready;
    assign gone_out = out_valid && out_ready;

    always_ff @(posedge clk) begin
        occupied  <= {occupied[LAST-1:0], again || enter};
        over_0    <= !again && in_ray.over;
        t_0       <= again ? t_23 : in_ray.start;
        axis_0    <= again ? axis_23 : in_ray.axis;
        reached_0 <= again ? reached_23 : in_ray.reached;
        steps_0   <= again ? steps_23 : '0;
        if (enter != gone_out) places <= enter ? places - 1'b1 : places + 1'b1;

        evaluates <= occupied[0] && !over_0;
        waits     <= in_valid && !again && places == '0;

        if (rst) begin
            occupied <= '0;
            places   <= COUNT_BITS'(PLACES);
        end
    end

    // Constants of the rays in the ring, in a word of LUT memory per slot, written when a ray enters. Each stage that reads constants has
    // a memory of its own, and the number of the slot in this stage. Writes to an empty slot are allowed.
    logic [SLOT_BITS-1:0] slot_0, slot_13, slot_22, slot_23;

    function automatic logic [SLOT_BITS-1:0] following(input logic [SLOT_BITS-1:0] slot);
        following = slot == SLOT_BITS'(SLOTS - 1) ? '0 : slot + 1'b1;
    endfunction

    // A ray that is in the last stage enters the first stage with the next clock.
    always_ff @(posedge clk) begin
        slot_0  <= slot_23;
        slot_13 <= following(slot_13);
        slot_22 <= following(slot_22);
        slot_23 <= slot_22;
        if (rst) {slot_0, slot_13, slot_22, slot_23} <= {SLOT_BITS'(0), SLOT_BITS'(SLOTS - 13), SLOT_BITS'(SLOTS - 22), SLOT_BITS'(SLOTS - 23)};
    end

    localparam int unsigned AIM_BITS   = 4 + 3 * exit_pkg::SPEED_BITS;
    localparam int unsigned CARGO_BITS = raymarch_pkg::PLACE_BITS + 3;

    (* ram_style = "distributed" *) logic [AIM_BITS-1:0]                   aims     [0:2**SLOT_BITS-1];
    (* ram_style = "distributed" *) logic [3*exit_pkg::INVERSE_BITS-1:0]   inverses [0:2**SLOT_BITS-1];
    (* ram_style = "distributed" *) logic [exit_pkg::T_BITS-1:0]           limits   [0:2**SLOT_BITS-1];
    (* ram_style = "distributed" *) logic [CARGO_BITS-1:0]                 cargos   [0:2**SLOT_BITS-1];

    logic                                 eye_0, eye_4, eye_12;
    logic [2:0]                           down_0, down_4, down_12, down_23;
    logic [2:0][exit_pkg::SPEED_BITS-1:0] speed_0, speed_1;
    logic [2:0][exit_pkg::INVERSE_BITS-1:0] inverse_13;
    logic [exit_pkg::T_BITS-1:0]          limit_22, limit_23;
    logic [raymarch_pkg::PLACE_BITS-1:0]  place_23;

    assign {eye_0, down_0, speed_0} = aims[slot_0];
    assign inverse_13               = inverses[slot_13];
    assign limit_22                 = limits[slot_22];
    assign {place_23, down_23}      = cargos[slot_23];

    always_ff @(posedge clk) begin
        limit_23 <= limit_22;
        if (!again) begin
            aims[slot_23]     <= {in_ray.place[17], in_ray.down, in_ray.speed};
            inverses[slot_23] <= in_ray.inverse;
            limits[slot_23]   <= in_ray.limit;
            cargos[slot_23]   <= {in_ray.place, in_ray.down};
        end
    end

    delay #(.WIDTH(4), .CLOCKS(4)) signs (.clk, .enable(1'b1), .in({eye_0, down_0}), .out({eye_4, down_4}));
    delay #(.WIDTH(4), .CLOCKS(8)) signs_wait (.clk, .enable(1'b1), .in({eye_4, down_4}), .out({eye_12, down_12}));

    // The point O + T·D, from two products for each axis.
    logic [10:0] t_high_1;
    logic [2:0][exit_pkg::POINT_BITS-1:0] point_5;

    always_ff @(posedge clk) begin
        speed_1  <= speed_0;
        t_high_1 <= t_0[27:17];
    end

    for (genvar i = 0; i < 3; i++) begin : axes
        logic signed [42:0] low_3, high_4;
        logic signed [exit_pkg::CORNER_BITS-1:0] corner_4;

        assign corner_4 = STEREO && eye_4 ? down_4[i] ? corners[1][1][i] : corners[1][0][i]
                                          : down_4[i] ? corners[0][1][i] : corners[0][0][i];

        multiply_add #(.BITS(43)) low_part (
            .clk, .enable(1'b1), .a({1'b0, speed_0[i], 1'b1}), .b({1'b0, t_0[16:0]}), .c('0), .p(low_3)
        );
        multiply_add #(.BITS(43)) high_part (
            .clk, .enable(1'b1), .a({1'b0, speed_1[i], 1'b1}), .b({7'd0, t_high_1}), .c({17'd0, low_3[42:17]}), .p(high_4)
        );
        always_ff @(posedge clk)
            point_5[i] <= exit_pkg::POINT_BITS'(high_4[34:9]) + exit_pkg::POINT_BITS'(corner_4);

        wire _unused = &{1'b0, low_3[16:0], high_4[42:35], high_4[8:0]};
    end

    // The planes around the point, and the exits at them.
    logic [2:0][exit_pkg::INTERVAL_BITS-1:0] reached_7, interval_11, next_11, interval_21, next_21;
    logic [2:0] there_11, there_19;
    logic [1:0] choice_11, choice_19;
    logic       hit_11, gone_11, hit_22, gone_22;
    logic [2:0][exit_pkg::SIDE_BITS-1:0]   at_12;
    logic [2:0][exit_pkg::CORNER_BITS-1:0] distance_13;
    logic [2:0][exit_pkg::T_BITS-1:0]      exit_19;

    delay #(.WIDTH(3 * exit_pkg::INTERVAL_BITS), .CLOCKS(7)) reached_waits (.clk, .enable(1'b1), .in(reached_0), .out(reached_7));

    exit_borders #(.LEVELS(LEVELS), .BOXES(BOXES)) borders (
        .clk, .solid, .point(point_5), .reached_2(reached_7), .interval(interval_11), .next(next_11), .there(there_11), .choice(choice_11),
        .hit(hit_11), .gone(gone_11), .at(at_12)
    );

    delay #(.WIDTH(5), .CLOCKS(8)) choice_waits (.clk, .enable(1'b1), .in({there_11, choice_11}), .out({there_19, choice_19}));
    delay #(.WIDTH(6 * exit_pkg::INTERVAL_BITS), .CLOCKS(10)) intervals (
        .clk, .enable(1'b1), .in({interval_11, next_11}), .out({interval_21, next_21})
    );
    delay #(.WIDTH(2), .CLOCKS(11)) ends_wait (.clk, .enable(1'b1), .in({hit_11, gone_11}), .out({hit_22, gone_22}));

    for (genvar i = 0; i < 3; i++) begin : exits
        logic [exit_pkg::CORNER_BITS-1:0] corner_12;

        assign corner_12 = STEREO && eye_12 ? down_12[i] ? corners[1][1][i] : corners[1][0][i]
                                            : down_12[i] ? corners[0][1][i] : corners[0][0][i];

        always_ff @(posedge clk)
            distance_13[i] <= exit_pkg::CORNER_BITS'(at_12[i]) - corner_12;

        exit_quotient quotient (.clk, .distance(distance_13[i]), .inverse(inverse_13[i]), .t(exit_19[i]));
    end

    logic [exit_pkg::T_BITS-1:0] exit_21;
    logic [1:0] axis_21;
    logic [2:0] crossed_21;

    exit_choice leaving (
        .clk, .exits(exit_19), .there(there_19), .choice(choice_19), .t(exit_21), .axis(axis_21), .crossed(crossed_21)
    );

    delay #(.WIDTH(exit_pkg::T_BITS), .CLOCKS(21)) t_waits (.clk, .enable(1'b1), .in(t_0), .out(t_21));
    delay #(.WIDTH(2), .CLOCKS(22)) axis_waits (.clk, .enable(1'b1), .in(axis_0), .out(from_axis_22));
    delay #(.WIDTH(8), .CLOCKS(22)) steps_wait (.clk, .enable(1'b1), .in(steps_0), .out(steps_22));
    delay #(.WIDTH(1), .CLOCKS(23)) over_waits (.clk, .enable(1'b1), .in(over_0), .out(over_23));

    // A ray that has left the solid does not come back, and the limit ends it too.
    logic       is_cubes, is_planes;
    logic [2:0] above_22;
    logic       left_23;

    assign is_cubes  = BOXES && solid.rule == exit_pkg::CUBES;
    assign is_planes = BOXES && solid.rule == exit_pkg::PLANES;

    always_comb
        for (int i = 0; i < 3; i++) above_22[i] = !is_planes && exit_pkg::is_above(reached_22[i][8:6], is_cubes);

    always_ff @(posedge clk) begin
        t_22    <= exit_21 > t_21 ? exit_21 : t_21;
        from_22 <= t_21;
        axis_22 <= axis_21;
        for (int i = 0; i < 3; i++) reached_22[i] <= crossed_21[i] ? next_21[i] : interval_21[i];

        t_23         <= t_22;
        from_23      <= from_22;
        axis_23      <= axis_22;
        from_axis_23 <= from_axis_22;
        reached_23   <= reached_22;
        steps_23     <= steps_22 + 8'd1;
        hit_23       <= hit_22;
        left_23      <= gone_22 || t_22 > limit_22 || above_22 != '0;
    end

    assign finished = over_23 || hit_23 || left_23;

    exit_pkg::end_t end_in;

    assign end_in.place    = place_23;
    assign end_in.hit      = hit_23 && !over_23;
    assign end_in.t        = hit_23 && !over_23 ? from_23 : limit_23;
    assign end_in.axis     = from_axis_23;
    assign end_in.positive = down_23[from_axis_23];
    assign end_in.steps    = over_23 ? '0 : steps_23;

    // `end_ready` is always high when a ray ends, because each ray has a reserved entry.
    fifo #(.WIDTH(exit_pkg::END_BITS), .DEPTH(PLACES)) ends (
        .clk, .rst, .in_valid(ended), .in_ready(end_ready), .in_data(end_in), .out_valid, .out_ready, .out_data(out_end)
    );

    wire _unused = &{1'b0, end_ready};
endmodule

`default_nettype wire

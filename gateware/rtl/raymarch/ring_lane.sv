// Lane of the raymarcher: a ring-shaped pipeline in which rays circulate. Each ray has one evaluation of the field in each of its rounds
// through the ring, and the lane makes one evaluation per clock.
//
//   rays ──▶ slot ─▶ o + t·d ─▶ field_unit ─▶ distance ─▶ hit? miss? undecided? ─┐
//             ▲                                                                   ├─▶ fifo ─▶ ends
//             └───────────────────── t + distance ◀───────────────────────────────┘
//
// The ring has raymarch_pkg::field_clocks + 6 slots and never stalls. In the diagram, o is the eye, d the direction of a ray and t its
// parameter. The point o + t·d is computed again in each round, so errors do not accumulate. A slot whose ray ends receives the next ray
// in the same clock. A ray enters only if the FIFO of ends has a free entry for its end: the FIFO has PLACES entries, and each ray in the
// ring reserves one. `evaluates` is high in clocks in which an occupied slot passes field_unit, `waits` in clocks in which an empty slot
// cannot receive a ray because the FIFO has no free entry.
//
// With ROUND a field may have spheres. A ray then needs one round for each sphere, and its t does not change before the last of these
// rounds. The slot of the ray also stores the nearest of the spheres evaluated so far. The end of the ray includes its direction, and the
// limit of its evaluations is four times the limit in `tuning`.
//
// Streams are valid/ready: each item moves in a clock in which both are high, payloads stay until then, and ready comes directly from
// registers. Parameters hold while rays are in the ring. `rst` discards all rays.

`default_nettype none

module ring_lane #(
    parameter int unsigned LEVELS = 4,
    parameter int unsigned FIELDS = 1,
    parameter bit          ROUND  = 1'b0,
    parameter bit          BLEND  = 1'b0,
    parameter bit          STEREO = 1'b1,
    // Depth of the FIFO of ends. The depth exceeds the number of slots, because some slots would otherwise stay empty.
    parameter int unsigned PLACES = raymarch_pkg::has_short_rings(LEVELS, FIELDS, ROUND, BLEND) ? 32 : 64
) (
    input  wire                      clk,
    input  wire                      rst,
    // Frame.
    input  wire  [1:0][2:0][24:0]    origins,
    input  wire  [2:0][23:0]         bounds,
    input  wire raymarch_registers_pkg::solid_t solid,
    input  wire raymarch_registers_pkg::tuning_t tuning,
    // Sphere writes; allowed only while the ring is empty.
    input  wire                      sphere_write,
    input  wire  [2:0]               sphere_number,
    input  wire raymarch_registers_pkg::sphere_t sphere,
    // Rays.
    input  wire                      in_valid,
    output logic                     in_ready,
    input  wire raymarch_pkg::ray_t     in_ray,
    // Ends.
    output logic                     out_valid,
    input  wire                      out_ready,
    output raymarch_pkg::end_t          out_end,
    // Events.
    output logic                     evaluates,
    output logic                     waits
);
    // Pipeline stage in which the distance is valid, counted from the slot.
    localparam int unsigned DISTANCE = 3 + raymarch_pkg::field_clocks(LEVELS, FIELDS, ROUND, BLEND);
    localparam int unsigned COUNT_BITS = $clog2(PLACES + 1);
    localparam int unsigned STEP_BITS  = ROUND ? 10 : 8;
    localparam bit          OCTANTS   = (FIELDS & fields_pkg::OCTANTS) != 0;
    localparam int unsigned KEPT_BITS  = raymarch_pkg::end_bits(1'b1, ROUND, BLEND);

    // Constants of a ray in the ring. They are stored in a word of LUT memory per slot, written when the ray enters the slot.
    typedef struct packed {
        raymarch_pkg::place_t                         place;
        logic [9:0]                     length;
        logic [2:0][raymarch_pkg::DIRECTION_BITS-1:0] direction;
    } cargo_t;
    localparam int unsigned CARGO_BITS = raymarch_pkg::PLACE_BITS + 10 + 3 * raymarch_pkg::DIRECTION_BITS;
    localparam int unsigned SLOTS      = DISTANCE + 3;
    localparam int unsigned SLOT_BITS  = $clog2(SLOTS);

    logic [DISTANCE+2:0] occupied;
    logic [COUNT_BITS-1:0] places;
    logic              enter, finished, again, ended, end_ready, gone_out;

    // The first stage of the ring, which receives new rays.
    logic              eye;
    logic [2:0][raymarch_pkg::DIRECTION_BITS-1:0] direction;
    logic [raymarch_pkg::T_BITS-1:0] t;
    logic [STEP_BITS-1:0] steps;

    // The last stage of the ring, in which the state of the ray is valid. `early_cargo` belongs to the stage before it.
    cargo_t            early_cargo, last_cargo;
    logic [raymarch_pkg::T_BITS-1:0] last_t;
    logic [STEP_BITS-1:0] last_steps;
    raymarch_pkg::state_t            last_state;
    logic              last_round;
    logic [2:0]        last_surface;

    assign again    = occupied[DISTANCE+2] && !finished;
    assign ended    = occupied[DISTANCE+2] && finished;
    assign in_ready = !again && places != '0;
    assign enter    = in_valid && in_ready;
    assign gone_out = out_valid && out_ready;

    always_ff @(posedge clk) begin
        occupied <= {occupied[DISTANCE+1:0], again || enter};
        t        <= again ? last_t : in_ray.start;
        steps    <= again ? last_steps : '0;
        if (enter != gone_out) places <= enter ? places - 1'b1 : places + 1'b1;

        evaluates <= occupied[0];
        waits     <= in_valid && !again && places == '0;

        if (rst) begin
            occupied <= '0;
            places   <= COUNT_BITS'(PLACES);
        end
    end

    // Numbers of the slots in the first stage, in the last stage, and in the last stage but one.
    logic [SLOT_BITS-1:0] first_slot, last_slot, early_slot;

    always_ff @(posedge clk) begin
        early_slot <= early_slot == SLOT_BITS'(SLOTS - 1) ? '0 : early_slot + 1'b1;
        last_slot  <= early_slot;
        first_slot <= last_slot;
        if (rst) {early_slot, last_slot, first_slot} <= {SLOT_BITS'(2), SLOT_BITS'(1), SLOT_BITS'(0)};
    end

    // Each stage that reads data of a slot has its own memory for these data. Writes to an empty slot are allowed.
    (* ram_style = "distributed" *) logic [CARGO_BITS-1:0] cargos [0:2**SLOT_BITS-1];
    (* ram_style = "distributed" *) logic [1+3*raymarch_pkg::DIRECTION_BITS-1:0] aims [0:2**SLOT_BITS-1];

    assign early_cargo      = cargos[early_slot];
    assign {eye, direction} = aims[first_slot];

    always_ff @(posedge clk) begin
        last_cargo <= early_cargo;
        if (!again) begin
            cargos[last_slot] <= {in_ray.place, in_ray.length, in_ray.direction};
            aims[last_slot]   <= {in_ray.place.eye, in_ray.direction};
        end
    end

    // The point o + t·d. The position o of the eye is selected two clocks after the first stage, when the product t·d is valid.
    logic                  eye_2;
    logic [2:0]            backwards;
    logic [2:0][raymarch_pkg::WIDE_BITS-1:0] point;

    if (STEREO) begin : two_eyes
        delay #(.WIDTH(1), .CLOCKS(2)) eyes (.clk, .enable(1'b1), .in(eye), .out(eye_2));
    end else begin : one_eye
        assign eye_2 = 1'b0;
        wire _unused = eye;
    end

    for (genvar i = 0; i < 3; i++) begin : axes
        logic [raymarch_pkg::WIDE_BITS-1:0]           origin;
        logic signed [raymarch_pkg::WIDE_BITS+16:0]   sum;

        assign origin = STEREO && eye_2 ? origins[1][i] : origins[0][i];

        multiply_add #(.BITS(raymarch_pkg::WIDE_BITS + 17)) place (
            .clk, .enable(1'b1), .a({2'b0, t}), .b(direction[i]), .c({origin, 17'b0}), .p(sum)
        );
        assign point[i] = sum[raymarch_pkg::WIDE_BITS+16:17];

        delay #(.WIDTH(1), .CLOCKS(3)) sign (
            .clk, .enable(1'b1), .in(direction[i][raymarch_pkg::DIRECTION_BITS-1]), .out(backwards[i])
        );
        wire _unused = &{1'b0, sum[16:0]};
    end

    // `gone` is high if, along some axis, the point is outside of the box about the field and the ray leads away from the box.
    logic [2:0] leaves;
    logic       gone, gone_late;

    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++)
            leaves[i] <= (point[i][23:0] ^ {24{point[i][24]}}) > bounds[i] && point[i][24] == backwards[i];
        gone <= leaves != '0;
    end

    delay #(.WIDTH(1), .CLOCKS(DISTANCE - 5)) going (.clk, .enable(1'b1), .in(gone), .out(gone_late));

    logic signed [21:0] distance;
    logic [2:0]         surface, face, face_end;
    logic [7:0]         share, share_end;

    // The number of the sphere in the current pass, and the nearest sphere of the earlier passes. The suffix of a name is the number of
    // clocks after the first stage. `nearest` and `is_last` (high in the last pass) are valid in the clock of the distance.
    logic                round, is_last, is_last_2;
    logic [2:0]          pass_2;
    raymarch_pkg::nearest_t so_far_3, nearest;

    field_unit #(.LEVELS(LEVELS), .FIELDS(FIELDS), .ROUND(ROUND), .BLEND(BLEND)) field (
        .clk, .solid, .sphere_write, .sphere_number, .sphere, .pass(pass_2), .point({point[2][21:0], point[1][21:0], point[0][21:0]}),
        .so_far(so_far_3), .distance, .round, .surface, .face, .share, .nearest
    );

    if (ROUND) begin : passes
        logic                is_last_early;
        logic [2:0]          pass, last_pass, pass_early, pass_1;
        raymarch_pkg::nearest_t so_far, last_nearest;

        always_ff @(posedge clk) begin
            pass   <= again && last_pass != '0 ? last_pass : '0;
            so_far <= again && last_pass != '0 ? last_nearest : {1'b0, {21{1'b1}}, 3'd0};
        end

        delay #(.WIDTH(3), .CLOCKS(2)) pass_goes (.clk, .enable(1'b1), .in(pass), .out(pass_2));
        delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(3)) so_far_goes (.clk, .enable(1'b1), .in(so_far), .out(so_far_3));
        delay #(.WIDTH(3), .CLOCKS(DISTANCE - 4)) pass_waits (.clk, .enable(1'b1), .in(pass_2), .out(pass_early));
        delay #(.WIDTH(3), .CLOCKS(2)) pass_comes (.clk, .enable(1'b1), .in(pass_early), .out(pass_1));
        delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(2)) nearest_goes (.clk, .enable(1'b1), .in(nearest), .out(last_nearest));

        always_ff @(posedge clk) begin
            is_last_early <= pass_early == solid.last_sphere;
            is_last       <= is_last_early;
            is_last_2     <= is_last;
        end

        // Number of the next pass; 0 after the last pass.
        logic [2:0] next_pass;
        always_ff @(posedge clk) begin
            next_pass <= is_last ? '0 : pass_1 + 1'b1;
            last_pass <= next_pass;
        end
    end else begin : one_pass
        assign pass_2   = '0;
        assign so_far_3 = '0;
        assign {is_last, is_last_2} = '1;
    end

    // Values in the clock of the distance: t of this evaluation (`t_1`), the distance below which a ray hits (`threshold`), and the number
    // of earlier evaluations (`steps_1`).
    logic [raymarch_pkg::T_BITS-1:0] t_early, t_1;
    logic [15:0]       footprint;
    logic [16:0]       threshold;
    logic [STEP_BITS-1:0] steps_1, steps_2;

    delay #(.WIDTH(raymarch_pkg::T_BITS), .CLOCKS(DISTANCE - 1)) way (.clk, .enable(1'b1), .in(t), .out(t_early));
    delay #(.WIDTH(STEP_BITS), .CLOCKS(DISTANCE)) counted (.clk, .enable(1'b1), .in(steps), .out(steps_1));

    // The footprint is t, shifted right by `tuning.footprint` bits. `tuning.footprint` is 7 to 15, so the shift is by 7 bits if bit 3 of
    // `tuning.footprint` is 0.
    assign footprint = tuning.footprint[3] ? {1'b0, t_early[22:8]} >> tuning.footprint[2:0] : t_early[22:7];

    always_ff @(posedge clk) begin
        t_1       <= t_early;
        threshold <= {1'b0, tuning.threshold} + {1'b0, footprint};
    end

    // One clock after the distance (suffix _2): whether the distance is below the threshold (`near_2`), the ray has left the
    // box (`gone_2`), or the step limit is reached (`late_2`). One clock later: whether t exceeds the far limit (`beyond`), and the state
    // of the ray.
    logic            near_2, gone_2, late_2;
    logic [raymarch_pkg::T_BITS:0] next_2;
    logic [raymarch_pkg::T_BITS-1:0] t_2, taken_t;
    logic [11:0]     gap_2, gap;
    logic            round_2;
    logic [2:0]      surface_2;
    logic            beyond;

    assign beyond = gone_2 || next_2 > {1'b0, tuning.far_limit};

    // `late_1` is high if the current evaluation reaches the step limit, `tuning.cap`. `patience` is the number of doublings of
    // the threshold. In fields with spheres the limit is four times as large, and the threshold is not doubled.
    logic [1:0] patience;
    logic       late_1;

    if (ROUND) begin : long_way
        assign patience = solid.is_round ? '0 : steps_1[7:6];
        assign late_1   = steps_1 + 10'd1 >= (solid.is_round ? {tuning.cap, 2'b0} : {2'b0, tuning.cap});
    end else begin : short_way
        assign patience = steps_1[7:6];
        assign late_1   = steps_1 + 8'd1 >= tuning.cap;
    end

    always_ff @(posedge clk) begin
        near_2    <= distance < $signed({2'b0, 20'(threshold) << patience});
        late_2    <= late_1;
        next_2    <= {1'b0, t_1} + 24'(distance[20:0] & {21{!distance[21] && is_last}});
        t_2       <= t_1;
        gap_2     <= distance[20:12] != '0 && !distance[21] ? '1 : distance[11:0] & {12{!distance[21]}};
        gone_2    <= gone_late;
        steps_2   <= steps_1 + STEP_BITS'(is_last);
        surface_2 <= surface;
        round_2   <= round;

        finished     <= is_last_2 && (beyond || near_2 || late_2);
        last_state   <= beyond ? raymarch_pkg::MISS : near_2 ? raymarch_pkg::HIT : raymarch_pkg::UNDECIDED;
        last_t       <= next_2[raymarch_pkg::T_BITS-1:0];
        taken_t      <= t_2;
        gap          <= beyond || !near_2 ? '0 : gap_2;
        last_steps   <= steps_2;
        last_surface <= surface_2;
        last_round   <= round_2;
    end

    raymarch_pkg::end_t end_in;
    logic [7:0]      height, steps_end;
    logic [raymarch_pkg::T_BITS-1:0] end_t;

    // The number of evaluations in the end of a ray, saturated at 255.
    if (ROUND) begin : many_steps
        assign steps_end = last_steps[STEP_BITS-1:8] != '0 ? '1 : last_steps[7:0];
    end else begin : few_steps
        assign steps_end = last_steps;
    end

    // `slope` is the direction's component along the inward normal of the face, or all ones for a ray that does not approach the face. Only
    // the quotient of `gap` and `slope` is used.
    logic [10:0] part;
    logic [9:0]  axis_slope, slope;
    logic [11:0] face_gap;
    logic [2:0][10:0] towards;

    assign part       = last_cargo.direction[last_surface[2:1]][17:7];
    assign axis_slope = part[10] == last_surface[0] ? part[9:0] ^ {10{part[10]}} : '1;

    always_comb
        for (int i = 0; i < 3; i++) towards[i] = early_cargo.direction[i][17:7] ^ {11{surface_2[i]}};

    // For a face perpendicular to a diagonal, `slope` takes one more clock, so the direction is read one clock earlier. For such a face the
    // slope is a third of the sum of three components. To avoid the division by three, `face_gap` and `slope` are both three quarters of
    // their true values, which does not change their quotient: `slope` is then a quarter of the sum.
    if (OCTANTS) begin : diagonals
        logic signed [11:0] x_y;
        logic signed [10:0] z;
        logic signed [12:0] sum;
        logic               is_diagonal;

        always_ff @(posedge clk) begin
            x_y <= 12'($signed(towards[0])) + 12'($signed(towards[1]));
            z   <= $signed(towards[2]);
        end

        assign is_diagonal = fields_pkg::has_octants(solid.kind);
        assign sum         = 13'(x_y) + 13'(z);
        assign slope       = !is_diagonal ? axis_slope : sum[12] ? '1 : sum[11:2];
        assign face_gap    = is_diagonal ? gap - {2'b0, gap[11:2]} : gap;
        wire _unused = &{1'b0, sum[1:0], early_cargo.place, early_cargo.length};
    end else begin : axes_alone
        assign slope    = axis_slope;
        assign face_gap = gap;
        wire _unused = &{1'b0, early_cargo, towards};
    end

    assign height = last_cargo.direction[2][17] ? '0 : last_cargo.direction[2][16:9];

    always_comb begin
        if (last_state == raymarch_pkg::MISS) end_t = {15'b0, height};
        else if (last_round)                  end_t = last_t;
        else                                  end_t = taken_t;
    end

    assign end_in = {
        face_end, share_end, last_cargo.length, last_round ? 12'd0 : face_gap, last_round ? 10'h3FF : slope, last_cargo.direction,
        last_round, last_cargo.place, raymarch_pkg::END_T_BITS'(end_t), steps_end, last_state, last_surface
    };

    delay #(.WIDTH(11), .CLOCKS(2)) blended (.clk, .enable(1'b1), .in({face, share}), .out({face_end, share_end}));

    // `end_ready` is always high when a ray ends, because each ray has a reserved entry.
    logic [KEPT_BITS-1:0] kept;

    fifo #(.WIDTH(KEPT_BITS), .DEPTH(PLACES)) ends (
        .clk, .rst, .in_valid(ended), .in_ready(end_ready), .in_data(end_in[KEPT_BITS-1:0]), .out_valid, .out_ready, .out_data(kept)
    );

    assign out_end = raymarch_pkg::END_BITS'(kept);

    wire _unused = &{1'b0, end_ready, end_in, nearest};
endmodule

`default_nettype wire

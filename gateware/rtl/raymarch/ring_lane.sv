// Lane of the raymarcher for fields with fillets: a ring-shaped pipeline in which rays circulate. Each ray has one evaluation of the field in
// each of its rounds through the ring, and the lane makes one evaluation per clock.
//
//   rays ──▶ slot ─▶ o + T·D ─▶ field_unit ─▶ distance ─▶ hit? miss? undecided? ─┐
//             ▲                                                                   ├─▶ fifo ─▶ ends
//             └────────────────── T + distance·pace ◀─────────────────────────────┘
//
// The ring has raymarch_pkg::field_clocks + 9 slots and never stalls. In the diagram, o is the eye, D the direction of a ray and T its
// parameter, the depth. The point o + T·D is computed again in each round, so errors do not accumulate. A slot whose ray ends receives the next
// ray in the same clock. A ray enters only if the FIFO of ends has a free entry for its end: the FIFO has PLACES entries, and each ray in the
// ring reserves one. `evaluates` is high in clocks in which an occupied slot passes field_unit, `waits` in clocks in which an empty slot
// cannot receive a ray because the FIFO has no free entry.
//
// A ray needs one round for each sphere, and its T does not change before the last of these rounds. The slot of the ray also stores the
// nearest of the spheres evaluated so far.
//
// `pace` is a lower bound of 1/|D|, from a table. The index of the table is |D|^2, computed from the highest six bits of
// each component, rounded up.
//
// Streams are valid/ready: each item moves in a clock in which both are high, payloads stay until then, and ready comes directly from
// registers. Parameters hold while rays are in the ring. `rst` discards all rays.

`default_nettype none

module ring_lane #(
    // Levels of the sponge, 0 for a build without sponges, and whether there are boxes.
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1,
    parameter bit          STEREO = 1'b1,
    // Latency of field_unit in clocks; only proofs override this value.
    parameter int unsigned FIELD_CLOCKS = raymarch_pkg::field_clocks(LEVELS),
    // Depth of the FIFO of ends. The depth exceeds the number of slots, because some slots would otherwise stay empty.
    parameter int unsigned PLACES = 64
) (
    input  wire                      clk,
    input  wire                      rst,
    // Frame.
    input  wire  [1:0][2:0][24:0]    origins,
    input  wire  [2:0][20:0]         bounds,
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
    // Numbers of pipeline stages, counted from the first stage of the ring: the stage in which the distance is valid, and the last stage.
    localparam int unsigned DISTANCE   = 4 + FIELD_CLOCKS;
    localparam int unsigned LAST       = DISTANCE + 4;
    localparam int unsigned COUNT_BITS = $clog2(PLACES + 1);
    localparam int unsigned STEP_BITS  = 10;
    // Width of a point's coordinate before it is saturated, s15.12.
    localparam int unsigned POINT_BITS = 28;
    localparam int unsigned SLOTS      = LAST + 1;
    localparam int unsigned SLOT_BITS  = $clog2(SLOTS);

    // The fields of a ray that are stored while the ray is in the ring.
    typedef struct packed {
        logic                                         over;
        raymarch_pkg::place_t                         place;
        logic [7:0]                                   height;
        logic [2:0][raymarch_pkg::DIRECTION_BITS-1:0] direction;
    } kept_t;
    localparam int unsigned KEPT_BITS = raymarch_pkg::RAY_BITS - raymarch_pkg::T_BITS;

    logic [LAST:0]         occupied;
    logic [COUNT_BITS-1:0] places;
    logic                  enter, finished, again, ended, end_ready, gone_out;

    // The first stage of the ring, which receives new rays.
    logic                            eye;
    logic [2:0][raymarch_pkg::DIRECTION_BITS-1:0] direction;
    logic [raymarch_pkg::T_BITS-1:0] t;
    logic [STEP_BITS-1:0]            steps;

    // The last stage of the ring, in which the state of the ray is valid.
    kept_t                           last_ray;
    logic [raymarch_pkg::T_BITS-1:0] last_t;
    logic [STEP_BITS-1:0]            last_steps;
    raymarch_pkg::state_t            last_state;
    logic [2:0]                      last_surface, last_face;
    logic [7:0]                      last_share;

    assign again    = occupied[LAST] && !finished;
    assign ended    = occupied[LAST] && finished;
    assign in_ready = !again && places != '0;
    assign enter    = in_valid && in_ready;
    assign gone_out = out_valid && out_ready;

    always_ff @(posedge clk) begin
        occupied <= {occupied[LAST-1:0], again || enter};
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

    // The constants of a ray are stored in a word of LUT memory per slot, written when the ray enters the slot. Each stage that reads data of a
    // slot has its own memory for these data. Writes to an empty slot are allowed.
    (* ram_style = "distributed" *) logic [KEPT_BITS-1:0] rays [0:2**SLOT_BITS-1];
    (* ram_style = "distributed" *) logic [1+3*raymarch_pkg::DIRECTION_BITS-1:0] aims [0:2**SLOT_BITS-1];

    kept_t early_ray;

    assign {eye, direction} = aims[first_slot];
    assign early_ray        = rays[early_slot];

    always_ff @(posedge clk) begin
        last_ray <= early_ray;
        if (!again) begin
            rays[last_slot] <= {in_ray.over, in_ray.place, in_ray.height, in_ray.direction};
            aims[last_slot] <= {in_ray.place.eye, in_ray.direction};
        end
    end

    // The suffix of a name is the number of clocks after the first stage; signals without a suffix are valid in the clock of the distance.
    // The point o + T·D is valid in clock 3. The position o of the eye is selected in clock 2, when the product T·D is valid. In clock 4
    // each coordinate is saturated to the range of the field.
    logic       eye_2;
    logic [2:0] backwards_3;
    logic [2:0][POINT_BITS-1:0]               point_3;
    logic [2:0][raymarch_pkg::POINT_BITS-1:0] point_4;

    if (STEREO) begin : two_eyes
        delay #(.WIDTH(1), .CLOCKS(2)) eyes (.clk, .enable(1'b1), .in(eye), .out(eye_2));
    end else begin : one_eye
        assign eye_2 = 1'b0;
        wire _unused = eye;
    end

    for (genvar i = 0; i < 3; i++) begin : axes
        logic [raymarch_pkg::WIDE_BITS-1:0] origin;
        logic signed [POINT_BITS+14:0]      sum;

        assign origin = STEREO && eye_2 ? origins[1][i] : origins[0][i];

        multiply_add #(.BITS(POINT_BITS + 15)) place (
            .clk, .enable(1'b1), .a({1'b0, t}), .b(direction[i]), .c({{3{origin[24]}}, origin, 15'b0}), .p(sum)
        );
        assign point_3[i] = sum[POINT_BITS+14:15];

        always_ff @(posedge clk)
            point_4[i] <= {point_3[i][27],
                           point_3[i][26:21] == {6{point_3[i][27]}} ? point_3[i][20:0] : {21{!point_3[i][27]}}};

        delay #(.WIDTH(1), .CLOCKS(3)) sign (
            .clk, .enable(1'b1), .in(direction[i][raymarch_pkg::DIRECTION_BITS-1]), .out(backwards_3[i])
        );
        wire _unused = &{1'b0, sum[14:0]};
    end

    // `gone` is high if, along some axis, the point is outside of the box around the field and the ray leads away from the box.
    logic [2:0] leaves_4;
    logic       gone_5, gone_next;

    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++)
            leaves_4[i] <= (point_3[i][26:0] ^ {27{point_3[i][27]}}) > 27'(bounds[i]) && point_3[i][27] == backwards_3[i];
        gone_5 <= leaves_4 != '0;
    end

    // The pace of a ray, u3.14: sqrt(32/(i + 1)). The index i is floor(32·s), where s is an upper bound of |D|^2: the sum of the squares
    // of the components, each rounded up to a multiple of 1/64.
    (* rom_style = "logic" *) logic [16:0] paces [0:127];
    (* rom_style = "logic" *) logic [12:0] squares [0:63];

    initial begin
        for (int i = 0; i < 128; i++) paces[i] = 17'($rtoi($sqrt(8589934592.0 / $itor(i + 1))));
        for (int i = 0; i < 64; i++) squares[i] = 13'((i + 1) * (i + 1));
    end

    logic [2:0][5:0]   size_1;
    logic [2:0][12:0]  square_2;
    logic [13:0]       x_y_3, x_y_z_3;
    logic [12:0]       z_3;
    logic [6:0]        index_4, index;
    logic [16:0]       pace;

    assign x_y_z_3 = x_y_3 + {1'b0, z_3};

    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++) begin
            size_1[i]   <= direction[i][16:11] ^ {6{direction[i][17]}};
            square_2[i] <= squares[size_1[i]];
        end
        x_y_3   <= {1'b0, square_2[0]} + {1'b0, square_2[1]};
        z_3     <= square_2[2];
        index_4 <= x_y_z_3[13:7];
        pace    <= paces[index];
    end

    delay #(.WIDTH(7), .CLOCKS(DISTANCE - 5)) pace_waits (.clk, .enable(1'b1), .in(index_4), .out(index));

    delay #(.WIDTH(1), .CLOCKS(DISTANCE - 2)) going (.clk, .enable(1'b1), .in(gone_5), .out(gone_next));

    // The number of the sphere in the current pass, and the nearest sphere of the earlier passes. `nearest` and `is_last` (high in the last
    // pass) are valid in the clock of the distance.
    logic signed [21:0]     distance;
    logic [2:0]             surface, face, pass, pass_3, last_pass, pass_early, pass_now, next_pass;
    logic [7:0]             share;
    logic                   is_last_early, is_last, is_last_next;
    raymarch_pkg::nearest_t so_far, so_far_4, nearest, last_nearest;

    field_unit #(.LEVELS(LEVELS), .BOXES(BOXES)) field (
        .clk, .solid, .sphere_write, .sphere_number, .sphere, .pass(pass_3), .point(point_4), .so_far(so_far_4), .distance, .surface, .face,
        .share, .nearest
    );

    delay #(.WIDTH(3), .CLOCKS(3)) pass_goes (.clk, .enable(1'b1), .in(pass), .out(pass_3));
    delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(4)) so_far_goes (.clk, .enable(1'b1), .in(so_far), .out(so_far_4));
    delay #(.WIDTH(3), .CLOCKS(DISTANCE - 5)) pass_waits (.clk, .enable(1'b1), .in(pass_3), .out(pass_early));
    delay #(.WIDTH(3), .CLOCKS(2)) pass_comes (.clk, .enable(1'b1), .in(pass_early), .out(pass_now));
    delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(4)) nearest_goes (.clk, .enable(1'b1), .in(nearest), .out(last_nearest));
    delay #(.WIDTH(1), .CLOCKS(3)) last_goes (.clk, .enable(1'b1), .in(is_last), .out(is_last_next));
    delay #(.WIDTH(3), .CLOCKS(3)) number_goes (.clk, .enable(1'b1), .in(next_pass), .out(last_pass));

    always_ff @(posedge clk) begin
        pass   <= again && last_pass != '0 ? last_pass : '0;
        so_far <= again && last_pass != '0 ? last_nearest : {1'b0, {21{1'b1}}, 3'd0};

        is_last_early <= pass_early == solid.last_sphere;
        is_last       <= is_last_early;
        // Number of the next pass; 0 after the last pass.
        next_pass     <= is_last ? '0 : pass_now + 1'b1;
    end

    // Values in the clock of the distance: T of this evaluation (`t_now`), the distance below which a ray hits (`threshold`), and the number
    // of earlier evaluations (`steps_now`).
    logic [raymarch_pkg::T_BITS-1:0] t_early, t_now;
    logic [18:0]          footprint;
    logic [19:0]          threshold;
    logic [STEP_BITS-1:0] steps_now, steps_next;

    delay #(.WIDTH(raymarch_pkg::T_BITS), .CLOCKS(DISTANCE - 1)) way (.clk, .enable(1'b1), .in(t), .out(t_early));
    delay #(.WIDTH(STEP_BITS), .CLOCKS(DISTANCE)) counted (.clk, .enable(1'b1), .in(steps), .out(steps_now));
    delay #(.WIDTH(STEP_BITS), .CLOCKS(3)) counted_on (.clk, .enable(1'b1), .in(steps_now), .out(steps_next));

    // T has two fraction bits fewer than the distance, and `tuning.footprint` is the exponent minus 7.
    assign footprint = t_early[23:5] >> tuning.footprint;

    always_ff @(posedge clk) begin
        t_now     <= t_early;
        threshold <= {4'b0, tuning.threshold} + {1'b0, footprint};
    end

    // Three clocks after the distance (suffix _next): the next T, whether the distance is below the threshold (`near_next`), the ray has left
    // the box, or the step limit is reached (`late_next`). T advances by distance·pace, rounded up, so that each step changes T; inside the
    // solid and before the last pass, T does not change. The bit above T is set if the ray is beyond the largest T.
    logic                            near_1, late_1, near_next, late_next, beyond;
    logic [raymarch_pkg::T_BITS-1:0] t_2;
    logic signed [raymarch_pkg::T_BITS+17:0] sum_next;

    delay #(.WIDTH(raymarch_pkg::T_BITS), .CLOCKS(2)) way_goes (.clk, .enable(1'b1), .in(t_now), .out(t_2));
    delay #(.WIDTH(2), .CLOCKS(2)) states (.clk, .enable(1'b1), .in({near_1, late_1}), .out({near_next, late_next}));

    multiply_add #(.BITS(raymarch_pkg::T_BITS + 18)) advance (
        .clk, .enable(1'b1), .a({4'b0, distance[20:0] & {21{!distance[21] && is_last}}}), .b({1'b0, pace}), .c({2'b0, t_2, {16{1'b1}}}),
        .p(sum_next)
    );

    assign beyond = gone_next || early_ray.over || sum_next[raymarch_pkg::T_BITS+16];

    always_ff @(posedge clk) begin
        near_1 <= distance < $signed({2'b0, threshold});
        late_1 <= steps_now + 10'd1 >= tuning.cap;

        finished   <= is_last_next && (beyond || near_next || late_next);
        last_state <= beyond ? raymarch_pkg::MISS : near_next ? raymarch_pkg::HIT : raymarch_pkg::UNDECIDED;
        last_t     <= sum_next[raymarch_pkg::T_BITS+15:16];
        last_steps <= steps_next + STEP_BITS'(is_last_next);
    end

    delay #(.WIDTH(14), .CLOCKS(4)) surfaces (
        .clk, .enable(1'b1), .in({surface, face, share}), .out({last_surface, last_face, last_share})
    );

    raymarch_pkg::end_t end_in;

    always_comb begin
        end_in.place     = last_ray.place;
        end_in.direction = last_ray.direction;
        end_in.t         = last_state == raymarch_pkg::MISS ? raymarch_pkg::END_T_BITS'(last_ray.height) : {last_t, 4'b0};
        // The number of evaluations is saturated at 255.
        end_in.steps     = last_steps[STEP_BITS-1:8] != '0 ? '1 : last_steps[7:0];
        end_in.state     = last_state;
        end_in.round     = 1'b1;
        end_in.surface   = last_surface;
        end_in.face      = last_face;
        end_in.share     = last_share;
    end

    // `end_ready` is always high when a ray ends, because each ray has a reserved entry.
    fifo #(.WIDTH(raymarch_pkg::END_BITS), .DEPTH(PLACES)) ends (
        .clk, .rst, .in_valid(ended), .in_ready(end_ready), .in_data(end_in), .out_valid, .out_ready, .out_data(out_end)
    );

    wire _unused = &{1'b0, end_ready, last_ray.over, x_y_z_3[6:0], sum_next[raymarch_pkg::T_BITS+17], sum_next[15:0]};
endmodule

`default_nettype wire

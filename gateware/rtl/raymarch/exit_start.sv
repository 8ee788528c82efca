// Generates rays by exits, each already at its exit from the empty prism around the eye (docs/raymarch-exits.md, "Principle").
//
//   D ─┬─▶ signs, magnitudes ─▶ exit_reciprocal for each axis ─▶ exit_quotient ─▶ exit_choice ─▶ larger of the exit and the near plane
//      └─▶ sky_height
//
// With OCTAHEDRON, in a frame with `diagonals`, the axes are three diagonals of an octahedron, and a fourth axis is their sum. A ray leaves
// the prism by the last of all exits, and has then also entered the slab of the fourth axis.
//
// With LATTICE, the square of D's length and its reciprocal are added to each ray, for spheres of a lattice.
//
// The prism is a constant of the frame. For each eye, and for each axis in both directions, it consists of: the distance of the plane that
// bounds the prism (`distances`), whether there is such a plane (`there`), the interval above this plane (`nexts`), whether this interval
// is above the solid (`last`), and whether a ray in this direction leads away from the solid (`away`). `choice`, for each eye, has the
// meaning of `choice` in exit_borders. If the eye is in no such prism, there are no planes, and the rays start at the near plane.
//
// Latency 22 clocks, throughput one ray per clock, no handshake: `in_valid` travels with the ray. The constants must hold.

`default_nettype none

module exit_start #(
    parameter bit STEREO  = 1'b1,
    parameter bit LATTICE = 1'b0,
    parameter bit OCTAHEDRON = 1'b0
) (
    input  wire                                                   clk,
    input  wire                                                   rst,
    input  wire  [exit_pkg::T_BITS-1:0]                           near_limit,
    input  wire  [exit_pkg::T_BITS-1:0]                           far_limit,
    input  wire  [1:0][1:0]                                       choice,
    input  wire  [1:0][1:0][2:0][exit_pkg::PLANE_BITS-1:0]       distances,
    input  wire  [1:0][1:0][2:0]                                  there,
    input  wire  [1:0][1:0][2:0]                                  away,
    input  wire  [1:0][1:0][2:0]                                  last,
    input  wire  [1:0][1:0][2:0][exit_pkg::INTERVAL_BITS-1:0]     nexts,
    // Used with OCTAHEDRON: whether the solid is an octahedron, and the constants of its fourth axis.
    input  wire                                                   diagonals,
    input  wire  [1:0][1:0][exit_pkg::PLANE_BITS-1:0]            sum_distances,
    input  wire  [1:0][1:0]                                       sum_there,
    input  wire  [1:0][1:0]                                       sum_away,
    // Pixels.
    input  wire                                                   in_valid,
    input  wire raymarch_pkg::place_t                             in_place,
    input  wire  [2:0][27:0]                                      in_direction,
    // Rays.
    output logic                                                  out_valid,
    output exit_pkg::ray_t                                        out_ray
);
    localparam int unsigned LAST = 22;

    logic [LAST:1] valid;

    always_ff @(posedge clk) begin
        valid <= {valid[LAST-1:1], in_valid};
        if (rst) valid <= '0;
    end

    // The suffix of a name is the signal's clock: 1 for the magnitudes of D, 13 for their reciprocals and for the distances of the planes,
    // 18 for the exits, 20 for the exit at which the ray leaves the prism.
    logic [2:0][26:0] magnitude_1;
    logic             eye_1, eye_12, eye_18;
    logic [2:0]       down_1, down_12, down_18, down_22;
    logic [2:0][exit_pkg::INVERSE_BITS-1:0] inverse_13, inverse_22;
    logic [2:0][exit_pkg::SPEED_BITS-1:0]   speed_1, speed_22;
    logic [2:0][exit_pkg::PLANE_BITS-1:0]  distance_13;
    logic [2:0][exit_pkg::EXIT_BITS-1:0]    exit_18;

    always_ff @(posedge clk) begin
        eye_1 <= STEREO && in_place.eye;
        for (int i = 0; i < 3; i++) begin
            down_1[i]      <= in_direction[i][27];
            magnitude_1[i] <= in_direction[i][26:0] ^ {27{in_direction[i][27]}};
        end
    end

    delay #(.WIDTH(4), .CLOCKS(11)) signs_wait (.clk, .enable(1'b1), .in({eye_1, down_1}), .out({eye_12, down_12}));
    delay #(.WIDTH(4), .CLOCKS(6)) signs_go (.clk, .enable(1'b1), .in({eye_12, down_12}), .out({eye_18, down_18}));
    delay #(.WIDTH(3), .CLOCKS(4)) down_goes (.clk, .enable(1'b1), .in(down_18), .out(down_22));

    for (genvar i = 0; i < 3; i++) begin : axes
        exit_reciprocal reciprocal (.clk, .magnitude(magnitude_1[i]), .inverse(inverse_13[i]));

        assign speed_1[i] = magnitude_1[i][26:4];

        always_ff @(posedge clk)
            distance_13[i] <= eye_12 ? down_12[i] ? distances[1][1][i] : distances[1][0][i]
                                     : down_12[i] ? distances[0][1][i] : distances[0][0][i];

        exit_quotient quotient (.clk, .distance(distance_13[i]), .inverse(inverse_13[i]), .t(exit_18[i]));
    end

    wide_delay #(.WIDTH(3 * exit_pkg::INVERSE_BITS), .CLOCKS(9)) inverse_waits (.clk, .zero(1'b0), .in(inverse_13), .out(inverse_22));
    wide_delay #(.WIDTH(3 * exit_pkg::SPEED_BITS), .CLOCKS(21)) speed_waits (.clk, .zero(1'b0), .in(speed_1), .out(speed_22));

    logic [2:0] there_18, away_18, away_19, away_20, away_21, last_18, last_19, last_20, crossed_20, above_21;
    logic       some_19, some_20;
    logic [1:0] axis_20;
    logic [exit_pkg::EXIT_BITS-1:0] exit_20;
    logic [2:0][exit_pkg::INTERVAL_BITS-1:0] next_18, next_19, next_20;

    always_comb
        for (int i = 0; i < 3; i++) begin
            there_18[i] = eye_18 ? down_18[i] ? there[1][1][i] : there[1][0][i] : down_18[i] ? there[0][1][i] : there[0][0][i];
            away_18[i]  = eye_18 ? down_18[i] ? away[1][1][i] : away[1][0][i] : down_18[i] ? away[0][1][i] : away[0][0][i];
            last_18[i]  = eye_18 ? down_18[i] ? last[1][1][i] : last[1][0][i] : down_18[i] ? last[0][1][i] : last[0][0][i];
            next_18[i]  = eye_18 ? down_18[i] ? nexts[1][1][i] : nexts[1][0][i] : down_18[i] ? nexts[0][1][i] : nexts[0][0][i];
        end

    exit_choice leaving (
        .clk, .exits(exit_18), .there(there_18), .choice(eye_18 ? choice[1] : choice[0]), .t(exit_20), .axis(axis_20), .crossed(crossed_20)
    );

    // A ray is a miss without an evaluation if it leads away from the solid, has left the solid, or leaves the prism beyond the far limit.
    logic [exit_pkg::T_BITS-1:0] exit_21, start_22;
    logic [1:0] axis_21, axis_22;
    logic [2:0][exit_pkg::INTERVAL_BITS-1:0] reached_21, reached_22;
    logic       later_21, beyond_21, over_22, sum_away_21, down_sum_22;

    always_ff @(posedge clk) begin
        next_19 <= next_18;
        next_20 <= next_19;
        some_19 <= there_18 != '0;
        some_20 <= some_19;
        away_19 <= away_18;
        away_20 <= away_19;
        last_19 <= last_18;
        last_20 <= last_19;

        away_21   <= away_20;
        above_21  <= last_20 & crossed_20;
        for (int i = 0; i < 3; i++) reached_21[i] <= crossed_20[i] ? next_20[i] : '0;

        start_22   <= later_21 ? exit_21 : near_limit;
        axis_22    <= axis_21;
        reached_22 <= reached_21;
        over_22    <= away_21 != '0 || beyond_21 || above_21 != '0 || sum_away_21;
    end

    // The last exit and its axis, and the direction for the sky. If the exit of the fourth axis equals another exit, the
    // exit of the fourth axis counts as the later one.
    logic            sky_down_1;
    logic [2:0][9:0] part_1;
    logic [7:0]      height_10, height_22;

    if (OCTAHEDRON) begin : octahedron
        logic signed [27:0] x_0, y_0, z_0, z_1, sum_2;
        logic signed [28:0] sum_1;
        logic [26:0]        magnitude_3;
        logic               eye_14, eye_20, down_3, down_14, down_20, there_20, later_20, some_21;
        logic signed [11:0] half_x_1, half_y_1, half_z_1;
        logic [exit_pkg::PLANE_BITS-1:0]   distance_15;
        logic [exit_pkg::INVERSE_BITS-1:0] inverse_15;
        logic [exit_pkg::EXIT_BITS-1:0]    sum_exit_20, last_21;

        assign {z_0, y_0, x_0} = in_direction;

        // An integer k stands for k + 1/2. The three halves add up to 3/2, so the integer of the sum is the sum of the integers
        // plus 1. The sum of the components along two diagonals is half the component along an axis.
        always_ff @(posedge clk) begin
            sum_1       <= 29'(x_0) + 29'(y_0) + 29'sd1;
            z_1         <= z_0;
            sum_2       <= sum_1[27:0] + z_1;
            down_3      <= sum_2[27];
            magnitude_3 <= sum_2[26:0] ^ {27{sum_2[27]}};
            distance_15 <= eye_14 ? down_14 ? sum_distances[1][1] : sum_distances[1][0] : down_14 ? sum_distances[0][1] : sum_distances[0][0];
            half_x_1    <= 12'($signed(y_0[27:17])) + 12'($signed(z_0[27:17]));
            half_y_1    <= 12'($signed(x_0[27:17])) + 12'($signed(z_0[27:17]));
            half_z_1    <= 12'($signed(x_0[27:17])) + 12'($signed(y_0[27:17]));
        end

        exit_reciprocal reciprocal (.clk, .magnitude(magnitude_3), .inverse(inverse_15));
        exit_quotient quotient (.clk, .distance(distance_15), .inverse(inverse_15), .t(sum_exit_20));
        delay #(.WIDTH(1), .CLOCKS(2)) eye_waits (.clk, .enable(1'b1), .in(eye_12), .out(eye_14));
        delay #(.WIDTH(1), .CLOCKS(2)) eye_goes (.clk, .enable(1'b1), .in(eye_18), .out(eye_20));
        delay #(.WIDTH(1), .CLOCKS(11)) down_waits (.clk, .enable(1'b1), .in(down_3), .out(down_14));
        delay #(.WIDTH(1), .CLOCKS(6)) down_goes (.clk, .enable(1'b1), .in(down_14), .out(down_20));
        delay #(.WIDTH(1), .CLOCKS(2)) down_leaves (.clk, .enable(1'b1), .in(diagonals && down_20), .out(down_sum_22));

        assign there_20 = eye_20 ? sum_there[1][down_20] : sum_there[0][down_20];
        assign later_20 = there_20 && (!some_20 || sum_exit_20 >= exit_20);

        always_ff @(posedge clk) begin
            last_21     <= later_20 ? sum_exit_20 : exit_20;
            axis_21     <= later_20 ? 2'd3 : some_20 ? axis_20 : 2'd2;
            some_21     <= some_20 || there_20;
            sum_away_21 <= eye_20 ? sum_away[1][down_20] : sum_away[0][down_20];
        end

        assign exit_21    = last_21[exit_pkg::T_BITS-1:0];
        assign later_21   = some_21 && last_21 > {1'b0, near_limit};
        assign beyond_21  = some_21 && last_21 > {1'b0, far_limit};
        assign sky_down_1 = diagonals ? half_z_1[11] : down_1[2];

        always_comb begin
            for (int i = 0; i < 3; i++) part_1[i] = magnitude_1[i][26:17];
            if (diagonals) begin
                part_1[0] = half_x_1[9:0] ^ {10{half_x_1[11]}};
                part_1[1] = half_y_1[9:0] ^ {10{half_y_1[11]}};
                part_1[2] = half_z_1[9:0] ^ {10{half_z_1[11]}};
            end
        end
        wire _unused = &{1'b0, sum_1[28], half_x_1[10], half_y_1[10], half_z_1[10]};
    end else begin : no_octahedron
        always_ff @(posedge clk) begin
            exit_21   <= exit_20[exit_pkg::T_BITS-1:0];
            later_21  <= some_20 && exit_20 > {1'b0, near_limit};
            beyond_21 <= some_20 && exit_20 > {1'b0, far_limit};
            axis_21   <= some_20 ? axis_20 : 2'd2;
        end
        assign {sum_away_21, down_sum_22} = '0;
        assign sky_down_1 = down_1[2];
        always_comb for (int i = 0; i < 3; i++) part_1[i] = magnitude_1[i][26:17];

        wire _unused = &{1'b0, diagonals, sum_distances, sum_there, sum_away};
    end

    sky_height sky (.clk, .magnitude(part_1), .down(sky_down_1), .height(height_10));
    delay #(.WIDTH(8), .CLOCKS(12)) height_waits (.clk, .enable(1'b1), .in(height_10), .out(height_22));

    // The square of D's length, after D is doubled until its length is at least 1 and below 2.
    exit_pkg::length_t         length_22;
    exit_pkg::inverse_square_t inverse_square_22;

    if (LATTICE) begin : lattice
        logic [22:0]        y_2, z_2, z_3;
        logic signed [42:0] square_4, square_5, square_6;
        logic [41:0]        square_7;
        logic [24:0]        square_8;
        logic [16:0]        short_9;
        logic [1:0]         doublings_7, doublings_8, doublings_9, doublings_18;
        logic [22:0]        mantissa_18;
        logic [4:0]         exponent_18;
        exit_pkg::inverse_square_t inverse_19;

        square_add square_x (.clk, .x({1'b0, speed_1[0]}), .c('0), .p(square_4));
        square_add square_y (.clk, .x({1'b0, y_2}), .c(square_4), .p(square_5));
        square_add square_z (.clk, .x({1'b0, z_3}), .c(square_5), .p(square_6));

        always_ff @(posedge clk) begin
            y_2         <= speed_1[1];
            z_2         <= speed_1[2];
            z_3         <= z_2;
            // `square_6` has 40 fraction bits. `square_8`, after the doublings, has 23.
            square_7    <= square_6[41:0];
            doublings_7 <= square_6[41:40] != '0 ? 2'd0 : square_6[39:38] != '0 ? 2'd1 : square_6[37:36] != '0 ? 2'd2 : 2'd3;
            unique case (doublings_7)
                2'd0: square_8 <= square_7[41:17];
                2'd1: square_8 <= square_7[39:15];
                2'd2: square_8 <= square_7[37:13];
                2'd3: square_8 <= square_7[35:11];
            endcase
            doublings_8 <= doublings_7;
            // Rounded to nearest, and saturated below 4.
            short_9     <= square_8[24:8] + 17'(square_8[7] && square_8[24:8] != '1);
            doublings_9 <= doublings_8;
            inverse_19  <= {3'(exponent_18[1:0]) + 3'(doublings_18), mantissa_18[21:4]};
        end

        exit_mantissa reciprocal (.clk, .enable(1'b1), .whole({square_8, 3'd0}), .mantissa(mantissa_18), .exponent(exponent_18));
        delay #(.WIDTH(2), .CLOCKS(9)) doublings_wait (.clk, .enable(1'b1), .in(doublings_9), .out(doublings_18));
        wide_delay #(.WIDTH(exit_pkg::LENGTH_BITS), .CLOCKS(13)) length_waits (.clk, .zero(1'b0), .in({doublings_9, short_9}), .out(length_22));
        delay #(.WIDTH(exit_pkg::INVERSE_SQUARE_BITS), .CLOCKS(3)) reciprocal_waits (
            .clk, .enable(1'b1), .in(inverse_19), .out(inverse_square_22)
        );

        wire _unused = &{1'b0, square_6[42], square_7[10:0], mantissa_18[22], mantissa_18[3:0], exponent_18[4:2]};
    end else begin : no_lattice
        assign {length_22, inverse_square_22} = '0;
    end

    raymarch_pkg::place_t place_22;

    delay #(.WIDTH(raymarch_pkg::PLACE_BITS), .CLOCKS(22)) place_waits (.clk, .enable(1'b1), .in(in_place), .out(place_22));

    assign out_valid = valid[LAST];
    assign out_ray   = {exit_pkg::MEETING_BITS'(0), inverse_square_22, length_22, down_sum_22, over_22, place_22, start_22, axis_22,
                        reached_22, down_22, height_22, speed_22, inverse_22};
endmodule

`default_nettype wire

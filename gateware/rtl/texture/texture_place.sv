// Positions of pixels in a texture, and their mip level (docs/formats/texture.md, "On a triangle"), for four neighbouring pixels per clock.
//
// A quad is four neighbouring pixels, lanes 0 to 3 or 4 to 7 of a group of eight. The level of a group is that of its first covered pixel,
// so the quads of a group follow each other, and the first of them has the flag `first`.
//
//   clock    0 … 3          4, 5       6 … 9                10 … 12    13 … 15
//   depth ─▶ four lanes ─▶ zeros ─▶ table, slope: 1/D ─┐
//   s, t  ─▶ four lanes ───────────────────────────────┴─▶ A/D ─┬─▶ shifts, base ──────────────────────────────▶ positions
//                                                               └─▶ σ of the first pixel ─▶ changes ─▶ magnitudes ─▶ level
//   clock                                                           13, 14                  15 … 17    18 … 24
//
// Twelve multipliers are used for the divisions, and four for the changes that determine the level. Each lane has a table of inverses, half
// a RAMB36. Latency 24 clocks, throughput one quad per clock; the pipeline cannot be stopped. `sampler` must hold while quads are inside.

`default_nettype none

module texture_place (
    input  wire              clk,
    input  wire              rst,
    input  wire texture_pkg::sampler_t sampler,
    input  wire              in_valid,
    input  wire  [3:0]       in_mask,      // covered pixels
    input  wire              in_half,      // lanes 4 to 7
    input  wire              in_first,
    input  wire              in_last,
    // records_pkg::plane_t of depth, s and t, from the lowest bits, with the accumulators in lane 0 of the group; half a code is added to the
    // depth.
    input  wire  [2:0][95:0] in_planes,
    input  wire              in_linear,    // orthographic projection: a constant replaces the depth
    input  wire  [1:0][3:0]  in_range,     // base-2 logarithm of the range of s and t, in repeats
    input  wire  [1:0][3:0]  in_periods,   // base of clamped coordinates, signed, in units of two repeats
    output logic             out_valid,
    output logic [3:0]       out_mask,
    output logic             out_half,
    output logic             out_last,
    output logic [3:0]       out_level,
    output logic [1:0][3:0][17:0] out_positions // position_t by axis and lane
);
    localparam int unsigned LATENCY = 24;

    // The accumulators in the lanes of the quad: first in lane 0, one clock later in lanes 0 and 2, then in all four.
    logic [2:0][31:0]      start_1, step_1, step_2;
    logic [2:0][1:0][31:0] two;
    logic [2:0][3:0][31:0] values;

    for (genvar k = 0; k < 3; k++) begin : planes
        records_pkg::plane_t plane;

        assign plane = in_planes[k];

        always_ff @(posedge clk) begin
            start_1[k] <= plane.start + (in_half ? plane.step_x << 2 : '0);
            step_1[k]  <= plane.step_x;
            two[k][0]  <= start_1[k];
            two[k][1]  <= start_1[k] + (step_1[k] << 1);
            step_2[k]  <= step_1[k];
            for (int i = 0; i < 2; i++) begin
                values[k][2 * i]     <= two[k][i];
                values[k][2 * i + 1] <= two[k][i] + step_2[k];
            end
        end

        wire _unused = &{1'b0, plane};
    end

    // Other fields of a quad or of its triangle; the suffix of a name is the signal's clock.
    logic [LATENCY:1] valid;
    logic [3:0]       mask_5, mask_12;
    logic [1:0]       lane_5, lane_12;
    logic [1:0][3:0]  range_5, range_20, periods_14;
    logic             first_23, linear_3, linear_13;

    always_ff @(posedge clk) begin
        valid <= {valid[LATENCY-1:1], in_valid};
        if (rst) valid <= '0;
    end

    delay #(.WIDTH(4), .CLOCKS(5)) mask_delay (.clk, .enable(1'b1), .in(in_mask), .out(mask_5));
    delay #(.WIDTH(4), .CLOCKS(7)) mask_delay_12 (.clk, .enable(1'b1), .in(mask_5), .out(mask_12));
    delay #(.WIDTH(4), .CLOCKS(12)) mask_delay_24 (.clk, .enable(1'b1), .in(mask_12), .out(out_mask));
    delay #(.WIDTH(2), .CLOCKS(LATENCY)) place_delay (.clk, .enable(1'b1), .in({in_half, in_last}), .out({out_half, out_last}));
    delay #(.WIDTH(8), .CLOCKS(5)) range_delay (.clk, .enable(1'b1), .in(in_range), .out(range_5));
    delay #(.WIDTH(8), .CLOCKS(15)) range_delay_20 (.clk, .enable(1'b1), .in(range_5), .out(range_20));
    delay #(.WIDTH(8), .CLOCKS(14)) periods_delay (.clk, .enable(1'b1), .in(in_periods), .out(periods_14));
    delay #(.WIDTH(1), .CLOCKS(3)) linear_delay (.clk, .enable(1'b1), .in(in_linear), .out(linear_3));
    delay #(.WIDTH(1), .CLOCKS(10)) linear_delay_13 (.clk, .enable(1'b1), .in(linear_3), .out(linear_13));
    delay #(.WIDTH(1), .CLOCKS(LATENCY - 1)) first_delay (.clk, .enable(1'b1), .in(in_first), .out(first_23));

    assign out_valid = valid[LATENCY];
    assign lane_5    = lowest(mask_5[2:0]);
    assign lane_12   = lowest(mask_12[2:0]);

    // Returns the first covered lane. At least one of the four lanes is covered, so the mask of the first three suffices.
    function automatic logic [1:0] lowest(input logic [2:0] mask);
        lowest = mask[0] ? 2'd0 : mask[1] ? 2'd1 : mask[2] ? 2'd2 : 2'd3;
    endfunction

    // Division by the depth. Entry i of the table contains 2^20/(1 + i/512) + 2, rounded to nearest, and the negative difference to the
    // next entry. The value of entry 0 is reduced to 2^20 - 1, so that every inverse is below 1.
    logic [3:0][3:0]       zeros_5;
    logic [3:0][2:0]       top_5;
    logic [1:0][3:0][41:0] shares;
    logic [1:0][3:0][4:0]  shifts_12;
    logic [3:0][3:0]       zeros_12;

    for (genvar lane = 0; lane < 4; lane++) begin : lanes
        (* ram_style = "block" *) logic [32:0] inverses [0:511];

        for (genvar i = 0; i < 512; i++) begin : rows
            localparam int FROM = i == 0 ? (1 << 20) - 3 : ((1 << 30) + 512 + i) / (2 * (512 + i));
            localparam int TO   = ((1 << 30) + 513 + i) / (2 * (513 + i));

            initial inverses[i] = {12'(TO - FROM), 21'(FROM + 2)};
        end

        logic [31:0] depth;
        logic [1:0]  fours, ones, fours_4;
        logic [21:0] by_4;
        logic [8:0]  index, part, part_6;
        logic [3:0]  zeros;
        logic [32:0] entry;
        logic [20:0] from_7, from_8;
        logic signed [31:0] inverse;

        assign depth = values[0][lane];
        assign fours = linear_3 || depth[31:28] != '0 ? 2'd0 : depth[27:24] != '0 ? 2'd1 : 2'd2;
        assign ones  = by_4[21] ? 2'd0 : by_4[20] ? 2'd1 : by_4[19] ? 2'd2 : 2'd3;

        always_ff @(posedge clk) begin
            fours_4 <= fours;
            case (fours)
                // The constant that replaces the depth is 2^31.
                2'd0:    by_4 <= linear_3 ? {1'b1, 21'd0} : depth[31:10];
                2'd1:    by_4 <= depth[27:6];
                default: by_4 <= depth[23:2];
            endcase
            zeros <= {fours_4, ones};
            case (ones)
                2'd0: {index, part} <= by_4[20:3];
                2'd1: {index, part} <= by_4[19:2];
                2'd2: {index, part} <= by_4[18:1];
                2'd3: {index, part} <= by_4[17:0];
            endcase
            part_6 <= part;
            from_7 <= entry[20:0];
            from_8 <= from_7;
        end

        always_ff @(posedge clk) entry <= inverses[index];

        multiply_add #(.BITS(32)) slope (
            .clk, .enable(1'b1), .a(25'($signed(entry[32:21]))), .b({9'd0, part_6}), .c({2'b0, from_8, 9'd255}), .p(inverse)
        );

        assign zeros_5[lane] = zeros;
        assign top_5[lane]   = index[8:6];

        delay #(.WIDTH(4), .CLOCKS(7)) zeros_delay (.clk, .enable(1'b1), .in(zeros), .out(zeros_12[lane]));

        for (genvar axis = 0; axis < 2; axis++) begin : axes
            logic               negative, negative_8;
            logic [23:0]        value_9, value_10, value_11;
            logic signed [42:0] product;
            logic [4:0]         shift;

            // Negative accumulators, which rounding may cause if the exact value is 0, count as 0.
            assign negative = values[1 + axis][lane][31:26] == '1;

            delay #(.WIDTH(1), .CLOCKS(5)) negative_delay (.clk, .enable(1'b1), .in(negative), .out(negative_8));
            wide_delay #(.WIDTH(24), .CLOCKS(6)) value_delay (.clk, .zero(negative_8), .in(values[1 + axis][lane][31:8]), .out(value_9));

            always_ff @(posedge clk) begin
                value_10 <= value_9;
                value_11 <= value_10;
            end

            // The highest bit of an inverse is 1.
            multiply_add #(.BITS(43)) share (
                .clk, .enable(1'b1), .a({1'b0, value_9}), .b({1'b0, inverse[27:11]}), .c({2'b0, value_11, 17'd0}), .p(product)
            );

            assign shares[axis][lane] = product[41:0];
            assign shift              = 5'(zeros) + 5'(range_5[axis]);

            delay #(.WIDTH(5), .CLOCKS(7)) shift_delay (.clk, .enable(1'b1), .in(shift), .out(shifts_12[axis][lane]));

            wire _unused = &{1'b0, values[1 + axis][lane][7:0], product[42]};
        end

        wire _unused = &{1'b0, depth[1:0], inverse[31:28], inverse[10:0]};
    end

    // Positions. A share times 2^shift has 41 fraction bits. The results are five integer bits, 15 fraction bits, and whether higher bits
    // are set.
    logic [1:0][3:0][17:0] positions;

    for (genvar axis = 0; axis < 2; axis++) begin : position_axes
        for (genvar lane = 0; lane < 4; lane++) begin : position_lanes
            logic [41:0] share;
            logic [4:0]  shift;
            logic [2:0]  shift_13;
            logic        shift_14, beyond_13, beyond_14, beyond;
            logic [26:0] by_8;
            logic [20:0] by_2;
            logic [19:0] repeats;
            logic signed [6:0] whole;
            texture_pkg::position_t position;

            assign share = shares[axis][lane];
            assign shift = shifts_12[axis][lane];

            always_ff @(posedge clk) begin
                unique case (shift[4:3])
                    2'd0: {beyond_13, by_8} <= {1'b0, 4'd0, share[41:19]};
                    2'd1: {beyond_13, by_8} <= {share[41:38] != '0, share[37:11]};
                    2'd2: {beyond_13, by_8} <= {share[41:30] != '0, share[29:3]};
                    2'd3: {beyond_13, by_8} <= {share[41:22] != '0, share[21:0], 5'd0};
                endcase
                shift_13 <= shift[2:0];

                unique case (shift_13[2:1])
                    2'd0: {beyond_14, by_2} <= {beyond_13, by_8[26:6]};
                    2'd1: {beyond_14, by_2} <= {beyond_13 || by_8[26:25] != '0, by_8[24:4]};
                    2'd2: {beyond_14, by_2} <= {beyond_13 || by_8[26:23] != '0, by_8[22:2]};
                    2'd3: {beyond_14, by_2} <= {beyond_13 || by_8[26:21] != '0, by_8[20:0]};
                endcase
                shift_14 <= shift_13[0];
            end

            assign repeats = shift_14 ? by_2[19:0] : by_2[20:1];
            assign beyond  = beyond_14 || shift_14 && by_2[20];
            assign whole   = 7'(repeats[19:15]) + {{2{periods_14[axis][3]}}, periods_14[axis], 1'b0};

            assign position.below    = !beyond && whole[6];
            assign position.past     = beyond || !whole[6] && whole != '0;
            assign position.odd      = repeats[15];
            assign position.fraction = repeats[14:0];

            always_ff @(posedge clk) positions[axis][lane] <= position;
        end
    end

    wide_delay #(.WIDTH(8 * 18), .CLOCKS(LATENCY - 15)) positions_delay (.clk, .zero(1'b0), .in(positions), .out(out_positions));

    // The mip level of the first pixel. From a pixel to the next pixel to the right, or down, a coordinate changes by G - σ·Gd, where G is
    // the gradient of the coordinate and Gd the gradient of the depth.
    logic [5:0][23:0] gradients;
    logic [1:0][23:0] depth_gradients; // at clock 14
    logic [3:0][23:0] gradients_16;    // of s and t

    for (genvar k = 0; k < 3; k++) begin : gradients_of
        records_pkg::plane_t plane;

        assign plane                = in_planes[k];
        assign gradients[2 * k]     = plane.step_x[31:8];
        assign gradients[2 * k + 1] = plane.step_y[31:8];

        wire _unused = &{1'b0, plane};
    end

    wide_delay #(.WIDTH(2 * 24), .CLOCKS(14)) depth_delay_14 (.clk, .zero(linear_13), .in(gradients[1:0]), .out(depth_gradients));
    wide_delay #(.WIDTH(4 * 24), .CLOCKS(16)) gradients_delay (.clk, .zero(1'b0), .in(gradients[5:2]), .out(gradients_16));

    logic [1:0][1:0][27:0] sizes;
    logic [1:0][8:0]       magnitudes;

    for (genvar axis = 0; axis < 2; axis++) begin : changes
        // `keep` prevents synthesis from merging the selection of a lane with the selection of a shift: each takes one LUT per bit.
        (* keep *) logic [27:0] share;
        (* keep *) logic [1:0]  fours;
        logic [1:0]  ones, zeros_13;
        logic [19:0] by_4;
        logic [16:0] not_sigma; // the complement of σ
        logic [27:0] most;
        logic [2:0]  nibble, nibble_20;
        logic [6:0]  head, head_20;
        logic [1:0]  zeros_of_head;
        logic [2:0]  head_part;

        always_comb
            unique case (lane_12)
                2'd0: {fours, ones, share} = {zeros_12[0], shares[axis][0][40:13]};
                2'd1: {fours, ones, share} = {zeros_12[1], shares[axis][1][40:13]};
                2'd2: {fours, ones, share} = {zeros_12[2], shares[axis][2][40:13]};
                2'd3: {fours, ones, share} = {zeros_12[3], shares[axis][3][40:13]};
            endcase

        always_ff @(posedge clk) begin
            unique case (fours)
                2'd0:    by_4 <= share[27:8];
                2'd1:    by_4 <= share[23:4];
                default: by_4 <= share[19:0];
            endcase
            zeros_13 <= ones;
            unique case (zeros_13)
                2'd0: not_sigma <= ~by_4[19:3];
                2'd1: not_sigma <= ~by_4[18:2];
                2'd2: not_sigma <= ~by_4[17:1];
                2'd3: not_sigma <= ~by_4[16:0];
            endcase
        end

        for (genvar direction = 0; direction < 2; direction++) begin : directions
            logic [23:0]        gradient_16;
            // As wide as the product, so that the adder of the DSP48 also computes the sign bit. The sum does not overflow.
            logic signed [41:0] change;

            assign gradient_16 = gradients_16[2 * axis + direction];

            always_ff @(posedge clk) sizes[axis][direction] <= change[40:13] ^ {28{change[41]}};

            // -(σ + 1) is the complement of σ.
            multiply_add #(.BITS(42)) change_of_axis (
                .clk, .enable(1'b1), .a(25'($signed(depth_gradients[direction]))), .b({1'b1, not_sigma}),
                .c({gradient_16[23], gradient_16, 17'd0}), .p(change)
            );

            wire _unused = &{1'b0, change[12:0]};
        end

        // The leading bit and three bits below it, in two steps.
        always_comb begin
            nibble = '0;
            for (int i = 1; i < 8; i++) if (4'({4'd0, most} >> (4 * i)) != '0) nibble = 3'(i);
            head = 7'({most, 3'd0} >> {nibble, 2'd0});
            zeros_of_head = head_20[6] ? 2'd0 : head_20[5] ? 2'd1 : head_20[4] ? 2'd2 : 2'd3;
            head_part = 3'(head_20 >> (2'd3 - zeros_of_head));
        end

        always_ff @(posedge clk) begin
            most      <= sizes[axis][1] > sizes[axis][0] ? sizes[axis][1] : sizes[axis][0];
            nibble_20 <= nibble;
            head_20   <= head;
            // The number of the magnitude's leading bit, in texels times the depth; the lowest bit of an accumulator has number 0.
            magnitudes[axis] <= {6'({nibble_20, 2'd3 - zeros_of_head}) + 6'd4 + 6'(range_20[axis]) + 6'(sampler.side_log2[axis]), head_part};
        end
    end

    // The level depends on the ratio of the larger magnitude to the depth, and changes at 1.5 times each power of two. The leading four
    // bits of both numbers suffice to compare them.
    logic [6:0]        depth_5, depth_22;
    logic [8:0]        most_22;
    logic [3:0]        most_part, depth_part, level;
    logic signed [7:0] above;

    assign depth_5 = {zeros_5[lane_5], top_5[lane_5]};

    delay #(.WIDTH(7), .CLOCKS(17)) depth_delay (.clk, .enable(1'b1), .in(depth_5), .out(depth_22));

    always_comb begin
        most_part  = {1'b1, most_22[2:0]};
        depth_part = {1'b1, depth_22[2:0]};
        above      = 8'(most_22[8:3]) + 8'(depth_22[6:3]) - 8'd32;
        if (7'(most_part) * 2 > 7'(depth_part) * 3)      above = above + 8'd2;
        else if (7'(most_part) * 4 > 7'(depth_part) * 3) above = above + 8'd1;
    end

    always_ff @(posedge clk) begin
        most_22 <= magnitudes[1] > magnitudes[0] ? magnitudes[1] : magnitudes[0];
        level   <= above < 0 ? '0 : above > 8'(sampler.last_level) ? sampler.last_level : above[3:0];
        if (valid[LATENCY-1] && first_23) out_level <= level;
    end

    wire _unused = &{1'b0, sampler};
endmodule

`default_nettype wire

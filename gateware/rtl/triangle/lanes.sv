// Determines the pixels (lanes) of a group of eight that a triangle covers, and their depth codes (docs/formats/triangle.md, "Pixels").
//
// Coverage: E' is the value of an edge function (docs/formats/triangle.md, "Triangle setup"); an edge passes in a lane if E' is at least 0
// in this lane. E' is largest in the edge's best lane, which is lane 7 of a rising edge and lane 0 of a falling edge, and decreases by
// |step_x| from lane to lane. If E' is at least 0 in the best lane, the edge passes in that lane and in the next min(7, floor(E' /
// |step_x|)) lanes; the quotient is computed in three steps of a division. If E' is at least 2^23, which exceeds 7 * 2^20, the edge passes
// in all lanes.
//
// The division is non-restoring: stages 1 to 3 add 4, 2 and 1 times |step_x| to the remainder, or subtract it, so that the remainder
// approaches 0. Bits 2, 1 and 0 of the quotient (`count` in the table) are 1 if the remainder is at least 0 after stage 1, 2 and 3.
// Depth, line and colour of a group arrive one clock after its other fields, see raster_pkg. `lane_values` computes the depths of the
// lanes.
//
//   stage    1           2            3             4            5
//   count    bit 2       bit 1        bit 0         mask         kept if not 0
//   depth                lane_values                             codes, at least 1
//   address              5 * line     * stride / 5  + group
//
// `stride`, the number of groups in a row of the picture, is 40, 80 or 160 and must hold while groups are inside. `out_row` is
// the address of the group in the band buffer, computed from `out_line` and `out_column`.
//
// The pipeline cannot be stopped: valid bits travel with the groups, and a group without a covered pixel is dropped. Latency 5
// clocks, throughput one group per clock; all outputs are registers.

`default_nettype none

module lanes (
    input  wire                         clk,
    input  wire                         rst,
    input  wire  [7:0]                  stride,
    output logic                        idle,
    input  wire                         in_valid,
    input  wire raster_pkg::candidate_t in_group,
    input  wire raster_pkg::late_t      in_late,   // a clock after `in_group`
    output logic                        out_valid,
    output logic [10:0]                 out_row,
    output logic [5:0]                  out_line,
    output logic [7:0]                  out_column,
    output logic [7:0]                  out_mask,
    output logic [7:0][17:0]            out_codes,
    output logic [15:0]                 out_colour
);
    logic [4:1]       valid;
    logic [7:0]       mask;
    logic [7:0][31:0] values;

    assign idle = valid == '0 && !out_valid;

    always_ff @(posedge clk) begin
        valid     <= {valid[3:1], in_valid};
        out_valid <= valid[4] && mask != '0;
        if (rst) begin
            valid     <= '0;
            out_valid <= 1'b0;
        end
    end

    // Signals of each edge; the suffix of a name is the pipeline stage. `count` is the number of lanes besides the best lane in which the
    // edge passes, `rises` is high if the edge rises to the right, and `all` is high if the edge passes in all lanes.
    logic [2:0]      rises_1, rises_2, rises_3;
    logic [2:0]      all_1, all_2, all_3;
    logic [2:0][2:0] count_3;

    always_ff @(posedge clk) begin
        rises_1 <= in_group.rises;
        rises_2 <= rises_1;
        rises_3 <= rises_2;
        all_2   <= all_1;
        all_3   <= all_2;
    end

    for (genvar k = 0; k < 3; k++) begin : edges
        logic [32:0] best;
        logic [23:0] rest_1, rest_2;
        logic [19:0] slope_1, slope_2;
        logic [21:0] sum_1;
        logic [22:0] sum_2;
        logic [23:0] sum_3;
        logic        less_2, less_3, below_2, below_3, bit_2;

        assign best = in_group.best[k];

        // Stage n subtracts the slope if `less_n` is high, and adds it otherwise. The addition is a subtraction of the slope's one's
        // complement and of 1; the extra bit below the lowest bit subtracts this 1 as a borrow.
        assign less_2 = !rest_1[23];
        assign less_3 = !rest_2[23];
        assign sum_1  = {1'b0, best[22:2]} - {2'd0, in_group.slope[k]};
        assign {sum_2, below_2} = {rest_1[23:1], 1'b0} - {{23{!less_2}} ^ {3'd0, slope_1}, !less_2};
        assign {sum_3, below_3} = {rest_2, 1'b0} - {{24{!less_3}} ^ {4'd0, slope_2}, !less_3};

        always_ff @(posedge clk) begin
            all_1[k]   <= best[32:23] != '0;
            rest_1     <= {sum_1, best[1:0]};
            slope_1    <= in_group.slope[k];
            rest_2     <= {sum_2, rest_1[0]};
            slope_2    <= slope_1;
            bit_2      <= less_2;
            count_3[k] <= {bit_2, less_3, !sum_3[23]};
        end

        wire _unused = &{1'b0, sum_3[22:0], below_2, below_3};
    end

    always_ff @(posedge clk) begin
        for (int i = 0; i < 8; i++) begin
            mask[i] <= 1'b1;
            for (int k = 0; k < 3; k++)
                if (!all_3[k] && count_3[k] < 3'(rises_3[k] ? 7 - i : i)) mask[i] <= 1'b0;
        end
        out_mask <= mask;
    end

    lane_values depths (.clk, .in(in_late.depth), .step_x(in_late.depth_step_x), .values);

    always_ff @(posedge clk) begin
        for (int i = 0; i < 8; i++) begin
            out_codes[i] <= values[i][31:14];
            if (values[i][31:15] == '0) out_codes[i][0] <= 1'b1;
        end
    end

    // Position and colour of a group, delayed by the latency of its mask and depths.
    logic [7:0]  column_4;
    logic [5:0]  line_4;
    logic [15:0] colour_4;
    logic [7:0]  column_3;
    logic [8:0]  line_times_5;
    logic [10:0] first_row, row;

    delay #(.WIDTH(8), .CLOCKS(3)) column_delay (.clk, .enable(1'b1), .in(in_group.group), .out(column_3));
    delay #(.WIDTH(6 + 16), .CLOCKS(3)) place_delay (
        .clk, .enable(1'b1), .in({in_late.line, in_late.colour}), .out({line_4, colour_4})
    );

    always_ff @(posedge clk) begin
        line_times_5 <= {1'b0, in_late.line, 2'd0} + 9'(in_late.line);
        if (stride[7])      first_row <= {line_times_5[5:0], 5'd0};
        else if (stride[6]) first_row <= {line_times_5[6:0], 4'd0};
        else                first_row <= {line_times_5[7:0], 3'd0};
        row      <= first_row + 11'(column_3);
        column_4 <= column_3;

        out_row <= row;
        {out_line, out_column, out_colour} <= {line_4, column_4, colour_4};
    end

    wire _unused = &{1'b0, stride[5:0], line_times_5[8], in_late.depth_step_y};
endmodule

`default_nettype wire

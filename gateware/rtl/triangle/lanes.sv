// Computes which of the eight pixels (lanes) of a group a triangle covers, and their depth codes (docs/formats.md, "Pixels").
//
// Coverage: E' is the value of an edge function (docs/formats.md, "Triangle setup"); an edge passes in a lane if E' is at least
// 0 there. E' is largest in the edge's best lane, which is lane 7 of a rising edge and lane 0 of a falling one, and falls by
// |step_x| from lane to lane. If E' is at least 0 in the best lane, the edge passes in that lane and in the next min(7,
// floor(E' / |step_x|)) lanes; the quotient comes from three steps of a restoring division. From E' = 2^23 on, which exceeds 7
// * 2^20, the edge passes in all lanes.
//
// The depths of the lanes come from `lane_values`. In the table, `count` is the division of E' by |step_x|: stages 1 to 3
// compare the rest with 4, 2 and 1 times |step_x|, which gives bits 2, 1 and 0 of the quotient.
//
//   stage    1           2            3           4
//   count    bit 2       bit 1        bit 0       mask
//   depth    lane_values                          codes, at least 1
//   address  5 * line    * stride / 5 + group
//
// `stride`, the number of groups in a row of the picture, is 40, 80 or 160 and must hold while groups are inside. `out_row` is
// the address of the group in the band buffer, computed from `out_line` and `out_column`.
//
// Streams are valid/ready; ready passes through combinationally. Latency 4 clocks, throughput a group a clock. A group without
// a covered pixel is dropped. `early_depths` has the depth accumulators of a group one clock before the group leaves.

`default_nettype none

module lanes (
    input  wire                         clk,
    input  wire                         rst,
    input  wire  [7:0]                  stride,
    output logic                        idle,
    input  wire                         in_valid,
    output logic                        in_ready,
    input  wire raster_pkg::candidate_t in_group,
    output logic                        out_valid,
    input  wire                         out_ready,
    output logic [10:0]                 out_row,
    output logic [5:0]                  out_line,
    output logic [7:0]                  out_column,
    output logic [7:0]                  out_mask,
    output logic [7:0][17:0]            out_codes,
    output logic [15:0]                 out_colour,
    output logic [7:0][31:0]            early_depths
);
    logic [4:1] valid;

    assign in_ready = out_ready;
    assign idle     = valid == '0;

    always_ff @(posedge clk) begin
        if (out_ready) valid <= {valid[3:1], in_valid};
        if (rst) valid <= '0;
    end

    // For each edge and pipeline stage (the suffix of a name): `count`, the number of lanes beside the best one in which the
    // edge passes, `rises`, whether the edge rises to the right, and `all`, whether it passes in all lanes.
    logic [2:0]      rises_1, rises_2, rises_3;
    logic [2:0]      all_1, all_2, all_3;
    logic [2:0][2:0] count_3;

    always_ff @(posedge clk) begin
        if (out_ready) begin
            rises_1 <= in_group.rises;
            rises_2 <= rises_1;
            rises_3 <= rises_2;
            all_2   <= all_1;
            all_3   <= all_2;
        end
    end

    for (genvar k = 0; k < 3; k++) begin : edges
        logic [22:0] best, rest_1, rest_2;
        logic [19:0] slope_1, slope_2;
        logic [20:0] less_4;
        logic [21:0] less_2;
        logic [22:0] less_1;
        logic        below_4, below_2, below_1;
        logic        bit_2, bit_1, bit_2_late;

        assign best = in_group.best[k][22:0];
        assign {below_4, less_4} = {1'b0, best[22:2]} - {2'd0, in_group.slope[k]};
        assign {below_2, less_2} = {1'b0, rest_1[22:1]} - {3'd0, slope_1};
        assign {below_1, less_1} = {1'b0, rest_2} - {4'd0, slope_2};

        always_ff @(posedge clk) begin
            if (out_ready) begin
                all_1[k]   <= in_group.best[k][32:23] != '0;
                bit_2      <= !below_4;
                rest_1     <= below_4 ? best : {less_4, best[1:0]};
                slope_1    <= in_group.slope[k];

                bit_1      <= !below_2;
                bit_2_late <= bit_2;
                rest_2     <= below_2 ? rest_1 : {less_2, rest_1[0]};
                slope_2    <= slope_1;

                count_3[k] <= {bit_2_late, bit_1, !below_1};
            end
        end

        wire _unused = &{1'b0, less_1};
    end

    always_ff @(posedge clk) begin
        if (out_ready) begin
            for (int i = 0; i < 8; i++) begin
                out_mask[i] <= 1'b1;
                for (int k = 0; k < 3; k++)
                    if (!all_3[k] && count_3[k] < 3'(rises_3[k] ? 7 - i : i)) out_mask[i] <= 1'b0;
            end
        end
    end

    assign out_valid = valid[4] && out_mask != '0;

    lane_values depths (.clk, .enable(out_ready), .in(in_group.depth), .step_x(in_group.depth_step_x), .values(early_depths));

    always_ff @(posedge clk) begin
        if (out_ready) begin
            for (int i = 0; i < 8; i++)
                out_codes[i] <= early_depths[i][31:14] == '0 ? 18'd1 : early_depths[i][31:14];
        end
    end

    // Position and colour of a group, delayed to match its mask and depths.
    typedef struct packed {
        logic [5:0]  line;
        logic [7:0]  column;
        logic [15:0] colour;
    } place_t;

    place_t      place_1, place_2, place_3;
    logic [8:0]  line_times_5;
    logic [10:0] first_row, row_3;

    always_ff @(posedge clk) begin
        if (out_ready) begin
            place_1 <= {in_group.line, in_group.group, in_group.colour};
            place_2 <= place_1;
            place_3 <= place_2;
            {out_line, out_column, out_colour} <= place_3;

            line_times_5 <= {1'b0, in_group.line, 2'd0} + 9'(in_group.line);
            if (stride[7])      first_row <= {line_times_5[5:0], 5'd0};
            else if (stride[6]) first_row <= {line_times_5[6:0], 4'd0};
            else                first_row <= {line_times_5[7:0], 3'd0};
            row_3   <= first_row + 11'(place_2.column);
            out_row <= row_3;
        end
    end

    wire _unused = &{1'b0, early_depths, stride[5:0], line_times_5[8]};
endmodule

`default_nettype wire

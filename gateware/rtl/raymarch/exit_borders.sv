// Finds the planes at which a ray leaves the empty prism around its point (docs/raymarch-exits.md, "Solids").
//
//   point ─▶ interval of each axis ─▶ largest of it and `reached` ─▶ rule ─▶ next interval above each plane, the plane's coordinate
//
// Coordinates are those of mirrored axes from the solid's lower corner, so that every ray leads up. `there[i]` is high if a plane
// perpendicular to axis i bounds the prism; `next[i]` is the interval above this plane, and `at[i]` its coordinate. The ray leaves
// by the last of the planes if `choice[1]` is high, by the first if `choice[0]` is high, and otherwise by the second of three. Without any plane the point is in the solid (`hit`), or the ray has left the solid for good (`gone`).
//
// A sponge is what three extruded carpets have in common: a point is outside if at some level two of its digits are 1. It is then in a
// prism between the planes of these two cells, which goes through the whole sponge.
//
// Latency 6 clocks from `point` to `next`, `there`, `choice`, `hit`, `gone` and `interval`, and 7 clocks to `at`; `reached` is an input of
// clock 2. Throughput one point per clock, no handshake. `solid` must hold.

`default_nettype none

module exit_borders #(
    // Levels of a sponge, 0 without sponges, and whether there are boxes, planes and cubes.
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1
) (
    input  wire                                        clk,
    input  wire exit_pkg::solid_t                      solid,
    input  wire  [2:0][exit_pkg::POINT_BITS-1:0]       point,
    input  wire  [2:0][exit_pkg::INTERVAL_BITS-1:0]  reached_2,
    output logic [2:0][exit_pkg::INTERVAL_BITS-1:0]  interval,
    output logic [2:0][exit_pkg::INTERVAL_BITS-1:0]  next,
    output logic [2:0]                                 there,
    output logic [1:0]                                 choice,
    output logic                                       hit,
    output logic                                       gone,
    output logic [2:0][exit_pkg::SIDE_BITS-1:0]        at
);
    logic is_sponge, is_cubes, is_planes;

    assign is_sponge = LEVELS != 0 && (!BOXES || solid.rule == exit_pkg::SPONGE);
    assign is_cubes  = BOXES && solid.rule == exit_pkg::CUBES;
    assign is_planes = BOXES && solid.rule == exit_pkg::PLANES;

    // Returns the ternary digits of the number of a cell, 0 to 80.
    function automatic logic [7:0] ternary(input logic [6:0] cell_number);
        ternary = {2'(cell_number / 7'd27), 2'(cell_number / 7'd9 % 7'd3), 2'(cell_number / 7'd3 % 7'd3), 2'(cell_number % 7'd3)};
    endfunction

    // The suffix of a name is the number of clocks after the point.
    logic [2:0][exit_pkg::INTERVAL_BITS-1:0] interval_3, interval_4;
    logic [2:0]       below_4, above_4;
    // For each level: bit i is set if the digit of axis i is 1; and whether two or three of these bits are set.
    logic [3:0][2:0]  middle_4;
    logic [3:0]       two_4, three_4;

    for (genvar i = 0; i < 3; i++) begin : axes
        logic                                below_1, over_1, far_1;
        logic [6:0]                          cell_1;
        logic [4:0]                          number_1;
        logic signed [exit_pkg::POINT_BITS-1:0] local_0;
        logic [exit_pkg::INTERVAL_BITS-1:0]  interval_2;

        // Cubes are repeated: only the coordinate within the cell is compared with the side.
        assign local_0 = is_cubes ? {10'd0, point[i][17:0]} : point[i];

        always_ff @(posedge clk) begin
            below_1  <= point[i][exit_pkg::POINT_BITS-1];
            over_1   <= local_0 >= $signed({4'd0, solid.side[i]});
            far_1    <= point[i][exit_pkg::POINT_BITS-2:23] != '0 && !point[i][exit_pkg::POINT_BITS-1];
            cell_1   <= point[i][18:12];
            number_1 <= point[i][22:18];

            interval_2[8] <= !below_1;
            if (is_cubes)                 interval_2[7:0] <= far_1 ? {2'd2, 6'd0} : {below_1, number_1, over_1, 1'b0};
            else if (below_1)             interval_2[7:0] <= '0;
            else if (over_1)              interval_2[7:0] <= exit_pkg::ABOVE;
            else                          interval_2[7:0] <= is_sponge ? ternary(cell_1) : '0;

            interval_3[i] <= interval_2 > reached_2[i] ? interval_2 : reached_2[i];

            interval_4[i] <= interval_3[i];
            below_4[i]    <= !interval_3[i][8];
            above_4[i]    <= exit_pkg::is_above(interval_3[i][8:6], is_cubes);
            for (int level = 0; level < 4; level++)
                middle_4[level][i] <= interval_3[i][6 - 2 * level +: 2] == 2'd1;
        end
    end

    always_ff @(posedge clk)
        for (int level = 0; level < 4; level++) begin
            logic [2:0] ones;
            for (int i = 0; i < 3; i++) ones[i] = interval_3[i][6 - 2 * level +: 2] == 2'd1;
            two_4[level]   <= 3'(level) < solid.levels && (ones[0] && ones[1] || ones[0] && ones[2] || ones[1] && ones[2]);
            three_4[level] <= ones == '1;
        end

    // The first level at which two digits are 1, as a bit and as those of the levels before it, and the axes whose digit is 1 there.
    logic [2:0][exit_pkg::INTERVAL_BITS-1:0] interval_5;
    logic [3:0] first_4, first_5, before_5;
    logic [2:0] middle_5, gap_4;
    logic       outside_4, in_hole_4;

    assign first_4   = two_4 & ~(two_4 - 4'd1);
    assign outside_4 = !is_cubes && !is_planes && below_4 != '0;
    assign in_hole_4 = is_sponge && two_4 != '0 && !outside_4;

    always_comb for (int i = 0; i < 3; i++) gap_4[i] = interval_4[i][1];

    logic [1:0] choice_5;
    logic [2:0] there_5;
    logic       outside_5, gone_5, hit_5;

    always_ff @(posedge clk) begin
        interval_5 <= interval_4;
        first_5    <= first_4;
        before_5   <= first_4 - 4'd1 & {4{in_hole_4}};
        for (int i = 0; i < 3; i++)
            middle_5[i] <= in_hole_4 && (first_4 & {middle_4[3][i], middle_4[2][i], middle_4[1][i], middle_4[0][i]}) != '0;
        outside_5  <= outside_4;
        choice_5   <= {is_cubes || outside_4, !is_cubes && !outside_4 && !(is_sponge && (three_4 & first_4) != '0)};
        there_5    <= is_cubes ? gap_4 : outside_4 ? below_4 : is_planes ? 3'b100 : 3'b111;
        gone_5     <= !is_planes && above_4 != '0;
        hit_5      <= is_planes ? below_4[2] || above_4[2] : above_4 == '0 && !outside_4 && !in_hole_4 && !(is_cubes && gap_4 != '0);
    end

    always_ff @(posedge clk) begin
        interval <= interval_5;
        choice   <= choice_5;
        there    <= there_5;
        gone     <= gone_5;
        hit      <= hit_5;
        for (int i = 0; i < 3; i++) begin
            next[i][8] <= 1'b1;
            // The next cell has the digits before the first middle digit, this digit plus one, and zeros.
            for (int level = 0; level < 4; level++) begin
                next[i][7 - 2 * level] <= middle_5[i] ? before_5[level] && interval_5[i][7 - 2 * level] || first_5[level]
                                                      : level == 0 && !outside_5;
                next[i][6 - 2 * level] <= middle_5[i] ? before_5[level] && interval_5[i][6 - 2 * level] : level == 0 && !outside_5;
            end
            if (is_cubes) next[i] <= {1'b1, interval_5[i][8] ? interval_5[i][7:2] + 6'd1 : 6'd0, 2'd0};
        end
    end

    // Returns the number of two ternary digits. A table: a sum would be a chain of carries.
    function automatic logic [3:0] pair(input logic [3:0] digits);
        case (digits)
            4'b0001: pair = 4'd1;
            4'b0010: pair = 4'd2;
            4'b0100: pair = 4'd3;
            4'b0101: pair = 4'd4;
            4'b0110: pair = 4'd5;
            4'b1000: pair = 4'd6;
            4'b1001: pair = 4'd7;
            4'b1010: pair = 4'd8;
            4'b1100: pair = 4'd9;
            default: pair = 4'd0;
        endcase
    endfunction

    // The coordinate of a plane. The first digit is 3 at the side of a sponge. Only the plane perpendicular to z bounds a slab.
    for (genvar i = 0; i < 3; i++) begin : planes
        logic [6:0] high, cell_number;

        assign high        = 7'(pair(next[i][7:4])) * 7'd9;
        assign cell_number = high + 7'(pair(next[i][3:0]));

        always_ff @(posedge clk)
            if (is_cubes)                 at[i] <= {next[i][7:2], 18'd0};
            else if (i == 2 && is_planes) at[i] <= solid.side[i];
            else                          at[i] <= is_sponge ? {5'd0, cell_number, 12'd0} : '0;
    end
endmodule

`default_nettype wire

// Finds the planes at which a ray leaves the empty prism around its point (docs/raymarch-exits.md, "Solids").
//
//   point ─▶ interval of each axis ─▶ larger of it and `reached` ─▶ rule ─▶ next interval above each plane, the plane's coordinate
//
// Axes are mirrored so that every coordinate of a ray increases along the ray. The origin of the point's coordinates is the solid's lower
// corner; the origin of the planes' coordinates is the solid's centre. `there[i]` is high if a plane perpendicular to axis i bounds the
// prism; `next[i]` is the interval above this plane, `above[i]` is high if this interval is above the solid, and `at[i]` is the plane's
// coordinate. The ray leaves by the last of the planes if `choice[1]` is high, by the first if `choice[0]` is high, and otherwise by the
// second of three. Without any plane the point is in the solid (`hit`), or the ray has left the solid and cannot enter it again (`gone`).
//
// A sponge is the intersection of three extruded Sierpinski carpets: a point is outside if at some level two of its ternary digits are
// 1. The point is then in a prism between the planes of these two cells, and the prism goes through the whole sponge. For cubes, the
// last digit of an interval is 1 in the gap between two cubes, so that the same rule gives the next interval.
//
// Each sphere of a lattice is inscribed in such a cube: `hit` is then high if the point is in the box around a sphere, and a ray that
// misses the sphere leaves this box by the first exit. `over` is high if a coordinate, within its cell, is above the cube.
//
// Latency 7 clocks from `point` to `next`, `there`, `choice`, `above`, `hit` and `gone`, 8 clocks to `at`, and 1 clock to `over`; `reached_3`
// is an input of clock 3. Throughput one point per clock, no handshake. `solid` must hold.

`default_nettype none

module exit_borders #(
    // Levels of a sponge, 0 without sponges, and whether there are boxes, planes and cubes.
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1,
    // Whether there are spheres of a lattice, with BOXES.
    parameter bit          LATTICE = 1'b0
) (
    input  wire                                      clk,
    input  wire exit_pkg::solid_t                    solid,
    input  wire  [2:0][exit_pkg::POINT_BITS-1:0]     point,
    input  wire  [2:0][exit_pkg::INTERVAL_BITS-1:0]  reached_3,
    output logic [2:0][exit_pkg::INTERVAL_BITS-1:0]  next,
    output logic [2:0]                               there,
    output logic [1:0]                               choice,
    output logic [2:0]                               above,
    output logic                                     hit,
    output logic                                     gone,
    output logic [2:0][exit_pkg::PLANE_BITS-1:0]     at,
    output logic [2:0]                               over
);
    // DIGITS: number of ternary digits of an interval that this build uses. LAST: index of the digit that is 1 in the gap between cubes.
    // BITS: width of an interval with these digits. CELL_BITS: width of the number of a cell.
    localparam bit          DEEP      = LEVELS > 4;
    localparam int unsigned DIGITS    = DEEP ? 6 : 4;
    localparam int unsigned LAST      = 3;
    localparam int unsigned BITS      = 1 + 2 * DIGITS;
    localparam int unsigned UNUSED    = exit_pkg::INTERVAL_BITS - BITS;
    localparam int unsigned CELL_BITS = DEEP ? 10 : 7;

    // Registered, because these signals have many loads.
    logic is_sponge, is_cubes, is_planes, is_deep, is_lattice;
    logic [DIGITS-1:0] levels;

    always_ff @(posedge clk) begin
        is_sponge <= LEVELS != 0 && (!BOXES || solid.rule == exit_pkg::SPONGE);
        is_cubes  <= BOXES && solid.rule == exit_pkg::CUBES;
        is_planes <= BOXES && solid.rule == exit_pkg::PLANES;
        is_deep   <= DEEP && solid.levels > 3'd4;
        is_lattice <= LATTICE && solid.rule == exit_pkg::CUBES && solid.levels[0];
        for (int level = 0; level < DIGITS; level++)
            levels[level] <= LEVELS != 0 && (!BOXES || solid.rule == exit_pkg::SPONGE) && 3'(level) < solid.levels;
    end

    // The first ternary digit of a cell is the quotient of its number and PLACE_VALUE; a table converts the remainder to the other digits.
    localparam int unsigned PLACE_VALUE = DEEP ? 243 : 27;
    localparam int unsigned REST_BITS   = DEEP ? 8 : 5;

    logic [2*DIGITS-3:0] ternary [0:2**REST_BITS-1];

    initial
        for (int i = 0; i < 2**REST_BITS; i++)
            ternary[i] = (2*DIGITS-2)'({2'(i / 81), 2'(i / 27 % 3), 2'(i / 9 % 3), 2'(i / 3 % 3), 2'(i % 3)});

    // The suffix of a name is the number of clocks after the point.
    logic [2:0][BITS-1:0]      interval_4, interval_5, interval_6;
    logic [2:0]                below_5, above_5;
    // For each level: bit i is set if the digit of axis i is 1; and whether two or three of these bits are set.
    logic [DIGITS-1:0][2:0]    middle_5;
    logic [DIGITS-1:0]         two_5, three_5;

    for (genvar i = 0; i < 3; i++) begin : axes
        logic                 below_1, below_2, over_1, over_2, far_1;
        logic [5:0]           cube_1, cube_2;
        logic [CELL_BITS-1:0] cell_1;
        logic [2*DIGITS-1:0]  digits_2;
        logic [BITS-1:0]      interval_3, reached;

        assign reached = reached_3[i][exit_pkg::INTERVAL_BITS-1:UNUSED];
        assign over[i] = over_1;

        always_ff @(posedge clk) begin
            // Cubes are repeated: only the coordinate within the cell is compared with the side. The side is even.
            below_1 <= point[i][exit_pkg::POINT_BITS-1];
            over_1  <= {is_cubes ? 4'd0 : point[i][21:18], point[i][17:1]} >= solid.half[i];
            far_1   <= point[i][26:22] != '0 && !is_cubes;
            cube_1  <= {point[i][exit_pkg::POINT_BITS-1:23] != '0, point[i][22:18]};

            below_2 <= below_1;
            over_2  <= over_1 || far_1;
            cube_2  <= cube_1;

            interval_3[BITS-1] <= !below_2;
            if (is_cubes)     interval_3[BITS-2:0] <= (2*DIGITS)'({cube_2, 1'b0, over_2}) << 2*DIGITS-8;
            else if (below_2) interval_3[BITS-2:0] <= '0;
            else if (over_2)  interval_3[BITS-2:0] <= exit_pkg::ABOVE[exit_pkg::DIGIT_BITS-1:UNUSED];
            else              interval_3[BITS-2:0] <= is_sponge ? digits_2 : '0;

            interval_4[i] <= interval_3 > reached ? interval_3 : reached;

            interval_5[i] <= interval_4[i];
            // An interval in a gap gets the number of the next cell, because the next box is in that cell.
            if (LATTICE && is_cubes)
                interval_5[i][BITS-2 -: 8] <= {interval_4[i][BITS-2 -: 6] + 6'(interval_4[i][BITS-8]), 1'b0, interval_4[i][BITS-9]};
            below_5[i]    <= !interval_4[i][BITS-1];
            above_5[i]    <= interval_4[i][BITS-1:BITS-2] == '1 && (is_cubes || interval_4[i][BITS-3]);
            for (int level = 0; level < DIGITS; level++)
                middle_5[level][i] <= interval_4[i][BITS-3-2*level +: 2] == 2'd1;
        end

        // The digits of the cell, six in a build for more than four levels. There the number of a cell of a sponge of up to four
        // levels, which is 2^12 units wide, is multiplied by nine: this appends two zero digits. Other cells are 2^9 units wide.
        logic [1:0]           first_1, first_2;
        logic [REST_BITS-1:0] rest_2;

        if (DEEP) begin : deep
            always_ff @(posedge clk)
                cell_1 <= {point[i][18:12], is_deep ? point[i][11:9] : 3'd0} + (is_deep ? 10'd0 : 10'(point[i][18:12]));
        end else begin : plain
            always_ff @(posedge clk) cell_1 <= point[i][18:12];
        end

        assign first_1  = {cell_1 >= CELL_BITS'(2 * PLACE_VALUE), cell_1 >= CELL_BITS'(PLACE_VALUE) && cell_1 < CELL_BITS'(2 * PLACE_VALUE)};
        assign digits_2 = {first_2, ternary[rest_2]};

        always_ff @(posedge clk) begin
            first_2 <= first_1;
            // Modulo 2^REST_BITS.
            rest_2 <= cell_1[REST_BITS-1:0]
                      - REST_BITS'(first_1[1] ? 2 * PLACE_VALUE : first_1[0] ? PLACE_VALUE : 0);
        end
    end

    always_ff @(posedge clk)
        for (int level = 0; level < DIGITS; level++) begin
            logic [2:0] ones;
            for (int i = 0; i < 3; i++) ones[i] = interval_4[i][BITS-3-2*level +: 2] == 2'd1;
            two_5[level]   <= ones[0] && ones[1] || ones[0] && ones[2] || ones[1] && ones[2];
            three_5[level] <= ones == '1;
        end

    // The first level at which two digits are 1, as a one-hot mask (`first`) and as the mask of the levels before it (`before`), and
    // the axes whose digit is 1 at this level (`middle`).
    logic [DIGITS-1:0] holes_5, first_5, first_6, before_6;
    logic [2:0] middle_6;
    logic       outside_5, in_hole_5, in_box_5, in_box_6, in_box_7;

    assign holes_5   = two_5 & levels;
    assign first_5   = holes_5 & ~(holes_5 - 1'b1);
    assign outside_5 = !is_cubes && !is_planes && below_5 != '0;
    assign in_hole_5 = holes_5 != '0 && !outside_5;
    assign in_box_5  = is_lattice && middle_5[LAST] == '0;

    logic [1:0] choice_6;
    logic [2:0] there_6;
    logic       gone_6, hit_6;

    always_ff @(posedge clk) begin
        interval_6 <= interval_5;
        in_box_6   <= in_box_5;
        first_6    <= is_cubes ? DIGITS'(1 << LAST) : first_5;
        before_6   <= is_cubes ? DIGITS'((1 << LAST) - 1) : first_5 - 1'b1;
        for (int i = 0; i < 3; i++) begin
            logic [DIGITS-1:0] middles;
            for (int level = 0; level < DIGITS; level++) middles[level] = middle_5[level][i];
            middle_6[i] <= is_cubes ? (middles[LAST] || in_box_5) && !below_5[i] : !outside_5 && (first_5 & middles) != '0;
        end
        choice_6 <= {is_cubes && !in_box_5 || outside_5, in_box_5 || !is_cubes && !outside_5 && (three_5 & first_5) == '0};
        there_6  <= is_cubes ? middle_5[LAST] | {3{in_box_5}} : outside_5 ? below_5 : is_planes ? 3'b100 : 3'b111;
        gone_6   <= !is_planes && above_5 != '0;
        hit_6    <= is_planes ? below_5[2] || above_5[2]
                              : above_5 == '0 && !outside_5 && !in_hole_5 && !(is_cubes && middle_5[LAST] != '0);
    end

    // The digits of the next interval are those before the first middle digit, then this digit plus one (1 when the ray leaves a box), then
    // zeros. Below the solid, the next interval is the lowest one; without a middle digit, the plane is the upper plane of the solid.
    logic [2:0] below_7;

    always_ff @(posedge clk) begin
        choice <= choice_6;
        there  <= there_6;
        gone   <= gone_6;
        hit    <= hit_6;
        next   <= '0;
        in_box_7 <= in_box_6;
        for (int i = 0; i < 3; i++) begin
            next[i][exit_pkg::INTERVAL_BITS-1] <= 1'b1;
            for (int level = 0; level < DIGITS; level++) begin
                next[i][exit_pkg::INTERVAL_BITS-2-2*level] <=
                    middle_6[i] ? before_6[level] && interval_6[i][BITS-2-2*level] || first_6[level] && !in_box_6
                                : level == 0 && interval_6[i][BITS-1];
                next[i][exit_pkg::INTERVAL_BITS-3-2*level] <=
                    middle_6[i] ? before_6[level] && interval_6[i][BITS-3-2*level] || first_6[level] && in_box_6
                                : level == 0 && interval_6[i][BITS-1];
            end
            above[i]   <= !is_planes && interval_6[i][BITS-1] && (is_cubes ? interval_6[i][BITS-3 -: 5] == '1 && !in_box_6 : !middle_6[i]);
            below_7[i] <= !interval_6[i][BITS-1];
        end
    end

    // Coordinates of planes, in units of 2^UNIT: a cell of a sponge has two units, or sixteen for a sponge of up to four levels in a build
    // for more levels. The first digit is 3 at the upper plane. Coordinates of sponges have fewer bits than coordinates of other solids.
    localparam int unsigned UNIT     = DEEP ? 8 : 11;
    localparam int unsigned SUM_BITS = 19 - UNIT;

    // Returns the coordinate of two ternary digits: their number times `unit`, minus `centre`. The table avoids the carry chains of a
    // product.
    function automatic logic [SUM_BITS-1:0] pair(input logic [3:0] digits, input logic [SUM_BITS-1:0] unit, input logic [SUM_BITS-1:0] centre);
        case (digits)
            4'b0001: pair = unit - centre;
            4'b0010: pair = unit * 2 - centre;
            4'b0100: pair = unit * 3 - centre;
            4'b0101: pair = unit * 4 - centre;
            4'b0110: pair = unit * 5 - centre;
            4'b1000: pair = unit * 6 - centre;
            4'b1001: pair = unit * 7 - centre;
            4'b1010: pair = unit * 8 - centre;
            4'b1100: pair = unit * 9 - centre;
            default: pair = -centre;
        endcase
    endfunction

    for (genvar i = 0; i < 3; i++) begin : planes
        logic [exit_pkg::DIGIT_BITS-1:0]       digits;
        logic [exit_pkg::PLANE_BITS-1:0]       border;
        logic [SUM_BITS-1:0]                   high, middle, low, sum;

        assign digits = next[i][exit_pkg::DIGIT_BITS-1:0];
        assign border = in_box_7 ? exit_pkg::PLANE_BITS'(solid.half[i]) : exit_pkg::PLANE_BITS'($signed(solid.border[i]));

        always_comb begin
            low = '0;
            if (DEEP && is_deep) begin
                high   = pair(digits[11:8], SUM_BITS'(162), SUM_BITS'(729));
                middle = pair(digits[7:4], SUM_BITS'(18), '0);
                low    = pair(digits[3:0], SUM_BITS'(2), '0);
            end else if (DEEP) begin
                high   = pair(digits[11:8], SUM_BITS'(144), SUM_BITS'(648));
                middle = pair(digits[7:4], SUM_BITS'(16), '0);
            end else begin
                high   = pair(digits[11:8], SUM_BITS'(18), SUM_BITS'(81));
                middle = pair(digits[7:4], SUM_BITS'(2), '0);
            end
            if (!is_sponge) begin
                high   = border[18:UNIT];
                middle = '0;
                low    = '0;
            end
            sum = high + middle + low;
        end

        // The coordinate of a plane of repeated cubes includes the number of the cell.
        logic [6:0] cube, other;

        assign cube  = {7{below_7[i]}} | {1'b0, digits[11:6]};
        assign other = is_sponge ? {7{sum[SUM_BITS-1]}} : border[24:18];

        always_ff @(posedge clk) at[i] <= {is_cubes ? cube : other, sum[SUM_BITS-2:0], border[UNIT-1:0]};
    end
endmodule

`default_nettype wire

// Wraps the positions of pixels: gives the columns and rows of the texels that they need.
//
//   quad ─▶ pairs ─▶ texels of the level ─▶ neighbours ─▶ wrapped ─▶ item
//
// With nearest filtering, a quad becomes one item; with bilinear filtering, one item for each pair of lanes that has covered pixels. No
// quad may arrive in the clock after a quad with two items. Latency 4 clocks, throughput one item per clock; the pipeline cannot be
// stopped.

`default_nettype none

module texture_wrap (
    input  wire                     clk,
    input  wire                     rst,
    input  wire  [1:0][3:0]         side_log2,    // by axis
    input  wire  [1:0][1:0]         wrap,         // by axis
    input  wire                     bilinear,
    input  wire                     in_valid,
    input  wire  [3:0]              in_mask,
    input  wire                     in_half,
    input  wire                     in_last,
    input  wire  [3:0]              in_level,
    input  wire  [1:0][3:0][17:0]   in_positions, // axis, lane: a texture_pkg::position_t
    output logic                    out_valid,
    output texture_pkg::item_t      out_item
);
    // Widths of a position: 10 bits for the column or row in the largest level, and 5 fraction bits, on which the weights depend. Three
    // more bits show whether the position is below 0, at or above 1, or in an odd repeat.
    localparam int unsigned KEPT  = 15;
    localparam int unsigned SHARE = 5;

    // The second item of a quad follows in the next clock.
    logic follows, both, upper_alone;

    assign both        = bilinear && in_mask[1:0] != '0 && in_mask[3:2] != '0;
    assign upper_alone = bilinear && in_mask[1:0] == '0;

    // The position in texels of the level, with 5 fraction bits, is the position in the repeat, shifted right by 10 minus the base-2
    // logarithm of the level's side, which is at most 10 bits.
    logic [1:0][3:0] cut;

    for (genvar axis = 0; axis < 2; axis++) begin : levels
        logic [3:0] missing;
        logic [4:0] sum;

        assign missing   = side_log2[axis] > 4'd10 ? 4'd0 : 4'd10 - side_log2[axis];
        assign sum       = {1'b0, missing} + {1'b0, in_level};
        assign cut[axis] = sum > 5'd10 ? 4'd10 : sum[3:0];
    end

    logic [3:0]                paired_valid;   // of each stage
    logic [2:0][3:0]           mask;
    logic [2:0]                half, last, second;
    logic [2:0][3:0]           level;
    logic [1:0]                upper_mask;
    logic                      quad_last;
    logic [1:0][3:0]           paired_cut;
    logic [1:0][3:0][KEPT-1:0] places;
    logic [1:0][3:0][2:0]      beyond;

    assign out_valid = paired_valid[3];

    always_ff @(posedge clk) begin
        paired_valid <= {paired_valid[2:0], in_valid || follows};
        follows      <= in_valid && both;
        if (rst) begin
            paired_valid <= '0;
            follows      <= 1'b0;
        end
    end

    always_ff @(posedge clk) begin
        for (int axis = 0; axis < 2; axis++) begin
            for (int i = 0; i < 4; i++) begin
                if (i < 2 && follows) begin
                    places[axis][i] <= places[axis][i + 2];
                    beyond[axis][i] <= beyond[axis][i + 2];
                end else if (i < 2 && upper_alone) {beyond[axis][i], places[axis][i]} <= in_positions[axis][i + 2];
                else {beyond[axis][i], places[axis][i]} <= in_positions[axis][i];
            end
        end
        mask[0]    <= follows ? {2'b00, upper_mask} : upper_alone ? {2'b00, in_mask[3:2]} : bilinear ? {2'b00, in_mask[1:0]} : in_mask;
        upper_mask <= in_mask[3:2];
        last[0]    <= follows ? quad_last : in_last && !both;
        quad_last  <= in_last;
        second[0]  <= follows || upper_alone;
        if (!follows) begin
            half[0]    <= in_half;
            level[0]   <= in_level;
            paired_cut <= cut;
        end
        mask[2:1]   <= mask[1:0];
        last[2:1]   <= last[1:0];
        second[2:1] <= second[1:0];
        half[2:1]   <= half[1:0];
        level[2:1]  <= level[1:0];
    end

    // Shifts right by up to 11 bits. The highest bits of the result are undefined; they are above the bits of the level.
    function automatic logic [KEPT-1:0] cut_off(input logic [KEPT-1:0] place, input logic [3:0] bits);
        logic [KEPT-1:0] coarse;
        logic [3:0]      of_bit;

        coarse = bits[3] ? {{2{place[KEPT-1 -: 4]}}, place[KEPT-1:8]} : bits[2] ? {place[KEPT-1 -: 4], place[KEPT-1:4]} : place;
        for (int i = 0; i < KEPT; i++) begin
            of_bit     = 4'(coarse >> i);
            cut_off[i] = of_bit[bits[1:0]];
        end
    endfunction

    // Lanes 2 and 3 are only used with nearest filtering, which needs no fraction bits.
    logic [1:0][3:0][9:0]       whole;
    logic [1:0][1:0][SHARE-1:0] shares;
    logic [1:0][1:0][SHARE-1:0] unused_share;
    logic [1:0][9:0]            extent;  // mask of the bits of a column or row of the level
    logic [1:0][3:0]            below, past, odd;

    always_ff @(posedge clk) begin
        for (int axis = 0; axis < 2; axis++) begin
            extent[axis] <= 10'h3FF >> paired_cut[axis];
            for (int i = 0; i < 2; i++) {whole[axis][i], shares[axis][i]} <= cut_off(places[axis][i], paired_cut[axis]);
            for (int i = 2; i < 4; i++)
                {whole[axis][i], unused_share[axis][i-2]} <= cut_off({places[axis][i][KEPT-1:SHARE], SHARE'(0)}, paired_cut[axis]);
            for (int i = 0; i < 4; i++) begin
                below[axis][i] <= beyond[axis][i][2];
                past[axis][i]  <= beyond[axis][i][1];
                odd[axis][i]   <= beyond[axis][i][0];
            end
        end
    end

    // With bilinear filtering, the neighbours are the texels half a texel to both sides of the position: u is the previous column if the
    // fraction is below 120/256; otherwise u+1 is the next column. `left` has zeros and `right` has ones above the bits of the level, so
    // that the carry out of the sum shows whether the neighbour is outside of the level.
    logic [1:0][3:0][9:0] sums;
    // Whether the slot becomes the lowest or the highest column or row of the level, because it is outside; `highest` has priority.
    // `flipped`: whether the slot is mirrored.
    logic [1:0][3:0]      lowest, highest, flipped;
    logic [1:0][9:0]      extent_sum;
    logic [1:0][1:0][3:0] weights;
    logic [1:0][1:0]      upper;

    for (genvar axis = 0; axis < 2; axis++) begin : neighbours
        for (genvar j = 0; j < 2; j++) begin : pixels
            localparam int unsigned LANE = 2 * j;
            logic        less, more, limited, is_left;
            logic [9:0]  left, right;
            logic [10:0] before_sum, past_sum;
            logic [SHARE-1:0] share;

            assign share      = shares[axis][j];
            assign is_left    = !share[4] && share[3:0] != 4'hF;
            assign less       = bilinear && is_left;
            assign more       = bilinear && !is_left;
            assign limited    = wrap[axis] != 2'd0;
            assign left       = (bilinear ? whole[axis][j] : whole[axis][LANE]) & extent[axis];
            assign right      = (bilinear ? whole[axis][j] : whole[axis][LANE + 1]) | ~extent[axis];
            assign before_sum = {1'b0, {10{less}}} + {1'b0, left};
            assign past_sum   = {1'b0, right} + {10'd0, more};

            // The flags of the pixel of each of the two slots.
            logic [1:0] is_below, is_past, is_odd;

            for (genvar k = 0; k < 2; k++) begin : slots
                assign is_below[k] = wrap[axis] == 2'd2 && (bilinear ? below[axis][j] : below[axis][LANE + k]);
                assign is_past[k]  = wrap[axis] == 2'd2 && (bilinear ? past[axis][j] : past[axis][LANE + k]);
                assign is_odd[k]   = wrap[axis] == 2'd1 && (bilinear ? odd[axis][j] : odd[axis][LANE + k]);
            end

            always_ff @(posedge clk) begin
                sums[axis][LANE]        <= before_sum[9:0];
                sums[axis][LANE + 1]    <= past_sum[9:0];
                lowest[axis][LANE]      <= is_below[0] || limited && less && !before_sum[10];
                lowest[axis][LANE + 1]  <= is_below[1];
                highest[axis][LANE]     <= is_past[0];
                highest[axis][LANE + 1] <= !is_below[1] && (is_past[1] || limited && past_sum[10]);
                flipped[axis][LANE]     <= is_odd[0];
                flipped[axis][LANE + 1] <= is_odd[1];
                // The fraction of the position half a texel to the left, rounded to sixteenths.
                weights[j][axis]        <= share[4:1] + 4'(share[0]) + 4'd8;
                upper[j][axis]          <= less;
            end

        end
    end

    wire _unused = &{1'b0, unused_share};

    always_ff @(posedge clk) begin
        extent_sum <= extent;

        for (int axis = 0; axis < 2; axis++)
            for (int i = 0; i < 4; i++)
                out_item.texels[axis][i] <= ((sums[axis][i] & ~{10{lowest[axis][i]}} | {10{highest[axis][i]}}) ^ {10{flipped[axis][i]}})
                                            & extent_sum[axis];
        out_item.weights <= weights;
        out_item.upper   <= upper;
        out_item.mask    <= mask[2];
        out_item.half    <= half[2];
        out_item.last    <= last[2];
        out_item.second  <= second[2];
        out_item.level   <= level[2];
    end
endmodule

`default_nettype wire

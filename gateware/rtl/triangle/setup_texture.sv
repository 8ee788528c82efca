// Stage 1 of the triangle setup for textures: computes the base, the range and the shares of the coordinates s or t of a triangle's vertices
// (docs/formats/texture.md, "On a triangle", steps 1 to 3).
//
// The coordinates of one axis enter in each round of the setup, which takes 11 clocks or more; `share`, `range` and `periods` belong to
// the axis of the previous round. The module `setup` drives `count`, the number of the clock in a round, and `next`, which is high one
// clock before its last clock. The coordinates must hold during a round.
//
//   count    0, 1, 2          1, 2, 3              4      5        6        last
//            vertex by vertex ─▶ smallest, largest ─▶ most ─▶ length ─▶ range ─▶ kept for the next round ─▶ r of a vertex ─▶ share
//            3, 4, 5          4, 5, 6    5, 6, 7
//            vertex by vertex ─▶ r ─────▶ fitting ────────────────────▶
//
// One comparator each for the smallest and the largest coordinate, and one subtractor for r, serve the three vertices in turn.

`default_nettype none

module setup_texture (
    input  wire             clk,
    input  wire  [3:0]      count,
    input  wire             next,
    input  wire  [2:0][31:0] coordinates, // s16.16
    // Number of the vertex whose share is at the output one clock later.
    input  wire  [1:0]      vertex,
    output logic [16:0]     share,
    output logic [3:0]      range,
    output logic [3:0]      periods
);
    logic [31:0]      place, smallest, largest, most, distance;
    logic [2:0][31:0] fitting, kept;
    logic [14:0]      period;
    logic [1:0]       number;

    assign period = smallest[31:17];

    always_comb
        unique case (count)
            4'd0, 4'd3: number = 2'd0;
            4'd1, 4'd4: number = 2'd1;
            default:    number = 2'd2;
        endcase

    // The range is 0 for a largest distance below 1, and increases by 1 for each further bit, and by another 1 if the
    // highest six bits are ones.
    logic [4:0]  length, length_6;
    logic [5:0]  head, head_6;
    logic        ones;
    logic [3:0]  range_7;

    always_comb begin
        length = '0;
        for (int i = 1; i <= 16; i++) if (most[15 + i]) length = 5'(i);
        head = 6'(most >> (5'd10 + 5'(length)));
        ones = head_6 == '1;
    end

    // The base in units of two repeats of the texture. Clamping needs it saturated to four bits, because from 1 on the whole
    // triangle is beyond the texture.
    logic [3:0] limited;

    always_comb begin
        if (period[14])              limited = period[13:3] == '1 ? period[3:0] : 4'd8;
        else if (period[13:1] != '0) limited = 4'd1;
        else                         limited = {3'd0, period[0]};
    end

    always_ff @(posedge clk) begin
        place <= coordinates[number];
        // The comparisons continue after the last vertex; vertices that appear again change nothing.
        if (count == 4'd1 || $signed(place) < $signed(smallest)) smallest <= place;
        if (count == 4'd1 || $signed(place) > $signed(largest)) largest <= place;
        most     <= {largest[31:17] - period, largest[16:0]};
        distance <= {place[31:17] - period, place[16:0]};
        // Distances saturate just below 63/64·2^15, the largest distance with range 15.
        if (count == 4'd5 || count == 4'd6 || count == 4'd7)
            fitting <= {distance[31] || distance[30:25] == '1 ? {7'b0111110, 25'h1FFFFFF} : distance, fitting[2:1]};
        length_6 <= length;
        head_6   <= head;
        range_7  <= length_6 == 5'd16 || length_6 == 5'd15 ? 4'd15 : 4'(length_6) + 4'(ones);
    end

    wide_register #(.WIDTH(3 * 32 + 8)) round (
        .clk, .next, .in({fitting, range_7, limited}), .out({kept, range, periods})
    );

    logic [31:0] of_vertex;
    logic [17:0] twice;

    always_comb begin
        unique case (vertex)
            2'd0:    of_vertex = kept[0];
            2'd1:    of_vertex = kept[1];
            default: of_vertex = kept[2];
        endcase
        twice = 18'(({2'd0, of_vertex} << 2) >> range) + 18'd1;
    end

    always_ff @(posedge clk) share <= twice[17:1];

    wire _unused = &{1'b0, twice[0], smallest[16:0]};
endmodule

`default_nettype wire

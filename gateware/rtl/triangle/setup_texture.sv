// Stage 1 of the triangle setup for textures: computes the base, the range and the shares of the coordinates s or t of a triangle's vertices
// (docs/formats/texture.md, "On a triangle", steps 1 to 3).
//
// The coordinates of one axis enter in each round of the setup, which takes 11 clocks or more; `share`, `range` and `periods` belong to
// the axis of the previous round. The module `setup` drives `count`, the number of the clock in a round, and `next`, which is high one
// clock before its last clock. The coordinates must hold during a round.
//
//   count    0           1, 2       3        4, 5      6, 7     last
//            selected ─▶ smallest ─▶ r ─▶ largest ─▶ range ─▶ kept for the next round ─▶ r of a vertex ─▶ share

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
    logic [2:0][31:0] places, distances, fitting, kept;
    logic [31:0]      low, smallest, high, most;
    logic [14:0]      period;

    assign period = smallest[31:17];

    // The range is 0 for a largest distance below 1, and increases by 1 for each further bit, and by another 1 if the
    // highest six bits are ones.
    logic [4:0]  length, length_7;
    logic [5:0]  head, head_7;
    logic        ones;
    logic [3:0]  range_8;

    always_comb begin
        length = '0;
        for (int i = 1; i <= 16; i++) if (most[15 + i]) length = 5'(i);
        head = 6'(most >> (5'd10 + 5'(length)));
        ones = head_7 == '1;
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
        if (count == 4'd0) places <= coordinates;
        low      <= $signed(places[1]) < $signed(places[0]) ? places[1] : places[0];
        smallest <= $signed(places[2]) < $signed(low) ? places[2] : low;
        for (int i = 0; i < 3; i++) distances[i] <= {places[i][31:17] - period, places[i][16:0]};
        high     <= distances[1] > distances[0] ? distances[1] : distances[0];
        most     <= distances[2] > high ? distances[2] : high;
        // Distances saturate just below 63/64·2^15, the largest distance with range 15.
        for (int i = 0; i < 3; i++)
            fitting[i] <= distances[i][31] || distances[i][30:25] == '1 ? {7'b0111110, 25'h1FFFFFF} : distances[i];
        length_7 <= length;
        head_7   <= head;
        range_8  <= length_7 == 5'd16 || length_7 == 5'd15 ? 4'd15 : 4'(length_7) + 4'(ones);
    end

    wide_register #(.WIDTH(3 * 32 + 8)) round (
        .clk, .next, .in({fitting, range_8, limited}), .out({kept, range, periods})
    );

    logic [31:0] distance;
    logic [17:0] twice;

    always_comb begin
        unique case (vertex)
            2'd0:    distance = kept[0];
            2'd1:    distance = kept[1];
            default: distance = kept[2];
        endcase
        twice = 18'(({2'd0, distance} << 2) >> range) + 18'd1;
    end

    always_ff @(posedge clk) share <= twice[17:1];

    wire _unused = &{1'b0, twice[0], smallest[16:0]};
endmodule

`default_nettype wire

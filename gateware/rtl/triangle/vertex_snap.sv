// Steps 7 and 8 of the vertex stage (docs/formats/triangle.md): computes the position x, y on the screen, the flag of a vertex beyond
// the guard band, and w, the depth code before its rounding.
//
// Clock numbers count from the vertex's entry into `vertex_stage`; products follow three clocks after their factors.
//
//   25, 26, 27   X', Y' and km times the low 17 bits of y
//   28, 29, 30   the same factors times the high 7 bits, plus the high part of the first product
//   31, 32       x and y; the addend of the first product includes half a unit and the centre
//   33…36        km·y is shifted to w, rounded and saturated
//   37           `vertex` is valid
//
// In orthographic projection the factor of X' and Y' is 2^23 instead of y.

`default_nettype none

module vertex_snap #(
    // Whether the centre may be up to 1280 pixels from the beginning of the window, instead of 640.
    parameter bit AVERAGE = 1'b0
) (
    input  wire               clk,
    input  wire               half,
    input  wire  [1:0]        element,
    // Frame.
    input  wire               orthographic,
    input  wire  [10:0]        centre_x,
    input  wire  [10:0]        centre_y,
    input  wire  [16:0]       depth_mantissa,
    input  wire  signed [3:0] depth_exponent,
    // Values of a vertex: leading zeros of Z in clock 7, `behind` in clock 8; X', Y' and the reciprocal of Z's mantissa from
    // clock 25 on.
    input  wire  [3:0]        zeros,
    input  wire               behind,
    input  wire signed [24:0] x,
    input  wire signed [24:0] y,
    input  wire  [23:0]       inverse,
    output triangle_pkg::projected_t vertex
);
    // w is km·y / 2^(16 + depth_shift), where km is `depth_mantissa`. w saturates if depth_shift is negative. `lead` of
    // docs/formats/triangle.md is 40 − zeros. The registers `depth_shifts` and `behinds` shift every 6 clocks, so that their five entries
    // follow the vertices through the stage, from clock 8 and from clock 9 of a vertex on.
    logic [4:0][4:0]   depth_shifts;
    logic [4:0]        behinds;
    logic signed [4:0] depth_shift;

    assign depth_shift = 5'sd5 - 5'(zeros) - 5'(depth_exponent);

    always_ff @(posedge clk) begin
        if (!half && element == 2'd0) depth_shifts <= {depth_shifts[3:0], depth_shift};
        if (!half && element == 2'd1) behinds <= {behinds[3:0], behind};
    end

    localparam int unsigned BITS = AVERAGE ? 47 : 46;

    logic signed [24:0]      a;
    logic signed [17:0]      b;
    logic signed [BITS-1:0]  c, p;
    logic signed [BITS-18:0] left;
    logic        [1:0]  low;

    always_comb begin
        case (element)
            2'd0:    a = x;
            2'd1:    a = y;
            default: a = {8'b0, depth_mantissa};
        endcase
        b = half ? {11'b0, inverse[23:17]} : {1'b0, inverse[16:0]};
        if (orthographic && element != 2'd2) b = {11'b0, half, 6'b0};
    end

    multiply_add #(.BITS(BITS)) multiply (.clk(clk), .enable(1'b1), .a(a), .b(b), .c(c), .p(p));

    always_ff @(posedge clk) begin
        left <= p[BITS-1:17];
        case ({half, element})
            3'b001:  c <= BITS'({1'b0, centre_x, 8'b0, 1'b1, 26'b0});
            3'b010:  c <= BITS'({1'b0, centre_y, 8'b0, 1'b1, 26'b0});
            3'b100:  c <= '0;
            default: c <= BITS'(left);
        endcase
        if (half && element == 2'd2) low <= p[16:15];
    end

    // A screen coordinate has 8 fraction bits and is saturated to s12.8; the guard band ends at ±2047 pixels.
    logic signed [22:0] place;
    logic signed [19:0] saturated, place_x, place_y;
    logic               beyond, beyond_x, beyond_y;

    assign place = p[32:10];

    always_comb begin
        saturated = place[19:0];
        beyond    = place[22] ? place[18:8] == '0 : place[18:8] == '1 && place[7:0] != '0;
        if (place[22:19] != {4{place[22]}}) begin
            saturated = {place[22], {19{!place[22]}}};
            beyond    = 1'b1;
        end
    end

    always_ff @(posedge clk) begin
        if (!half && element == 2'd0) begin
            place_x  <= behinds[3] ? '0 : saturated;
            beyond_x <= !behinds[3] && beyond;
        end
        if (!half && element == 2'd1) begin
            place_y  <= behinds[3] ? '0 : saturated;
            beyond_y <= !behinds[3] && beyond;
        end
    end

    // The lowest bit of the shifted product is half a unit of w.
    logic [25:0] product, by_fours, shifted, rounded;
    logic [4:0]  shift;
    logic [23:0] depth;

    assign product = {p[23:0], low};
    assign shift   = depth_shifts[4];

    always_ff @(posedge clk) begin
        case (shift[3:2])
            2'd0:    by_fours <= product;
            2'd1:    by_fours <= product >> 4;
            default: by_fours <= product >> 8;
        endcase
        case (shift[1:0])
            2'd0: shifted <= by_fours;
            2'd1: shifted <= by_fours >> 1;
            2'd2: shifted <= by_fours >> 2;
            2'd3: shifted <= by_fours >> 3;
        endcase
        rounded <= {1'b0, shifted[25:1]} + 26'(shifted[0]);
        depth   <= rounded[23:0];
        if (shift[4] || rounded[25:24] != '0 || rounded[23:6] == '1) depth <= {18'h3FFFF, 6'b0};
        if (behinds[4]) depth <= '0;
    end

    assign vertex.behind  = behinds[4];
    assign vertex.beyond  = beyond_x || beyond_y;
    assign vertex.place.x = 21'(place_x);
    assign vertex.place.y = 21'(place_y);
    assign vertex.place.w = depth;
endmodule

`default_nettype wire

// Computes the distance to the union of a flat solid and a sphere with a fillet (docs/formats/raymarch.md, "Smooth unions").
//
//   a, b ─▶ a − b ─▶ h = max(0, k − |a − b|) ─▶ w = h/2k ─▶ min(a, b) − h·w/2
//
// a is the distance to the flat solid, b the distance to the sphere, k the parameter `solid.blend_width`, and w the weight of the
// farther surface. Latency 8 clocks, throughput one point per clock, no handshake; `solid` must hold. The output `nearest` is the input
// `known`, delayed by the latency of the distance.

`default_nettype none

module blend_unit (
    input  wire                         clk,
    input  wire raymarch_registers_pkg::solid_t solid,
    input  wire signed [21:0]           flat_distance,
    input  wire [2:0]                   flat_surface,
    input  wire raymarch_pkg::nearest_t    known,
    output logic signed [21:0]          distance,
    output logic [2:0]                  surface,
    output logic [2:0]                  face,
    output logic [7:0]                  share,
    output raymarch_pkg::nearest_t         nearest
);
    // The suffix of a name is the signal's clock: 1 for the difference of the distances, 2 for h, 5 for the weight of the farther surface,
    // 8 for the blended distance.
    logic signed [22:0] apart_1;
    logic [21:0]        away_1;
    logic [17:0]        left_1;
    logic signed [21:0] least_1, least_5;
    logic [16:0]        h_2, h_5;
    logic signed [34:0] product_5;
    logic [16:0]        weight_5;
    logic signed [24:0] minus_h_5;
    logic               takes_round, round_5;
    logic [16:0]        share_5;
    logic [7:0]         share_6;
    logic signed [39:0] sum_8;

    assign takes_round = $signed(known.distance) < flat_distance;
    // `away_1` is |a - b|, or |a - b| - 1 if a - b is negative. `left_1` is k - |a - b| for either sign.
    assign away_1 = apart_1[21:0] ^ {22{apart_1[22]}};
    assign left_1 = {1'b0, solid.blend_width} + {1'b1, ~away_1[16:0]} + 18'(!apart_1[22]);

    always_ff @(posedge clk) begin
        apart_1 <= flat_distance - $signed(known.distance);
        least_1 <= takes_round ? known.distance : flat_distance;
        h_2     <= left_1[17] || away_1[21:17] != '0 ? '0 : left_1[16:0];
    end

    multiply_add #(.BITS(35)) weigh (
        .clk, .enable(1'b1), .a({8'b0, h_2}), .b({1'b0, solid.blend_inverse}), .c('0), .p(product_5)
    );
    assign weight_5 = product_5[28:12];

    delay #(.WIDTH(17), .CLOCKS(3)) h_waits (.clk, .enable(1'b1), .in(h_2), .out(h_5));
    delay #(.WIDTH(22), .CLOCKS(6)) least_waits (.clk, .enable(1'b1), .in(least_1), .out(least_5));
    delay #(.WIDTH(1), .CLOCKS(5)) which (.clk, .enable(1'b1), .in(takes_round), .out(round_5));

    // The product is subtracted as (−h)·w, so that the shift rounds the blended distance down.
    assign minus_h_5 = -$signed({8'b0, h_5});
    multiply_add #(.BITS(40)) subtract (
        .clk, .enable(1'b1), .a(minus_h_5), .b({1'b0, weight_5}), .c({least_5[21], least_5, 17'b0}), .p(sum_8)
    );
    assign distance = sum_8[38:17];

    // Weight of the sphere's colour in the pixel's colour, in units of 2^-16. The colour of the nearer surface has a weight of at least one
    // half.
    assign share_5 = round_5 ? 17'h1_0000 - weight_5 : weight_5;
    always_ff @(posedge clk) share_6 <= share_5[15:8] | {8{share_5[16]}};
    delay #(.WIDTH(8), .CLOCKS(2)) share_waits (.clk, .enable(1'b1), .in(share_6), .out(share));

    delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(8)) known_waits (.clk, .enable(1'b1), .in(known), .out(nearest));
    delay #(.WIDTH(3), .CLOCKS(8)) flat_waits (.clk, .enable(1'b1), .in(flat_surface), .out(face));
    assign surface = nearest.number;

    wire _unused = &{1'b0, solid, product_5[34:29], product_5[11:0], share_5[7:0], sum_8[39], sum_8[16:0]};
endmodule

`default_nettype wire

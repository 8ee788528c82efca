// Multiplies a channel of two texels by its light, to nearest (docs/formats/texture.md, "On a triangle").
//
//   clock   0          1                     4
//   light ─▶ share ──┐
//           texels ──┴▶ one DSP48: both ────▶ colours
//
// The light is u0.8, and full light is 248, or 252 in a channel of 6 bits. It stands for a share of 256, light + nearest(light·2^-CHANNEL),
// which is 256 for full light. One factor has both texels side by side, and their products with the share have 16 bits each, with the half
// of the unit of the rounding. Above full light, the product of the first texel may carry into the second one, and the colours have no
// meaning.
//
// A texel has 8 bits, of which CHANNEL are its integer part. Its largest value is 2^8 − 2^(8 − CHANNEL). Latency 4 clocks from `light`, 3
// clocks from `texels`; throughput two texels per clock; the pipeline cannot be stopped.

`default_nettype none

module texture_light #(
    // Bits of the channel, 5 or 6.
    parameter int unsigned CHANNEL = 5
) (
    input  wire                      clk,
    input  wire  [7:0]               light,
    input  wire  [1:0][7:0]          texels,  // one clock after the light
    output logic [1:0][CHANNEL-1:0]  colours
);
    // The correction by the six highest bits of the light, which suffice.
    function automatic logic [255:0] corrections();
        for (int i = 0; i < 64; i++) corrections[4*i +: 4] = 4'((4 * i + (1 << (8 - CHANNEL))) >> CHANNEL);
    endfunction

    localparam logic [255:0] CORRECTIONS = corrections();
    localparam logic [15:0]  HALF        = 16'(1 << (15 - CHANNEL));

    logic [8:0]         share;
    logic signed [31:0] products;

    always_ff @(posedge clk) share <= 9'(light) + 9'(CORRECTIONS[{light[7:2], 2'd0} +: 4]);

    multiply_add #(.BITS(32)) dsp (
        .clk, .enable(1'b1), .a({1'b0, texels[1], 8'd0, texels[0]}), .b({9'd0, share}), .c({2{HALF}}), .p(products)
    );

    assign colours = {products[31 -: CHANNEL], products[15 -: CHANNEL]};

    wire _unused = &{1'b0, products};
endmodule

`default_nettype wire

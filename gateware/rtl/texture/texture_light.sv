// Multiplies a channel of two texels by its light (docs/formats/texture.md, "On a triangle").
//
//   clock   0          1                     4
//   light ─▶ share ──┐
//           texels ──┴▶ one DSP48: both ────▶ colours
//
// The light is u0.8; full light is 248, or 252 in a channel of 6 bits. The share, in 256ths, is light + nearest(light/(2^CHANNEL − 1)): 256
// for full light. One factor has both texels side by side. Their products with the share have 16 bits each; to each product a threshold for
// the rounding to CHANNEL bits is added, see colour_pkg::threshold. With FRACTIONS the colour keeps 8 bits. With more than full light, the
// product of the first texel may carry into that of the second texel, and the colours are undefined.
//
// A texel has 8 bits, of which CHANNEL are its integer part. Its largest value is 2^8 − 2^(8 − CHANNEL). Latency 4 clocks from `light`, 3
// clocks from `texels`; throughput two texels per clock; the pipeline cannot be stopped.

`default_nettype none

module texture_light #(
    // Bits of the channel, 5 or 6.
    parameter int unsigned CHANNEL   = 5,
    parameter bit          FRACTIONS = 1'b0,
    localparam int unsigned BITS     = FRACTIONS ? 8 : CHANNEL
) (
    input  wire                      clk,
    input  wire                      dither,  // constant while texels are inside
    input  wire  [7:0]               light,
    input  wire  [1:0][7:0]          texels,  // one clock after the light
    input  wire  [1:0][2:0]          thresholds, // two clocks after the texels
    output logic [1:0][BITS-1:0]     colours
);
    localparam int unsigned MOST = (1 << CHANNEL) - 1;

    // Table of nearest(light/(2^CHANNEL − 1)), without the two lowest bits of the light.
    function automatic logic [255:0] corrections();
        for (int i = 0; i < 64; i++) corrections[4*i +: 4] = 4'((8 * i + MOST) / (2 * MOST));
    endfunction

    localparam logic [255:0] CORRECTIONS = corrections();

    logic [8:0]         share;
    logic signed [31:0] products;
    logic [1:0][15:0]   limits;

    // With `dither`, half a unit of the thresholds is added too, so that the mean over all pixels of a pattern is the product, rounded to
    // nearest.
    always_comb
        for (int i = 0; i < 2; i++)
            limits[i] = {5'd0, FRACTIONS ? {3'd0, dither} : CHANNEL == 6 ? {1'b0, thresholds[i][2:1], dither} : {thresholds[i], dither},
                         7'd0};

    always_ff @(posedge clk) share <= 9'(light) + 9'(CORRECTIONS[{light[7:2], 2'd0} +: 4]);

    multiply_add #(.BITS(32)) dsp (
        .clk, .enable(1'b1), .a({1'b0, texels[1], 8'd0, texels[0]}), .b({9'd0, share}), .c(limits), .p(products)
    );

    assign colours = {products[31 -: BITS], products[15 -: BITS]};

    wire _unused = &{1'b0, products, thresholds};
endmodule

`default_nettype wire

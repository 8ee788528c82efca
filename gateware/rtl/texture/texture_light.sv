// Multiplies a channel of a texel by its light, to nearest (docs/formats/texture.md, "On a triangle").
//
// The light is u0.8, and full light is 248, or 252 in a channel of 6 bits. The product is texel·share with the share of 256 that belongs to
// a light, light + nearest(light·2^-CHANNEL), 256 for full light. The multiplier adds the texel once more, so its factor is the share minus
// 1 and has 8 bits. The smallest shares differ by 1 from this, where every product is rounded to 0.
//
//   clock  0              1                 2           3
//   light ─▶ share − 1 ──▶ digits 0 and 1 ─▶ 2 and 3 ──▶ colour
//   texel ─▶ 3·texel ────▶ first sum ──────▶ last sum ─▶
//
// The factor is used in four digits of two bits, the lowest first. Their multiples of the texel are its copy, its double and the triple, so
// each digit takes one LUT a bit. Half of the unit of the rounding is in the first sum, in bits that are free there or change by inversion.
//
// A texel has BITS bits, of which CHANNEL are its integer part. Its largest value is 2^BITS − 2^(BITS − CHANNEL). Light above full light
// gives a colour that may be too dark. Latency 3 clocks, throughput one channel per clock; the pipeline cannot be stopped.

`default_nettype none

module texture_light #(
    parameter int unsigned BITS    = 8,
    // 5 or 6.
    parameter int unsigned CHANNEL = 5
) (
    input  wire                clk,
    input  wire  [BITS-1:0]    texel,
    input  wire  [7:0]         light,
    output logic [CHANNEL-1:0] colour
);
    // nearest(light·2^-CHANNEL) − 1 by the six highest bits of the light, which suffice.
    function automatic logic [255:0] corrections();
        for (int i = 0; i < 64; i++) corrections[4*i +: 4] = 4'(((4 * i + (1 << (8 - CHANNEL))) >> CHANNEL) - 1);
    endfunction

    localparam logic [255:0] CORRECTIONS = corrections();

    logic [3:0]      correction;
    logic            is_dark;
    logic [7:0]      factor;
    logic [BITS-1:0] texel_1, texel_2;
    logic [BITS+1:0] triple, triple_2;
    logic [3:0]      digits_2;

    // The factor of light 0 must not be −1.
    assign correction = CORRECTIONS[{light[7:2], 2'd0} +: 4];
    assign is_dark    = CHANNEL == 5 ? light[7:2] == '0 : light[7:1] == '0;

    logic unused_carry;

    always_ff @(posedge clk) begin
        {factor, unused_carry} <= {light, 1'b1} + {{4{correction[3]}}, correction, is_dark};
        triple  <= (BITS + 2)'(texel) + {1'b0, texel, 1'b0};
        texel_1 <= texel;
    end

    function automatic logic [BITS+1:0] multiple(input logic [1:0] digit, input logic [BITS-1:0] one, input logic [BITS+1:0] three);
        unique case (digit)
            2'd0: multiple = '0;
            2'd1: multiple = {2'd0, one};
            2'd2: multiple = {1'b0, one, 1'b0};
            2'd3: multiple = three;
        endcase
    endfunction

    // The lowest digit plus 1 is 1 to 4.
    logic [BITS+1:0] lowest, row_3;
    logic [BITS+2:0] row_0, row_1, row_2;
    logic [BITS:0]   sum;

    always_comb begin
        unique case (factor[1:0])
            2'd0: lowest = {2'd0, texel_1};
            2'd1: lowest = {1'b0, texel_1, 1'b0};
            2'd2: lowest = triple;
            2'd3: lowest = {texel_1, 2'd0};
        endcase
        // Plus 2^(BITS + 7 − CHANNEL).
        row_0 = CHANNEL == 5 ? {1'b1, lowest} : {lowest[BITS+1], !lowest[BITS+1], lowest[BITS:0]};
        row_1 = {2'd0, row_0[BITS+2:2]} + {1'b0, multiple(factor[3:2], texel_1, triple)};
        row_2 = {2'd0, sum} + {1'b0, multiple(digits_2[1:0], texel_2, triple_2)};
        row_3 = {1'b0, row_2[BITS+2:2]} + multiple(digits_2[3:2], texel_2, triple_2);
    end

    always_ff @(posedge clk) begin
        sum      <= row_1[BITS+2:2];
        texel_2  <= texel_1;
        triple_2 <= triple;
        digits_2 <= factor[7:4];
        colour   <= row_3[BITS+1 -: CHANNEL];
    end

    wire _unused = &{1'b0, unused_carry, row_0[1:0], row_1[1:0], row_2[1:0], row_3[BITS+1-CHANNEL:0]};
endmodule

`default_nettype wire

// Multiplies a channel of a texel by its share of 256, to nearest (docs/formats/texture.md, "On a triangle").
//
//   clock  0             1                  2                 3
//   texel ─▶ 3·texel ──▶ digits 0 and 1 ──▶ digits 2 and 3 ──▶ colour
//                share ─▶
//
// The input `share` is the number minus 1 (texture_share), and the texel is added once more. It is used in four digits of two bits, the
// lowest first. The multiples of a digit are 0, the texel, its double and its triple, so a digit takes one LUT for each bit of a sum. Half
// of the unit of the rounding is in the first multiple, in bits that are free there or change by inversion.
//
// A texel has BITS bits, of which CHANNEL are its integer part. Its largest value is 2^BITS − 2^(BITS − CHANNEL). Latency 3 clocks from
// `texel`, 2 clocks from `share`; throughput one texel per clock; the pipeline cannot be stopped.

`default_nettype none

module texture_light #(
    parameter int unsigned BITS    = 8,
    // 5 or 6.
    parameter int unsigned CHANNEL = 5
) (
    input  wire                clk,
    input  wire  [BITS-1:0]    texel,
    input  wire  [7:0]         share,  // one clock after the texel
    output logic [CHANNEL-1:0] colour
);
    logic [BITS-1:0] texel_1, texel_2;
    logic [BITS+1:0] triple, triple_2;
    logic [3:0]      digits_2;

    always_ff @(posedge clk) begin
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

    // The carry from the two lowest bits of a multiple and of the sum to which it is added.
    function automatic logic carry(input logic [1:0] sum, input logic [1:0] digit, input logic [1:0] one);
        logic [1:0] low;
        low   = {digit[0] && one[1], 1'b0} ^ {digit[1] && one[0], digit[0] && one[0]};
        carry = sum[1] && low[1] || (sum[1] || low[1]) && sum[0] && low[0];
    endfunction

    // A sum has the bits from the third one on: no bit of the product below 2^8 is part of the colour. Its addends have one more
    // bit below: a constant 1 in the first one, and `carry` of the omitted bits in the second one, so that they carry if `carry` is 1.
    logic [BITS+1:0] lowest, multiple_1, multiple_2, multiple_3;
    logic [BITS+2:0] row_0;
    logic [BITS+1:0] row_1, row_2;
    logic [BITS:0]   sum, row_3;

    always_comb begin
        // The lowest digit plus 1 is 1 to 4.
        unique case (share[1:0])
            2'd0: lowest = {2'd0, texel_1};
            2'd1: lowest = {1'b0, texel_1, 1'b0};
            2'd2: lowest = triple;
            2'd3: lowest = {texel_1, 2'd0};
        endcase
        // Plus 2^(BITS + 7 − CHANNEL).
        row_0 = CHANNEL == 5 ? {1'b1, lowest} : {lowest[BITS+1], !lowest[BITS+1], lowest[BITS:0]};

        multiple_1 = multiple(share[3:2], texel_1, triple);
        multiple_2 = multiple(digits_2[1:0], texel_2, triple_2);
        multiple_3 = multiple(digits_2[3:2], texel_2, triple_2);

        row_1 = {2'd0, row_0[BITS+2:4], 1'b1} + {1'b0, multiple_1[BITS+1:2], carry(row_0[3:2], share[3:2], texel_1[1:0])};
        row_2 = {2'd0, sum[BITS:2], 1'b1} + {1'b0, multiple_2[BITS+1:2], carry(sum[1:0], digits_2[1:0], texel_2[1:0])};
        row_3 = {1'b0, row_2[BITS+1:3], 1'b1} + {multiple_3[BITS+1:2], carry(row_2[2:1], digits_2[3:2], texel_2[1:0])};
    end

    always_ff @(posedge clk) begin
        sum      <= row_1[BITS+1:1];
        texel_2  <= texel_1;
        triple_2 <= triple;
        digits_2 <= share[7:4];
        colour   <= row_3[BITS -: CHANNEL];
    end

    wire _unused = &{1'b0, row_0[1:0], row_1[0], row_2[0], row_3[BITS-CHANNEL:0],
                     multiple_1[1:0], multiple_2[1:0], multiple_3[1:0]};
endmodule

`default_nettype wire

// Computes p = a·b + c, mapped to one DSP48: signed, 25 by 18 bits, with registers on both sides of the multiplier.
//
//   a, b ─▶│a, b│─▶ × ─▶│product│─▶ + ─▶│p│
//                                   ▲
//                                   c
//
// Latency 3 clocks in which `enable` is high, counted from `a` and `b`, and 1 clock counted from `c`. Throughput one product per clock.
// `c` may depend on `p`, to accumulate products: an expression `select ? p : other` is mapped to the DSP48 without LUTs. A factor that is
// too wide for an input must be split by the user into unsigned parts of 17 bits and a signed part with the highest bits.

`default_nettype none

module multiply_add #(
    parameter int unsigned BITS = 48
) (
    input  wire                    clk,
    input  wire                    enable,
    input  wire  signed [24:0]     a,
    input  wire  signed [17:0]     b,
    input  wire  signed [BITS-1:0] c,
    output logic signed [BITS-1:0] p
);
    logic signed [24:0] factor_a;
    logic signed [17:0] factor_b;
    // A product has at most 43 bits; only its low bits are kept if p is narrower.
    localparam int unsigned PRODUCT_BITS = BITS < 43 ? BITS : 43;
    logic signed [PRODUCT_BITS-1:0] product;

    always_ff @(posedge clk) begin
        if (enable) begin
            factor_a <= a;
            factor_b <= b;
            product  <= factor_a * factor_b;
            p        <= BITS'(product) + c;
        end
    end
endmodule

`default_nettype wire

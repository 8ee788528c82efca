// Computes p = c + x², where the square of the low bits of x is left out, mapped to one DSP48 (docs/raymarch-exits.md, "Spheres
// of a list").
//
//   x ─▶ high·(2·x - high) ─▶ + ─▶ p
//                             ▲
//                             c
//
// `high` is the 18 highest bits of the integer x; p and c are in units of 2^6. The DSP48's pre-adder computes the difference. With
// NEGATIVE the square is subtracted. Latency 3 clocks, counted from `x`, and 1 clock counted from `c`. Throughput one per clock, no
// handshake.

`default_nettype none

module square_add #(
    parameter bit NEGATIVE = 1'b0
) (
    input  wire                clk,
    input  wire  signed [23:0] x,
    input  wire  signed [42:0] c,
    output logic signed [42:0] p
);
    logic signed [17:0] high, high_1;
    logic signed [24:0] twice, whole, factor_1;
    logic signed [42:0] product_2;

    assign high  = x[23:6];
    assign whole = {x[23], x[23:6], 6'd0};
    assign twice = {x, 1'b0};

    always_ff @(posedge clk) begin
        factor_1  <= NEGATIVE ? whole - twice : twice - whole;
        high_1    <= high;
        product_2 <= factor_1 * high_1;
        p         <= product_2 + c;
    end
endmodule

`default_nettype wire

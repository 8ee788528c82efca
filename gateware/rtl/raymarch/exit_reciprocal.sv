// Computes the reciprocal of the magnitude of a direction's component (docs/raymarch-exits.md, "Formats").
//
//   magnitude ─▶ exit_mantissa ─▶ shift by the exponent modulo 8 ─▶ {scale, factor}
//
// `magnitude` is u0.27 and stands for the middle of its interval. Latency 12 clocks, throughput one per clock, no handshake.

`default_nettype none

module exit_reciprocal (
    input  wire                                clk,
    input  wire  [26:0]                        magnitude,
    output logic [exit_pkg::INVERSE_BITS-1:0]  inverse
);
    // The suffix of a name is the number of clocks after the magnitude.
    logic [22:0] mantissa_10;
    logic [4:0]  exponent_10;
    logic [28:0] coarse_11;
    logic [1:0]  scale_11;
    logic        odd_11;

    exit_mantissa reciprocal (.clk, .enable(1'b1), .whole({magnitude, 1'b1}), .mantissa(mantissa_10), .exponent(exponent_10));

    always_ff @(posedge clk) begin
        coarse_11          <= {6'd0, mantissa_10} << {exponent_10[2:1], 1'b0};
        {scale_11, odd_11} <= {exponent_10[4:3], exponent_10[0]};
        inverse            <= {scale_11, odd_11 ? {coarse_11, 1'b0} : {1'b0, coarse_11}};
    end
endmodule

`default_nettype wire

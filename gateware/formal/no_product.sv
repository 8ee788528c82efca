// Stand-in for the module multiply_add in proofs. Its products are 0, so its sum is the addend, which identifies the triangle.

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
    always_ff @(posedge clk) if (enable) p <= c;

    wire _unused = &{1'b0, a, b};
endmodule

`default_nettype wire

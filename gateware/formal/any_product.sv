// Stand-in for the module multiply_add in proofs. It returns an arbitrary result, so properties proven with it hold for all
// operands.

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
    (* anyseq *) logic signed [BITS-1:0] any;

    assign p = any;
endmodule

`default_nettype wire

// Clock gate: `gated` stops while `enable` is low, without glitches, because the gate changes at the falling edge. For
// simulation only; an FPGA has cells for this purpose.

`default_nettype none

module clock_gate (
    input  wire  clk,
    input  wire  enable,
    output logic gated
);
    // The gate is open initially, so that the block sees the reset at the first clock edge.
    logic open = 1'b1;

    always_ff @(negedge clk) open <= enable;

    assign gated = clk && open;
endmodule

`default_nettype wire

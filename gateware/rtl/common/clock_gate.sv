// A clock that stops without a glitch while `enable` is low: the gate changes at the falling edge. For simulation; an FPGA has
// cells for this.

`default_nettype none

module clock_gate (
    input  wire  clk,
    input  wire  enable,
    output logic gated
);
    // Open initially, so that the first edge sees the reset.
    logic open = 1'b1;

    always_ff @(negedge clk) open <= enable;

    assign gated = clk && open;
endmodule

`default_nettype wire

// A wide register whose enable arrives one clock early. The enable has one copy for every LOADS flip-flops, so that no copy drives more
// than LOADS flip-flops.
//
//   next ─▶ copies of the enable ─┬─┬─┬─▶
//   in ──────────────────────────▶ register ──▶ out
//
// `next` is high in the clock before the register takes `in`, and never in two successive clocks. Each copy of the enable depends on
// itself, because synthesis would otherwise merge flip-flops with equal inputs.

`default_nettype none

module wide_register #(
    parameter int unsigned WIDTH = 256,
    parameter int unsigned LOADS = 128
) (
    input  wire              clk,
    input  wire              next,
    input  wire  [WIDTH-1:0] in,
    output logic [WIDTH-1:0] out
);
    localparam int unsigned COPIES = (WIDTH + LOADS - 1) / LOADS;

    (* keep *) logic [COPIES-1:0] enables;

    always_ff @(posedge clk) begin
        for (int i = 0; i < COPIES; i++) enables[i] <= next && !enables[i];
    end

    for (genvar i = 0; i < COPIES; i++) begin : copies
        localparam int unsigned FIRST = i * LOADS;
        localparam int unsigned BITS  = FIRST + LOADS > WIDTH ? WIDTH - FIRST : LOADS;
        always_ff @(posedge clk) if (enables[i]) out[FIRST+:BITS] <= in[FIRST+:BITS];
    end
endmodule

`default_nettype wire

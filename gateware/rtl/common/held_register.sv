// A wide register that loads its input in each clock while it is free, and then holds an item until the item leaves. The enable has one
// copy for every LOADS flip-flops, so that no copy drives more than LOADS flip-flops.
//
//   in_valid, leaves ─▶ copies of `free` ─┬─┬─┬─▶
//   in ──────────────────────────────────▶ register ──▶ out
//
// An item moves in with `in_valid` while `free` is high; `leaves` is high in the last clock in which the item must hold. Each copy of the
// enable depends on itself, because synthesis would otherwise merge flip-flops with equal inputs.

`default_nettype none

module held_register #(
    parameter int unsigned WIDTH = 256,
    parameter int unsigned LOADS = 128
) (
    input  wire              clk,
    input  wire              rst,
    output logic             free,
    input  wire              in_valid,
    input  wire  [WIDTH-1:0] in,
    input  wire              leaves,
    output logic [WIDTH-1:0] out
);
    localparam int unsigned COPIES = (WIDTH + LOADS - 1) / LOADS;

    (* keep *) logic [COPIES-1:0] enables;

    assign free = enables[COPIES-1];

    always_ff @(posedge clk) begin
        for (int i = 0; i < COPIES; i++) enables[i] <= rst || (enables[i] ? !in_valid : leaves);
    end

    for (genvar i = 0; i < COPIES; i++) begin : copies
        localparam int unsigned FIRST = i * LOADS;
        localparam int unsigned BITS  = FIRST + LOADS > WIDTH ? WIDTH - FIRST : LOADS;
        always_ff @(posedge clk) if (enables[i]) out[FIRST+:BITS] <= in[FIRST+:BITS];
    end
endmodule

`default_nettype wire

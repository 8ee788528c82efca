// A FIFO at the end of a long pipeline that cannot be stopped, with a credit for each entry. An item uses a credit when it is sent into the
// pipeline, and returns the credit when it leaves the FIFO, so the FIFO has a free entry for every item in the pipeline. The stages of the
// pipeline have no enable: only valid bits travel with the items.
//
//            ┌──────────┐    ┌────────────┐
//   start ──▶│ pipeline │───▶│ FIFO       │──▶ out
//     ▲      └──────────┘    └────────────┘
//     └─── credits ◀────────────────┘
//
// An item is sent in a clock in which `sent` and `credit` are high, and arrives at the FIFO some clocks later, with `in_valid` high. No
// item may be dropped in the pipeline (pipeline_fifo allows drops, but must keep one entry free per clock of the pipeline). `credit` comes
// from a register. `idle` is high while no item is in the pipeline or in the FIFO.
//
// Latency 2 clocks, or 1 with DIRECT; throughput one item per clock if DEPTH is at least the number of clocks from `sent` to `in_valid`
// plus 4. DEPTH is a power of two.

`default_nettype none

module credit_fifo #(
    parameter int unsigned WIDTH = 8,
    parameter int unsigned DEPTH = 32,
    // No output register, as in `fifo`.
    parameter bit          DIRECT = 1'b0
) (
    input  wire              clk,
    input  wire              rst,
    output logic             idle,
    output logic             credit,
    input  wire              sent,
    input  wire              in_valid,
    input  wire  [WIDTH-1:0] in_data,
    output logic             out_valid,
    input  wire              out_ready,
    output logic [WIDTH-1:0] out_data
);
    localparam int unsigned PLACES     = DEPTH + 32'(!DIRECT);
    localparam int unsigned COUNT_BITS = $clog2(PLACES + 1);

    // Free credits, one for each entry of the FIFO. The count is one clock late, so `credit` already falls when one credit is left. This
    // last credit is reserved for an item that is sent before the previous item has been counted.
    logic [COUNT_BITS-1:0] credits, next;
    logic                  took, gave, in_ready;

    assign next = credits - COUNT_BITS'(took) + COUNT_BITS'(gave);
    assign idle = credits == COUNT_BITS'(PLACES) && !took;

    always_ff @(posedge clk) begin
        took    <= sent && credit;
        gave    <= out_valid && out_ready;
        credits <= next;
        credit  <= next > COUNT_BITS'(1);

        if (rst) begin
            took    <= 1'b0;
            gave    <= 1'b0;
            credits <= COUNT_BITS'(PLACES);
            credit  <= 1'b0;
        end
    end

    fifo #(.WIDTH(WIDTH), .DEPTH(DEPTH), .DIRECT(DIRECT)) fifo (
        .clk, .rst, .in_valid, .in_ready, .in_data, .out_valid, .out_ready, .out_data
    );

    wire _unused = &{1'b0, in_ready};
endmodule

`default_nettype wire

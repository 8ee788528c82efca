// A FIFO at the end of a pipeline that cannot be stopped. The start of the pipeline sends items only in clocks with `room`, so that the
// FIFO has a free entry for every item in the pipeline. The stages of the pipeline have no enable: only valid bits travel with the items.
//
//            ┌───────────────────────┐    ┌────────────┐
//   start ──▶│ at most FLIGHT clocks │───▶│ FIFO       │──▶ out
//     ▲      └───────────────────────┘    └────────────┘
//     └───────────────── room ──────────────────┘
//
// FLIGHT is the number of clocks from the clock in which an item is sent to the clock in which it arrives at the FIFO, with `in_valid`
// high. An item may also be dropped in the pipeline. `room` comes from a register and depends on the number of items two clocks earlier, so
// it already falls when FLIGHT + 2 entries are free.
//
// Latency 2 clocks, 3 with BLOCK, 1 with DIRECT; throughput one item per clock, or one in two clocks with PAUSE. DEPTH is a power of two.
// If DEPTH exceeds 2·(FLIGHT + 2), the FIFO does not run empty before `room` is high again. `idle` is high while the FIFO is empty; items
// in the pipeline have no effect on `idle`.

`default_nettype none

module pipeline_fifo #(
    parameter int unsigned WIDTH  = 8,
    parameter int unsigned DEPTH  = 16,
    parameter int unsigned FLIGHT = 4,
    // The FIFO is in block RAM. By default a clock without an item then follows each item.
    parameter bit          BLOCK  = 1'b0,
    parameter bit          PAUSE  = BLOCK,
    // No output register, as in `fifo`.
    parameter bit          DIRECT = 1'b0
) (
    input  wire              clk,
    input  wire              rst,
    output logic             idle,
    output logic             room,
    input  wire              in_valid,
    input  wire  [WIDTH-1:0] in_data,
    output logic             out_valid,
    input  wire              out_ready,
    output logic [WIDTH-1:0] out_data
);
    localparam int unsigned LEVEL_BITS = $clog2(DEPTH + 3);
    localparam int unsigned MOST       = DEPTH - FLIGHT - 2;

    // Number of items in the FIFO, including the items in its registers.
    logic [LEVEL_BITS-1:0] level;
    logic                  gone, in_ready;

    assign idle = level == '0;
    assign gone = out_valid && out_ready;

    always_ff @(posedge clk) begin
        level <= level + LEVEL_BITS'(in_valid) - LEVEL_BITS'(gone);
        room  <= level <= LEVEL_BITS'(MOST);

        if (rst) begin
            level <= '0;
            room  <= 1'b0;
        end
    end

    fifo #(.WIDTH(WIDTH), .DEPTH(DEPTH), .BLOCK(BLOCK), .PAUSE(PAUSE), .DIRECT(DIRECT)) fifo (
        .clk, .rst, .in_valid, .in_ready, .in_data, .out_valid, .out_ready, .out_data
    );

    wire _unused = &{1'b0, in_ready};
endmodule

`default_nettype wire

// A FIFO with DEPTH + 1 places: DEPTH in LUTRAM, or in block RAM with BLOCK, and one in the output register.
//
// Latency 2 clocks, throughput one item a clock. Stream contract on both sides: an item moves in a clock in which valid
// and ready are high; valid does not wait for ready, and a payload holds until it has moved. `in_ready` and
// `out_valid` come from registers alone. DEPTH is a power of two.
//
//            ┌──────────────┐    ┌──────────┐
//   in ─────▶│ DEPTH places │───▶│  output  │──▶ out
//            └──────────────┘    └──────────┘

`default_nettype none

module fifo #(
    parameter int unsigned WIDTH = 8,
    parameter int unsigned DEPTH = 16,
    parameter bit          BLOCK = 1'b0
) (
    input  wire              clk,
    input  wire              rst,
    input  wire              in_valid,
    output logic             in_ready,
    input  wire  [WIDTH-1:0] in_data,
    output logic             out_valid,
    input  wire              out_ready,
    output logic [WIDTH-1:0] out_data
);
    localparam int unsigned PLACE_BITS = $clog2(DEPTH);

    // The pointers have one bit more than the number of a place: equal pointers mean empty, pointers DEPTH apart mean full.
    logic [PLACE_BITS:0] head, tail;
    logic                stored, load;

    assign stored   = head != tail;
    assign in_ready = head != {~tail[PLACE_BITS], tail[PLACE_BITS-1:0]};
    assign load     = !out_valid || out_ready;

    always_ff @(posedge clk) begin
        // Written without clock enables: flip-flops with an enable of their own take a slice of the FPGA.
        head      <= head + (PLACE_BITS + 1)'(in_valid && in_ready);
        tail      <= tail + (PLACE_BITS + 1)'(load && stored);
        out_valid <= stored || out_valid && !out_ready;

        if (rst) begin
            head      <= '0;
            tail      <= '0;
            out_valid <= 1'b0;
        end
    end

    if (BLOCK) begin : in_block
        (* ram_style = "block", no_rw_check *) logic [WIDTH-1:0] places [0:DEPTH-1];

        always_ff @(posedge clk) begin
            if (in_valid && in_ready) places[head[PLACE_BITS-1:0]] <= in_data;
            if (load) out_data <= places[tail[PLACE_BITS-1:0]];
        end
    end else begin : in_luts
        (* ram_style = "distributed" *) logic [WIDTH-1:0] places [0:DEPTH-1];

        always_ff @(posedge clk) begin
            if (in_valid && in_ready) places[head[PLACE_BITS-1:0]] <= in_data;
            if (load) out_data <= places[tail[PLACE_BITS-1:0]];
        end
    end
endmodule

`default_nettype wire

// A FIFO for DEPTH + 1 items: DEPTH in LUTRAM and one in the output register. With BLOCK it holds DEPTH + 2 items: DEPTH in block
// RAM, one in the read register of the block RAM, whose output is valid late in the clock, and one in the output register. With PAUSE, the
// read register and the output register hold the same item: the read register keeps the item until it leaves the output register, which
// therefore needs no enable. With DIRECT there is no output register: the FIFO holds DEPTH items, and its output is an item in LUTRAM, valid
// a little later in the clock.
//
// Latency 2 clocks, 3 with BLOCK, 1 with DIRECT; throughput one item per clock, or one in two clocks with PAUSE. Stream protocol on both
// sides: an item moves in a clock in which valid and ready are high; valid does not wait for ready, and a payload holds until it has
// moved. `in_ready`, and `out_valid` except with DIRECT, come directly from registers. DEPTH is a power of two.
//
//            ┌──────────────┐    ┌───────────────────┐    ┌──────────┐
//   in ─────▶│ DEPTH places │───▶│ read (BLOCK only) │───▶│  output  │──▶ out
//            └──────────────┘    └───────────────────┘    └──────────┘

`default_nettype none

module fifo #(
    parameter int unsigned WIDTH = 8,
    parameter int unsigned DEPTH = 16,
    parameter bit          BLOCK = 1'b0,
    // Only with BLOCK: a clock without an item follows each item.
    parameter bit          PAUSE = 1'b0,
    // Only without BLOCK: no output register.
    parameter bit          DIRECT = 1'b0
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

    // The pointers have one bit more than the index of an entry: if the pointers are equal, the FIFO is empty; if they differ by DEPTH, its
    // memory is full. With DIRECT, `read_valid` is always high.
    logic [PLACE_BITS:0] head, tail;
    logic                stored, load, read_valid, read_ready;

    assign stored   = head != tail;
    assign in_ready = head != {~tail[PLACE_BITS], tail[PLACE_BITS-1:0]};
    assign load     = !read_valid || read_ready;

    always_ff @(posedge clk) begin
        // Written without clock enables: flip-flops with different enables cannot share a slice of the FPGA.
        head       <= head + (PLACE_BITS + 1)'(in_valid && in_ready);
        tail       <= tail + (PLACE_BITS + 1)'(load && stored);
        read_valid <= DIRECT || stored || read_valid && !read_ready;

        if (rst) begin
            head       <= '0;
            tail       <= '0;
            read_valid <= DIRECT;
        end
    end

    if (BLOCK) begin : in_block
        (* ram_style = "block", no_rw_check *) logic [WIDTH-1:0] places [0:DEPTH-1];
        logic [WIDTH-1:0] read;

        assign read_ready = PAUSE ? out_valid && out_ready : !out_valid || out_ready;

        always_ff @(posedge clk) begin
            if (in_valid && in_ready) places[head[PLACE_BITS-1:0]] <= in_data;
            if (load) read <= places[tail[PLACE_BITS-1:0]];
            if (PAUSE || read_ready) out_data <= read;
            out_valid <= !rst && (PAUSE ? read_valid && !read_ready : read_valid || out_valid && !out_ready);
        end
    end else begin : in_luts
        (* ram_style = "distributed", no_rw_check *) logic [WIDTH-1:0] places [0:DEPTH-1];

        assign out_valid  = DIRECT ? stored : read_valid;
        assign read_ready = out_ready;

        always_ff @(posedge clk) if (in_valid && in_ready) places[head[PLACE_BITS-1:0]] <= in_data;

        if (DIRECT) begin : direct
            assign out_data = places[tail[PLACE_BITS-1:0]];
        end else begin : registered
            always_ff @(posedge clk) if (load) out_data <= places[tail[PLACE_BITS-1:0]];
        end
    end
endmodule

`default_nettype wire

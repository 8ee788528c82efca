// A FIFO between two clock domains, for DEPTH + 1 items: DEPTH in LUTRAM and one in the output register.
//
// Latency 1 clock of `in_clk` and 3 to 4 of `out_clk`, throughput one item per clock of the slower domain. Stream protocol on both sides,
// as in `fifo`. Either clock may stop at any time. DEPTH is a power of two, at least 4.
//
//            in_clk │ out_clk
//   in ─▶ places ───┼──────────▶ output ─▶ out
//           ▲       │              │
//         head ─────┼─▶ head_seen ─┤        the pointers cross in Gray code, through cdc_level: one bit changes at a time, so the
//      tail_seen ◀──┼───────────  tail      other side sees the pointer from before or after the change
//
// An entry is not read before the `head` that includes this entry has crossed to `out_clk`, so the entry's content is stable. The pointers
// have no reset, because a reset of only one side would output stale items.

`default_nettype none

module cdc_fifo #(
    parameter int unsigned WIDTH = 8,
    parameter int unsigned DEPTH = 16
) (
    input  wire              in_clk,
    input  wire              in_valid,
    output logic             in_ready,
    input  wire  [WIDTH-1:0] in_data,
    input  wire              out_clk,
    output logic             out_valid,
    input  wire              out_ready,
    output logic [WIDTH-1:0] out_data
);
    localparam int unsigned PLACE_BITS = $clog2(DEPTH);

    typedef logic [PLACE_BITS:0] pointer_t;

    // The pointers have one bit more than the index of an entry. The Gray codes of two pointers whose difference is DEPTH differ in exactly
    // the two highest bits.
    localparam pointer_t FULL = pointer_t'(3) << (PLACE_BITS - 1);

    /* verilator lint_off PROCASSINIT */ // The configuration of the FPGA sets these registers.
    pointer_t head = '0, head_gray = '0, tail = '0, tail_gray = '0;
    logic     holding = 1'b0; // an item is in the output register
    /* verilator lint_on PROCASSINIT */
    pointer_t head_seen, head_next, tail_seen, tail_next;
    logic     load;

    (* ram_style = "distributed" *) logic [WIDTH-1:0] places [0:DEPTH-1];

    for (genvar i = 0; i <= PLACE_BITS; i++) begin : pointers
        cdc_level to_output (.clk(out_clk), .level(head_gray[i]), .synced(head_seen[i]));
        cdc_level to_input  (.clk(in_clk),  .level(tail_gray[i]), .synced(tail_seen[i]));
    end

    assign in_ready  = head_gray != (tail_seen ^ FULL);
    assign head_next = head + pointer_t'(in_valid && in_ready);
    assign out_valid = holding;
    assign load      = !holding || out_ready;
    assign tail_next = tail + pointer_t'(load && tail_gray != head_seen);

    always_ff @(posedge in_clk) begin
        if (in_valid && in_ready) places[head[PLACE_BITS-1:0]] <= in_data;
        head      <= head_next;
        head_gray <= head_next ^ head_next >> 1;
    end

    always_ff @(posedge out_clk) begin
        if (load) begin
            out_data <= places[tail[PLACE_BITS-1:0]];
            holding  <= tail_gray != head_seen;
        end
        tail      <= tail_next;
        tail_gray <= tail_next ^ tail_next >> 1;
    end
endmodule

`default_nettype wire

// Collects the colours of a group's pixels from the steps of the texture filter, and keeps finished groups until they are taken.
//
//   step ─▶ memory of each lane ─▶ output register ─▶ group
//
// The colours of a step are written to the entry of the group that is being collected; `in_last` ends the group. The steps come from a
// pipeline that cannot be stopped; its start sends steps only while `room` is high. FLIGHT is the maximum number of steps that still arrive
// from the clock in which `room` falls. Output: a valid/ready stream. `out_opaque` is the mask of the lanes that are in a step of the group
// and not transparent; the colours of other lanes are undefined. `in_blend` is stored with the last step. Latency 2 clocks from the last
// step, throughput one group per clock.

`default_nettype none

module texture_collect #(
    // Capacity in groups, a power of two.
    parameter int unsigned DEPTH  = 32,
    parameter int unsigned FLIGHT = 20,
    // Width of a colour.
    parameter int unsigned COLOUR_BITS = 16
) (
    input  wire              clk,
    input  wire              rst,
    output logic             room,
    input  wire              in_valid,
    input  wire  [3:0]       in_mask,    // lanes of the step in its half
    input  wire              in_half,
    input  wire              in_last,
    input  wire  [3:0]       in_opaque,
    input  wire  [3:0][COLOUR_BITS-1:0] in_colours,
    input  wire  [3:0]       in_blend,
    output logic             out_valid,
    input  wire              out_ready,
    output logic [3:0]       out_blend,
    output logic [7:0]       out_opaque,
    output logic [7:0][COLOUR_BITS-1:0] out_colours
);
    localparam int unsigned PLACE_BITS = $clog2(DEPTH);

    typedef logic [PLACE_BITS:0] pointer_t;

    pointer_t   head, tail, count;
    logic       finished, load;
    logic [7:0] found, found_before;

    assign count    = head - tail;
    assign finished = in_valid && in_last;
    assign load     = !out_valid || out_ready;

    for (genvar i = 0; i < 8; i++) begin : lanes
        (* ram_style = "distributed", no_rw_check *) logic [COLOUR_BITS-1:0] places [0:DEPTH-1];
        logic writes;

        assign writes   = in_valid && in_half == 1'(i / 4) && in_mask[i % 4];
        assign found[i] = writes ? in_opaque[i % 4] : found_before[i];

        always_ff @(posedge clk) begin
            if (writes) places[head[PLACE_BITS-1:0]] <= in_colours[i % 4];
            if (load) out_colours[i] <= places[tail[PLACE_BITS-1:0]];
        end
    end

    (* ram_style = "distributed", no_rw_check *) logic [11:0] others [0:DEPTH-1];

    always_ff @(posedge clk) begin
        if (finished) others[head[PLACE_BITS-1:0]] <= {in_blend, found};
        if (load) {out_blend, out_opaque} <= others[tail[PLACE_BITS-1:0]];

        found_before <= finished ? '0 : found;
        head         <= head + pointer_t'(finished);
        tail         <= tail + pointer_t'(load && head != tail);
        out_valid    <= head != tail || out_valid && !out_ready;
        room         <= count <= pointer_t'(DEPTH - FLIGHT);

        if (rst) begin
            found_before <= '0;
            head         <= '0;
            tail         <= '0;
            out_valid    <= 1'b0;
            room         <= 1'b0;
        end
    end
endmodule

`default_nettype wire

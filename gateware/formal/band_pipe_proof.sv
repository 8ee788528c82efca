// Proof that band_pipe handles its read-modify-write hazard: the result equals the result with a memory without latency.
//
// The pipe works on two rows of a depth memory with the latencies of band_bank, which also has a written bit per pixel. Arbitrary groups
// (eight pixels of a row) arrive at arbitrary times. The proof tracks one pixel, an arbitrary lane of an arbitrary row: each accepted group
// updates a copy of this pixel at once. When the pipe is empty, the copy and the memory must agree. With BLEND, any group may be a blended
// pixel, or ask which of its lanes pass the depth test. The answer must agree with the copy at the time when the group was accepted; one
// answer is outstanding at a time.

`default_nettype none

module band_pipe_proof #(
    parameter bit BLEND = 1'b0
) (
    input wire            clk,
    input wire            open,
    input wire            group_valid,
    input wire            group_row,
    input wire [7:0]      group_mask,
    input wire [8*18-1:0] group_codes,
    input wire            group_asks,
    input wire            group_blended,
    // Tag in all colours of the group; the tag distinguishes groups of equal depth.
    input wire [1:0]      group_tag
);
    // Upper bound (exclusive) on the clocks for which the pipe holds back a group.
    localparam int unsigned WITHIN = 4;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    (* anyconst *) logic       row;
    (* anyconst *) logic [2:0] lane;

    logic            group_ready, read_row, write_row, empty;
    logic [8*18-1:0] stored, write_codes;
    logic [8*16-1:0] write_colours;
    logic [7:0]      stored_written, write_lanes, write_depths, answer_lanes;
    logic            asks, blended, answer_valid;

    band_pipe #(.ROW_BITS(1), .BLEND(BLEND)) dut (
        .clk, .rst, .open,
        .group_valid, .group_ready, .group_row, .group_mask, .group_halves('1), .group_codes, .group_colours({8{14'b0, group_tag}}),
        .group_asks(asks), .group_blended(blended), .answer_valid, .answer_lanes,
        .read_row, .stored, .stored_written, .write_row, .write_lanes, .write_depths, .write_halves(), .write_codes, .write_colours, .empty, .held()
    );

    // Model of the memory. The model stores only the tracked pixel. A read of any other pixel returns an arbitrary value, because the
    // result must not depend on other pixels.
    logic        from_row, to_row, to_lane, to_depth, latched_written, read_written, written;
    logic [17:0] to_store, latched, read, code;
    logic        latched_here, read_here;
    logic [1:0]  to_tag, tag;
    (* anyseq *) logic [8*18-1:0] other_codes;
    (* anyseq *) logic [7:0]      other_written;

    always_ff @(posedge clk) begin
        from_row        <= read_row;
        latched         <= code;
        latched_written <= written;
        latched_here    <= from_row == row;
        read            <= latched;
        read_written    <= latched_written;
        read_here       <= latched_here;
        to_row          <= write_row;
        to_lane         <= write_lanes[lane];
        to_depth        <= write_depths[lane];
        to_store        <= write_codes[18*lane +: 18];
        to_tag          <= write_colours[16*lane +: 2];
        if (to_depth && to_row == row) code <= to_store;
        if (to_lane && to_row == row) begin
            tag     <= to_tag;
            written <= 1'b1;
        end
        if (rst) begin
            written  <= 1'b0;
            to_lane  <= 1'b0;
            to_depth <= 1'b0;
        end
    end

    always_comb begin
        stored         = other_codes;
        stored_written = other_written;
        if (read_here) begin
            stored[18*lane +: 18] = read;
            stored_written[lane]  = read_written;
        end
    end

    // Copy of the tracked pixel, which accepted groups update without latency.
    logic        taken, drawn, hits, passes;
    logic [17:0] nearest, given;
    logic [1:0]  nearest_tag;
    logic [2:0]  refused;

    assign given  = group_codes[18*lane +: 18];
    assign taken  = group_valid && group_ready;
    assign hits   = taken && group_row == row && group_mask[lane];
    assign passes = !drawn || given >= nearest;

    // The answer that is outstanding: `checks` is high if it has the tracked pixel's row, and `expects` if this pixel passes.
    logic waits, checks, expects, answered;

    assign asks     = BLEND && group_asks && !waits;
    assign blended  = BLEND && group_blended && !asks;
    assign answered = waits && (!checks || answer_lanes[lane] == expects);

    // `was_empty` is `empty` in the previous clock. Writes reach the model of the memory one clock late, so the model is compared with the
    // copy only after two clocks of `empty`. `was_held` is high if any group has been held back.
    logic was_empty, was_held;

    always_ff @(posedge clk) begin
        was_empty <= empty;
        was_held  <= was_held || refused != '0;
        refused   <= open && group_valid && !group_ready ? refused + 1'b1 : '0;
        if (hits && !asks && (passes || blended)) begin
            drawn <= 1'b1;
            if (!blended)    nearest <= given;
            else if (!drawn) nearest <= '0;
            nearest_tag <= group_tag;
        end
        if (taken && asks && group_mask != '0) begin
            waits   <= 1'b1;
            checks  <= group_row == row;
            expects <= hits && passes;
        end else if (answer_valid) begin
            waits <= 1'b0;
        end
        if (rst) begin
            drawn     <= 1'b0;
            was_empty <= 1'b0;
            was_held  <= 1'b0;
            refused   <= '0;
            waits     <= 1'b0;
        end
    end

    always_ff @(posedge clk) if (!rst) begin
        drawn_as_given: assert ((!(empty && was_empty)
                                 || (written == drawn && (!drawn || (code == nearest && tag == nearest_tag)) && (!waits || answer_valid)))
                                && (!answer_valid || answered));
        taken_in_time:  assert (refused < 3'(WITHIN));
        held_and_drawn: cover (empty && was_empty && was_held && drawn);
    end
endmodule

`default_nettype wire

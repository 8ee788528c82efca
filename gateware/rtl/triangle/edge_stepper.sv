// Computes an edge function along the walk: its value E' in the best lane of the current group, a snapshot of this value at an earlier
// group, and whether the edge fails beside the group. raster_pkg explains `best` and `beside`.
//
// From one group to the next E' changes by eight times the slope. The better side is the side on which E' increases: the right side if the
// edge rises, the left side otherwise. In each clock with `advance`:
//
//   move               best becomes                    beside becomes the sign of
//   to the better side from + 8 * slope                from
//   to the worse side  from - 8 * slope                from - 16 * slope
//   DOWN               snapshot + step_y               snapshot + beside_step
//   LOAD               load_best                       load_beside_fails
//
// `from` is the current value, or the snapshot if the move is RIGHT and `resume` is high. `beside_step` is step_y - 8 * slope.
// `keep` preserves the snapshot; without `keep` the snapshot takes the new value. Sums are modulo 2^34.
//
// `move` is the last signal to arrive in the walker's critical loop. All sums are therefore computed in parallel with the move, which only
// selects one of them. For the same reason `resume` is an input one clock ahead, as `next_resume`. Latency 1 clock, throughput one move per
// clock.

`default_nettype none

module edge_stepper (
    input  wire                     clk,
    input  wire                     advance,
    input  wire                     keep,
    input  wire                     next_resume,
    input  wire raster_pkg::move_t  move,
    input  wire  [33:0]             load_best,
    input  wire                     load_beside_fails,
    input  wire                     rises,
    input  wire  [19:0]             slope,
    input  wire  [20:0]             step_y,
    input  wire  [24:0]             beside_step,
    output logic [33:0]             best,
    output logic                    beside_fails
);
    logic [33:0] snapshot, better_from, worse_from, down, down_beside, next;
    logic [30:0] better, not_worse;
    logic [29:0] not_beyond;
    logic        sideways, select, next_beside_fails;

    // `resume` for a move to the better side and for a move to the worse side; only the right side can resume.
    logic better_resumes, worse_resumes;

    always_ff @(posedge clk) begin
        if (advance) {better_resumes, worse_resumes} <= {next_resume && rises, next_resume && !rises};
    end

    assign better_from = better_resumes ? snapshot : best;
    assign worse_from  = worse_resumes ? snapshot : best;

    // A difference a - b is computed as the complement of b + ~a, so that one operand of each adder comes from a register. A sum then takes
    // one LUT per bit.
    assign better      = {11'd0, slope} + better_from[33:3];
    assign not_worse   = {11'd0, slope} + ~worse_from[33:3];
    assign not_beyond  = {10'd0, slope} + ~worse_from[33:4];
    assign down        = {{13{step_y[20]}}, step_y} + snapshot;
    assign down_beside = {{9{beside_step[24]}}, beside_step} + snapshot;

    assign sideways = move == raster_pkg::LEFT || move == raster_pkg::RIGHT;
    assign select   = sideways ? (move == raster_pkg::RIGHT) == rises : move == raster_pkg::LOAD;

    always_comb begin
        case ({sideways, select})
            2'b11: {next, next_beside_fails} = {better, better_from[2:0], better_from[33]};
            2'b10: {next, next_beside_fails} = {~not_worse, worse_from[2:0], !not_beyond[29]};
            2'b01: {next, next_beside_fails} = {load_best, load_beside_fails};
            2'b00: {next, next_beside_fails} = {down, down_beside[33]};
        endcase
    end

    always_ff @(posedge clk) begin
        if (advance) {best, beside_fails} <= {next, next_beside_fails};
        if (advance && !keep) snapshot <= next;
    end

    wire _unused = &{1'b0, not_beyond[28:0], down_beside[32:0]};
endmodule

`default_nettype wire

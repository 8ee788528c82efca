// Visits the groups of eight pixels of a triangle in a band, one group per clock, and sends the groups that the triangle may cover. E' is
// the value of an edge function (docs/formats/triangle.md, "Triangle setup"); an edge passes in a pixel with E' >= 0 and fails otherwise.
// A group has lanes 0 to 7 from left to right; lanes -1 and 8 are the pixels next to it.
//
//        ┌──────┐     row by row, from group_start:
//        │ seek │───▶ until no edge fails in the whole group
//        └──────┘
//   ◀─2─┤first├─1'─▶  then to the left while lane -1 is inside (1, 2, …), then from the first group, kept as a
//          │          snapshot, to the right while lane 8 is inside (1', …), then down from the snapshot.
//          ▼
//
// The walker misses no covered group. The covered columns of a row reach from a column a to a column b: edges with step_x > 0
// (rising) have E' >= 0 from column a on, edges with step_x < 0 (falling) up to column b; a horizontal edge passes everywhere
// in the row or nowhere.
//  * An edge that fails at both ends of a group fails in the whole group. If such an edge rises, column a is further right; if it falls,
//    column b is further left. The covered columns lie on that side. The row is empty if two failing edges point to different
//    sides, if the direction returns to a group where an edge has failed or leaves the bounds, or if a horizontal edge fails.
//    Seeking therefore never abandons a row with coverage, and never ends in a group without coverage in such a row:
//  * In a group of the columns g0…g7 in which every edge passes in at least one lane, a <= g7 and b >= g0. In a row with coverage
//    (a <= b) the covered columns of the group are therefore max(a, g0)…min(b, g7). In an empty row the group is sent without coverage,
//    and the row is done.
//  * The covered columns are contiguous, so they continue to the left only if lane -1 is covered, and to the right only if lane 8 is
//    covered. In a group in which every edge passes in at least one lane, the rising edges determine whether lane -1 is covered, and the
//    falling edges whether lane 8 is covered: the E' of all other edges in that lane is at least as large as in any lane of the group.
//    No edge therefore fails in a whole group that is reached in this way.
// A group is sent at most once: seeking visits only groups that have not been sent, and both directions lead away from the first group. A
// row begins at the first group of the row above, or, if the row above was empty, at the last group that was visited in that row. Any
// start within the bounds is correct.
//
// The walker stays within group_left…group_right and the rows, so edge functions are evaluated at most one pixel outside of the
// picture and fit 34 bits.
//
// Both streams are valid/ready. `out_ready` is a register outside of the walker, and `in_ready` depends on it. Throughput one visited group
// per clock; the next triangle's first group follows the last group without a gap. `walking` is high in the clocks in which a group is
// visited.
//
// Only the edge functions and the group's number affect the next move. The accumulators of depth, line and colour make the same moves one
// clock later, and those of light 1 + LIGHT_LATER clocks after that.

`default_nettype none

module walker #(
    parameter bit SMOOTH = 1'b0,
    parameter bit TEXTURE = 1'b0,
    localparam int unsigned CHANNELS    = triangle_pkg::channels(SMOOTH, TEXTURE),
    localparam int unsigned PLANES_BITS = triangle_pkg::planes_bits(SMOOTH, TEXTURE)
) (
    input  wire                           clk,
    input  wire                           rst,
    output logic                          idle,
    output logic                          walking,
    input  wire                           in_valid,
    output logic                          in_ready,
    input  wire raster_pkg::placed_t      in_triangle,
    input  wire raster_pkg::placed_late_t in_late,      // a clock after `in_triangle`
    input  wire  [PLANES_BITS-1:0]        in_planes,    // LIGHT_LATER clocks after `in_late`
    output logic                          out_valid,
    input  wire                           out_ready,
    output raster_pkg::candidate_t        out_group,
    output raster_pkg::late_t             out_late,     // a clock after `out_group`
    // The planes in the format of `in_planes`, with their values in lane 0 of the group, 1 + LIGHT_LATER clocks after `out_late`.
    output logic [PLANES_BITS-1:0]        out_planes
);
    // Constants of the current triangle.
    logic [2:0][19:0] slope;
    logic [2:0][20:0] step_y;
    logic [2:0][24:0] beside_step;
    logic [2:0]       rises, falls;
    logic [7:0]       group_left, group_right;

    // State at the current group.
    logic [2:0][33:0] best;
    logic [2:0]       beside_fails;
    logic [7:0]       group, snapshot;
    logic [5:0]       rows_below;
    logic             active, last_row;

    // Directions in which the walker may still move in this row: `seek_*` before the row's first group is found, `extend_*`
    // from that group on. `resume` is high while groups to the right of the snapshot remain to be visited.
    logic seek_left, seek_right, extend_left, extend_right, resume, next_resume;

    // The next move, determined by the signs of the edge functions and the directions declared above.
    logic [2:0]        best_fails;
    logic              fails, go_right, go_left, open_left, open_right;
    logic              extend, seek, left, leave;
    raster_pkg::move_t move;

    always_comb begin
        for (int k = 0; k < 3; k++) best_fails[k] = best[k][33];
    end

    assign fails      = best_fails != '0;
    assign go_right   = (best_fails & rises) != '0;
    assign go_left    = (best_fails & falls) != '0;
    assign open_left  = (beside_fails & rises) == '0;
    assign open_right = (beside_fails & falls) == '0;

    assign extend = !fails && (open_left && extend_left || open_right && extend_right);
    assign left   = !fails && open_left && extend_left || go_left && !go_right && seek_left;
    assign seek   = resume || go_right && !go_left && seek_right || go_left && !go_right && seek_left;
    assign leave  = !extend && !seek && last_row;

    always_comb begin
        if (extend || seek) move = left ? raster_pkg::LEFT : raster_pkg::RIGHT;
        else                move = last_row ? raster_pkg::LOAD : raster_pkg::DOWN;
    end

    assign next_resume = extend && left && (resume || open_right && extend_right);

    assign idle     = !active;
    assign walking  = active && out_ready;
    assign in_ready = leave && out_ready;

    // While the walker seeks, the snapshot is the current group. It is kept while the walker extends from the first group of the row to
    // both sides.
    logic keep;

    assign keep = extend || resume;

    for (genvar k = 0; k < 3; k++) begin : edges
        edge_stepper edge_stepper (
            .clk, .advance(out_ready), .keep, .next_resume, .move,
            .load_best(in_triangle.best[k]), .load_beside_fails(in_triangle.beside_fails[k]),
            .rises(rises[k]), .slope(slope[k]), .step_y(step_y[k]), .beside_step(beside_step[k]),
            .best(best[k]), .beside_fails(beside_fails[k])
        );

        // The changes of E' for a move down by one row, for `best` and for `beside`, which is one group further towards the worse side. An
        // idle walker makes no such move, so these registers load valid triangles only: their enable has half of the loads of an enable for
        // all constants.
        always_ff @(posedge clk) begin
            if (out_ready && leave && in_valid) begin
                step_y[k]      <= in_triangle.step_y[k];
                beside_step[k] <= 25'(signed'(in_triangle.step_y[k])) - {2'd0, in_triangle.slope[k], 3'd0};
            end
        end

        assign out_group.best[k] = best[k][32:0];
    end

    // Like the sums in edge_stepper, the numbers of all possible next groups and their comparisons with the bounds are computed at
    // the same time as the move. A group to the left is never the rightmost group, nor a group to the right the leftmost group.
    // Without a next triangle, no direction is open after LOAD: the walker stays idle, ready to load a triangle.
    logic [7:0] left_group, right_group, next_group;
    logic       load_at_left, load_at_right, snapshot_at_left, snapshot_at_right, at_left, at_right;

    assign left_group    = group - 1'b1;
    assign right_group   = (resume ? snapshot : group) + 1'b1;
    assign load_at_left  = !in_valid || in_triangle.group_start == in_triangle.group_left;
    assign load_at_right = !in_valid || in_triangle.group_start == in_triangle.group_right;

    always_comb begin
        case (move)
            raster_pkg::LEFT:  {at_left, at_right, next_group} = {left_group == group_left, 1'b0, left_group};
            raster_pkg::RIGHT: {at_left, at_right, next_group} = {1'b0, right_group == group_right, right_group};
            raster_pkg::DOWN:  {at_left, at_right, next_group} = {snapshot_at_left, snapshot_at_right, snapshot};
            default:           {at_left, at_right, next_group} = {load_at_left, load_at_right, in_triangle.group_start};
        endcase
    end

    always_ff @(posedge clk) begin
        if (out_ready) begin
            group        <= next_group;
            seek_left    <= !keep && move != raster_pkg::RIGHT && !at_left;
            seek_right   <= !keep && move != raster_pkg::LEFT && !at_right;
            extend_left  <= (!keep || left) && !at_left;
            extend_right <= (!keep || !left) && !at_right;
            resume       <= next_resume;
            if (!keep) {snapshot_at_left, snapshot_at_right, snapshot} <= {at_left, at_right, next_group};

            if (move == raster_pkg::DOWN) begin
                rows_below <= rows_below - 1'b1;
                last_row   <= rows_below == 6'd1;
            end

            if (leave) begin
                active      <= in_valid;
                slope       <= in_triangle.slope;
                rises       <= in_triangle.rises;
                falls       <= in_triangle.falls;
                group_left  <= in_triangle.group_left;
                group_right <= in_triangle.group_right;
                rows_below  <= in_triangle.rows - 1'b1;
                last_row    <= !in_valid || in_triangle.rows == 6'd1;
            end
        end

        if (rst) begin
            active       <= 1'b0;
            last_row     <= 1'b1;
            seek_left    <= 1'b0;
            seek_right   <= 1'b0;
            extend_left  <= 1'b0;
            extend_right <= 1'b0;
            resume       <= 1'b0;
        end
    end

    assign out_valid       = active && !fails;
    assign out_group.group = group;
    assign out_group.slope = slope;
    assign out_group.rises = rises;

    // The move of the previous clock, which is applied to depth, line and colour in this clock.
    raster_pkg::move_t late_move;
    logic              late_keep, late_resume, late_advance;

    always_ff @(posedge clk) begin
        {late_keep, late_resume, late_advance} <= {keep, resume, out_ready};
        late_move <= move;
    end

    always_ff @(posedge clk) begin
        if (late_advance && late_move == raster_pkg::DOWN) out_late.line <= out_late.line + 1'b1;
        if (late_advance && late_move == raster_pkg::LOAD) begin
            out_late.line         <= in_late.line;
            out_late.depth_step_x <= in_late.depth_step_x;
            out_late.depth_step_y <= in_late.depth_step_y;
            out_late.colour       <= in_late.colour;
        end
    end

    stepper depth_stepper (
        .clk, .advance(late_advance), .keep(late_keep), .resume(late_resume), .move(late_move), .load_value(in_late.depth),
        .step_x(out_late.depth_step_x), .step_y(out_late.depth_step_y), .current(out_late.depth)
    );

    // An earlier move, which is applied to the planes of light and texture in this clock. The delay of the controls takes fewer flip-flops
    // than a delay of the planes.
    if (CHANNELS > 0) begin : channels_built
        localparam int unsigned CONSTANT_BITS = PLANES_BITS - 96 * CHANNELS;

        raster_pkg::move_t      early_move, light_move;
        logic                   early_keep, early_resume, early_advance, light_keep, light_resume, light_advance;
        logic [PLANES_BITS-1:0] planes;

        delay #(.WIDTH(5), .CLOCKS(raster_pkg::LIGHT_LATER)) move_delay (
            .clk, .enable(1'b1), .in({late_keep, late_resume, late_advance, late_move}),
            .out({early_keep, early_resume, early_advance, early_move})
        );

        always_ff @(posedge clk) begin
            {light_keep, light_resume, light_advance} <= {early_keep, early_resume, early_advance};
            light_move <= early_move;
            if (early_advance && early_move == raster_pkg::LOAD) planes <= in_planes;
            out_planes[96 * CHANNELS +: CONSTANT_BITS] <= planes[96 * CHANNELS +: CONSTANT_BITS];
        end

        for (genvar k = 0; k < CHANNELS; k++) begin : channels
            records_pkg::plane_t plane;

            assign plane = planes[96 * k +: 96];

            stepper light_stepper (
                .clk, .advance(light_advance), .keep(light_keep), .resume(light_resume), .move(light_move),
                .load_value(plane.start), .step_x(plane.step_x), .step_y(plane.step_y), .current(out_planes[96 * k +: 32])
            );

            always_ff @(posedge clk) out_planes[96 * k + 32 +: 64] <= {plane.step_y, plane.step_x};
        end
    end else begin : flat
        assign out_planes = '0;

        wire _unused = &{1'b0, in_planes};
    end
endmodule

`default_nettype wire

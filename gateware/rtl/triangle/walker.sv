// Visits the part of a triangle in a band in groups of eight pixels, one group a clock, and sends the groups that the triangle
// may cover. E' is the value of an edge function (docs/formats.md, "Triangle setup"); an edge passes in a pixel with E' >= 0
// and fails otherwise. A group has lanes 0 to 7 from left to right; lanes -1 and 8 are the pixels next to it.
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
//  * An edge that fails at both ends of a group fails in the whole group. If it rises, column a is further right; if it falls,
//    column b is further left. The covered columns lie on that side. The row is empty if two failing edges point to different
//    sides, if the direction returns to a group where an edge has failed or leaves the bounds, or if a horizontal edge fails.
//    So seeking never gives up a row with coverage, and never ends in a group without coverage:
//  * in a group g0…g7 where no edge fails everywhere, a <= g7 and b >= g0. So in a row with coverage (a <= b) the group
//    covers max(a, g0)…min(b, g7). In an empty row the group is sent without coverage, and the row is done.
//  * The covered columns are contiguous, so they continue to the left only if lane -1 is covered, and to the right only if
//    lane 8 is. In a group where no edge fails everywhere, the rising edges decide lane -1 and the falling edges lane 8, because
//    all other edges have an E' there that is at least as large as in any lane of this group. So no edge fails in a whole
//    group that is reached in this way.
// A group is sent at most once: seeking visits only groups that are not sent, and both directions lead away from the first
// group. A row begins at the first group of the row above, or, if that row was empty, at the last group tried in it; any start
// within the bounds is correct.
//
// The walker stays within group_left…group_right and the rows, so edge functions are evaluated at most one pixel outside of the
// picture and fit 34 bits.
//
// Both streams are valid/ready; ready passes through combinationally, from the output to the input. Throughput one group a
// clock, covered or not; the next triangle's first group follows the last one without a gap. `walking` is high in the clocks
// that are spent on a group.

`default_nettype none

module walker #(
    parameter bit SMOOTH = 1'b0,
    localparam int unsigned PLANES_BITS = SMOOTH ? 289 : 1,
    localparam int unsigned VALUES_BITS = SMOOTH ? 193 : 1
) (
    input  wire                      clk,
    input  wire                      rst,
    output logic                     idle,
    output logic                     walking,
    input  wire                      in_valid,
    output logic                     in_ready,
    input  wire raster_pkg::placed_t in_triangle,
    input  wire  [PLANES_BITS-1:0]   in_planes,
    output logic                     out_valid,
    input  wire                      out_ready,
    output raster_pkg::candidate_t   out_group,
    // Light of the group, a clock after `out_group`: {smooth, blue, green, red}; each channel is {step_x, accumulator
    // in lane 0}.
    output logic [VALUES_BITS-1:0]   out_light
);
    // The triangle.
    logic [2:0][20:0] step_x, step_y;
    logic [31:0]      depth_step_x, depth_step_y;
    logic [2:0][19:0] slope;
    logic [2:0]       rises, falls;
    logic [7:0]       group_left, group_right;
    logic [15:0]      colour;

    // The place.
    logic [2:0][33:0] best, beside;
    logic [31:0]      depth;
    logic [7:0]       group, next_group;
    logic [5:0]       line, rows_below;
    logic             active, last_row;

    // Directions in which the walker may still move in this row: `seek_*` before the row's first group is found, `extend_*`
    // from that group on. `resume` is high while groups to the right of the snapshot remain to be visited.
    logic seek_left, seek_right, extend_left, extend_right, resume;

    // The next move, decided from the signs of the edge functions and from the directions declared above.
    logic [2:0]        best_fails, beside_fails;
    logic              fails, go_right, go_left, open_left, open_right;
    logic              extend, seek, left, leave;

    always_comb begin
        for (int k = 0; k < 3; k++) begin
            best_fails[k]  = best[k][33];
            beside_fails[k] = beside[k][33];
        end
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

    assign idle     = !active;
    assign walking  = active && out_ready;
    assign in_ready = leave && out_ready;

    // While the walker seeks, the snapshot is the current group. It is kept while the walker extends from the first group
    // of the row.
    logic keep;

    assign keep = extend || resume;

    for (genvar k = 0; k < 3; k++) begin : edges
        logic [33:0] group_step, row_step, next_best, next_beside;

        assign group_step = {{10{step_x[k][20]}}, step_x[k], 3'b000};
        assign row_step   = {{13{step_y[k][20]}}, step_y[k]};

        stepper best_stepper (
            .clk, .advance(out_ready), .keep, .extend, .seek, .left, .last(last_row),
            .load_value(in_triangle.best[k]), .step_x(group_step), .step_y(row_step),
            .current(best[k]), .next(next_best)
        );
        stepper beside_stepper (
            .clk, .advance(out_ready), .keep, .extend, .seek, .left, .last(last_row),
            .load_value(in_triangle.beside[k]), .step_x(group_step), .step_y(row_step),
            .current(beside[k]), .next(next_beside)
        );

        wire _unused = &{1'b0, next_best, next_beside};
    end

    logic [31:0] next_depth;

    stepper #(.WIDTH(32), .LOW(16)) depth_stepper (
        .clk, .advance(out_ready), .keep, .extend, .seek, .left, .last(last_row),
        .load_value(in_triangle.depth), .step_x({depth_step_x[28:0], 3'b000}), .step_y(depth_step_y),
        .current(depth), .next(next_depth)
    );

    // Light does not affect the next move, so its accumulators make the same moves one clock later.
    if (SMOOTH) begin : light
        logic [PLANES_BITS-1:0] planes;
        logic                   was_keep, was_extend, was_seek, was_left, was_last;

        always_ff @(posedge clk) begin
            if (out_ready) begin
                {was_keep, was_extend, was_seek, was_left, was_last} <= {keep, extend, seek, left, last_row};
                if (leave) planes <= in_planes;
                out_light[192] <= planes[288];
            end
        end

        for (genvar k = 0; k < 3; k++) begin : channels
            triangle_pkg::plane_t plane;
            logic [31:0]          next_value;

            assign plane = planes[96 * k +: 96];

            stepper #(.WIDTH(32), .LOW(16)) light_stepper (
                .clk, .advance(out_ready), .keep(was_keep), .extend(was_extend), .seek(was_seek), .left(was_left), .last(was_last),
                .load_value(plane.start), .step_x({plane.step_x[28:0], 3'b000}), .step_y(plane.step_y),
                .current(out_light[64 * k +: 32]), .next(next_value)
            );

            always_ff @(posedge clk) if (out_ready) out_light[64 * k + 32 +: 32] <= plane.step_x;

            wire _unused = &{1'b0, next_value};
        end
    end else begin : flat
        assign out_light = '0;

        wire _unused = &{1'b0, in_planes};
    end

    stepper #(.WIDTH(8), .LOW(4)) group_stepper (
        .clk, .advance(out_ready), .keep, .extend, .seek, .left, .last(last_row),
        .load_value(in_triangle.group_start), .step_x(8'd1), .step_y(8'd0),
        .current(group), .next(next_group)
    );

    logic at_left, at_right, seeks, fresh;

    assign at_left  = next_group == (leave ? in_triangle.group_left : group_left);
    assign at_right = next_group == (leave ? in_triangle.group_right : group_right);
    assign seeks    = !extend && !resume;
    assign fresh    = !extend && !seek;

    always_ff @(posedge clk) begin
        if (out_ready) begin
            seek_left    <= seeks && (fresh || left) && !at_left;
            seek_right   <= seeks && (fresh || !left) && !at_right;
            extend_left  <= (seeks || left) && !at_left;
            extend_right <= (seeks || !left) && !at_right;
            resume       <= extend && left && (resume || open_right && extend_right);

            if (fresh && !last_row) begin
                line       <= line + 1'b1;
                rows_below <= rows_below - 1'b1;
                last_row   <= rows_below == 6'd1;
            end

            if (leave) begin
                active       <= in_valid;
                step_x       <= in_triangle.step_x;
                step_y       <= in_triangle.step_y;
                depth_step_x <= in_triangle.depth_step_x;
                depth_step_y <= in_triangle.depth_step_y;
                slope        <= in_triangle.slope;
                rises        <= in_triangle.rises;
                falls        <= in_triangle.falls;
                group_left   <= in_triangle.group_left;
                group_right  <= in_triangle.group_right;
                colour       <= in_triangle.colour;
                line         <= in_triangle.line;
                rows_below   <= in_triangle.rows - 1'b1;
                last_row     <= !in_valid || in_triangle.rows == 6'd1;
            end
            // Without a next triangle the walker stays idle, ready to load one.
            if (leave && !in_valid) begin
                seek_left    <= 1'b0;
                seek_right   <= 1'b0;
                extend_left  <= 1'b0;
                extend_right <= 1'b0;
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

    assign out_valid              = active && !fails;
    assign out_group.line         = line;
    assign out_group.group        = group;
    assign out_group.slope        = slope;
    assign out_group.rises        = rises;
    assign out_group.depth        = depth;
    assign out_group.depth_step_x = depth_step_x;
    assign out_group.colour       = colour;

    for (genvar k = 0; k < 3; k++) begin : values
        assign out_group.best[k] = best[k][32:0];
    end

    wire _unused = &{1'b0, next_depth};
endmodule

`default_nettype wire

// Proof that the walker visits the correct groups (eight neighbouring pixels of a line) of each triangle, with any edge functions
// and any pattern of valid and ready on both sides. The colour of a triangle is its number; its bounds are up to three groups
// wide and two lines high.
//
// Groups are output in the order of the accepted triangles, each at most once, within the lines and bounds of their triangle. If no edge
// fails anywhere, every group within the bounds is output. The walk over each triangle ends within a fixed number of clocks.

`default_nettype none

module walker_proof (
    input wire       clk,
    input wire       in_valid,
    input wire       in_two,     // high if the triangle has two lines, low if it has one line
    input wire [1:0] in_left,
    input wire [1:0] in_right,
    input wire [1:0] in_start,
    input wire [2:0] in_rises,
    input wire [2:0] in_falls,
    input wire       out_ready
);
    localparam int unsigned BITS = 3;

    // When `solid` is 1, no edge of any triangle fails in any group.
    (* anyconst *) logic solid;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic                     idle, walking, in_ready, out_valid, taken;
    raster_pkg::placed_t      placed;
    raster_pkg::placed_late_t placed_late;
    raster_pkg::candidate_t   group;
    raster_pkg::late_t        late;

    // A group's line and colour are valid one clock after the group, so groups are checked one clock late: `was_*` and `goes` are values of
    // the previous clock.
    logic       was_taken = 1'b0, was_idle = 1'b0, was_two, goes = 1'b0;
    logic [3:0] was_columns;
    logic [7:0] was_group;

    // The current triangle: its number, its groups (bit 4·line + column) in `bounds`, and its groups that have been output, in `gone`.
    logic [BITS-1:0] came = '0, was_came = '0, number;
    logic            some = 1'b0;
    logic [7:0]      bounds, gone, group_bit;
    logic [3:0]      columns;
    logic [4:0]      walked = '0;

    always_comb begin
        placed             = '0;
        placed.rows        = in_two ? 6'd2 : 6'd1;
        placed.group_left  = 8'(in_left);
        placed.group_right = 8'(in_right);
        placed.group_start = 8'(in_start);
        placed.rises       = in_rises;
        placed.falls       = in_falls;
        placed_late        = '0;
        placed_late.colour = 16'(was_came);
        for (int i = 0; i < 4; i++) columns[i] = 2'(i) >= in_left && 2'(i) <= in_right;
    end

    walker dut (
        .clk, .rst, .idle, .walking, .in_valid, .in_ready, .in_triangle(placed), .in_late(placed_late), .out_valid, .out_ready,
        .out_group(group), .out_late(late)
    );

    stream_checker #(.WIDTH(13), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data({in_two, in_left, in_right, in_start, in_rises, in_falls})
    );
    stream_checker #(.WIDTH(8 + 33)) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data({group.group, group.best[0]})
    );

    assign taken     = in_valid && in_ready;
    assign group_bit = 8'd1 << {late.line[0], was_group[1:0]};

    always_ff @(posedge clk) if (!rst) begin
        {was_taken, was_idle, was_two, was_columns, was_group, was_came} <= {taken, idle, in_two, columns, group.group, came};
        goes <= out_valid && out_ready;

        if (taken) begin
            came   <= came + 1'b1;
            walked <= '0;
        end else if (walking) begin
            walked <= walked + 1'b1;
        end
        if (was_taken) begin
            number <= was_came;
            some   <= 1'b1;
            bounds <= {was_two ? was_columns : 4'd0, was_columns};
            gone   <= '0;
        end else if (goes) begin
            gone <= gone | group_bit;
        end

        assume (came != '1);
        assume (in_left <= in_right && in_left <= in_start && in_start <= in_right && in_right - in_left <= 2'd2);
        assume ((in_rises & in_falls) == '0);
        if (solid) begin
            assume (in_rises == '0 && in_falls == '0);
            assume (!walking || out_valid);
        end

        if (goes) begin
            nothing_made_up: assert (some && late.colour == 16'(number));
            within_bounds:   assert (late.line[5:1] == '0 && was_group[7:2] == '0 && (group_bit & bounds) != '0);
            none_twice:      assert ((group_bit & gone) == '0);
        end
        // In a line of three groups, the walker may visit two groups in which an edge fails before it finds the line's first group, and
        // may visit these two again afterwards.
        left_in_time:  assert (!walking || walked < 5'd10);
        none_left_out: assert (!solid || !some || !(was_taken || was_idle) || (gone | (goes ? group_bit : '0)) == bounds);
        busy_while_it_walks: assert (idle || came != '0);

        three_walked: cover (came == BITS'(3) && idle && gone == 8'h77);
    end
endmodule

`default_nettype wire

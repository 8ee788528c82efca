// Proof of `lanes`, which determines the pixels (lanes) of a group of eight that a triangle covers, for any pattern of valid and ready on
// both sides. A FIFO at the output of `lanes` signals to the source whether it has free entries. Groups are numbered, and either all
// or none of their pixels are covered. Each group with covered pixels is output once, in order, with all its fields; a group without
// covered pixels is never output. A group becomes valid at the output even if the consumer is not ready.

`default_nettype none

module lanes_proof (
    input wire clk,
    input wire in_valid,
    input wire in_kept,
    input wire out_ready
);
    localparam int unsigned BITS = 4;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    typedef struct packed {
        logic [10:0]      row;
        logic [5:0]       line;
        logic [7:0]       column;
        logic [7:0]       mask;
        logic [7:0][17:0] codes;
        logic [15:0]      colour;
    } group_t;

    logic                   lanes_idle, fifo_idle, room, made_valid, out_valid, right;
    group_t                 made, group;
    raster_pkg::candidate_t candidate;
    raster_pkg::late_t      late;
    logic [BITS-1:0]        kept = '0, went = '0, number, was_number;
    logic [3:0]             unseen = '0, refused = '0;

    // Groups without covered pixels have the number `'1`, which must never reach the output. One edge of such a group passes only in lane
    // 7, and another edge only in lane 0, so there is no lane in which all edges pass.
    assign number = in_kept ? kept : '1;

    always_comb begin
        candidate        = '0;
        candidate.group  = {4'd0, number};
        for (int k = 0; k < 3; k++) begin
            candidate.best[k]  = {in_kept, 32'd0};
            candidate.slope[k] = 20'd1;
        end
        candidate.rises[0] = 1'b1;

        late        = '0;
        late.line   = 6'd2;
        late.depth  = {14'd1, was_number, 14'd0};
        late.colour = {12'd1, was_number};
    end

    lanes dut (
        .clk, .rst, .stride(8'd40), .idle(lanes_idle), .in_valid(in_valid && room), .in_group(candidate), .in_late(late),
        .out_valid(made_valid), .out_row(made.row), .out_line(made.line), .out_column(made.column), .out_mask(made.mask),
        .out_codes(made.codes), .out_colour(made.colour)
    );
    pipeline_fifo #(.WIDTH($bits(made)), .DEPTH(8), .FLIGHT(5), .DIRECT(1'b1)) queue (
        .clk, .rst, .idle(fifo_idle), .room, .in_valid(made_valid), .in_data(made), .out_valid, .out_ready, .out_data(group)
    );

    stream_checker #(.WIDTH(1), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(room), .data(in_kept)
    );
    stream_checker #(.WIDTH($bits(group))) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data(group)
    );

    assign right = group == {11'd80 + 11'(went), 6'd2, {4'd0, went}, 8'hff, {8{14'd1, went}}, {12'd1, went}};

    always_ff @(posedge clk) if (!rst) begin
        if (in_valid && room && in_kept) kept <= kept + 1'b1;
        if (out_valid && out_ready)      went <= went + 1'b1;
        was_number <= number;
        unseen  <= kept != went && !out_valid ? unseen + 1'b1 : '0;
        refused <= in_valid && !room && out_ready ? refused + 1'b1 : '0;

        assume (kept != '1);
        nothing_made_up:  assert (!out_valid || kept != went);
        in_order:         assert (!out_valid || right);
        nothing_too_many: assert (kept - went <= BITS'(8));
        idle_when_empty:  assert (!(lanes_idle && fifo_idle) || kept == went);
        shown_in_time:    assert (unseen < 4'd7);
        taken_in_time:    assert (refused < 4'd11);

        eight_inside: cover (kept - went == BITS'(8) && !room);
    end
endmodule

`default_nettype wire

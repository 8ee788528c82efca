// Proof of `line_raster`, which draws pieces of lines one pixel per clock, for any pattern of valid and ready on both sides. Pieces are
// horizontal and have one or two pixels; their pixels are numbered by column and depth code.
// Each pixel of each piece is output once, in order, with all its fields, and no other pixel is output. A group becomes valid at the output
// even if the consumer is not ready, and the wait of a piece at the input is bounded.

`default_nettype none

module line_raster_proof (
    input wire        clk,
    input wire        in_valid,
    input wire        out_ready,
    input wire        up,
    input wire [20:0] fall
);
    localparam int unsigned BITS = 6;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    typedef struct packed {
        logic [10:0] row;
        logic [5:0]  line;
        logic [7:0]  column;
        logic [7:0]  mask;
        logic [17:0] code;
        logic [15:0] colour;
    } group_t;

    logic              in_ready, out_valid, idle, two, right;
    records_pkg::piece_t  piece;
    group_t            group, expected;
    logic [BITS-1:0]   came = '0, went = '0, first;
    logic [3:0]        unseen = '0, refused = '0;

    // If the number of a piece's first pixel is a multiple of 4, the piece has two pixels, otherwise one. The colour of a piece is the
    // number of its first pixel.
    assign two   = came[1:0] == '0;
    assign first = went[1:0] == 2'd1 ? went - 1'b1 : went;

    always_comb begin
        piece            = '0;
        piece.x_major    = 1'b1;
        piece.up         = up;
        piece.count      = two ? 12'd2 : 12'd1;
        piece.error      = '1;
        piece.fall       = fall;
        piece.row        = 10'd52;
        piece.column     = 11'(came);
        piece.depth      = {2'd0, 18'(came) + 18'd5, 14'd0};
        piece.depth_step = 34'd1 << 14;
        piece.colour     = 16'(came);

        expected.row    = 11'd280 + 11'(went[BITS-1:3]);
        expected.line   = 6'd7;
        expected.column = 8'(went[BITS-1:3]);
        expected.mask   = 8'd1 << went[2:0];
        expected.code   = 18'(went) + 18'd5;
        expected.colour = 16'(first);
    end

    line_raster dut (
        .clk, .rst, .size(2'd0), .first_row(10'd45), .idle, .in_valid, .in_ready, .in_piece(piece),
        .group_valid(out_valid), .group_ready(out_ready), .group_row(group.row), .group_line(group.line),
        .group_column(group.column), .group_mask(group.mask), .group_code(group.code), .group_colour(group.colour)
    );

    stream_checker #(.WIDTH(22), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data({up, fall})
    );
    stream_checker #(.WIDTH($bits(group))) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data(group)
    );

    assign right = group == expected;

    always_ff @(posedge clk) if (!rst) begin
        if (in_valid && in_ready)   came <= came + (two ? BITS'(2) : BITS'(1));
        if (out_valid && out_ready) went <= went + 1'b1;
        unseen  <= came != went && !out_valid ? unseen + 1'b1 : '0;
        refused <= in_valid && !in_ready && out_ready ? refused + 1'b1 : '0;

        nothing_made_up:  assert (!out_valid || came != went);
        in_order:         assert (!out_valid || right);
        nothing_too_many: assert (came - went <= BITS'(18));
        idle_when_empty:  assert (idle == (came == went));
        shown_in_time:    assert (unseen < 4'd6);
        taken_in_time:    assert (refused < 4'd9);

        many_inside: cover (came - went == BITS'(16) && !in_ready);
    end
endmodule

`default_nettype wire

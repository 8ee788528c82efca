// Proof of `line_setup`, which cuts segments into pieces, for any pattern of valid and ready on both sides. Segments are at most a few
// pixels long, and the multiplier returns arbitrary sums, so errors and depths are arbitrary. A piece belongs to the segment at the input,
// stays until it is taken, and is the segment's only piece in its band. A segment is taken once, within a limit on the number of clocks in
// which no piece waits. At most one state of the program is active at a time.

`default_nettype none

module line_setup_proof (
    input wire                     clk,
    input wire                     in_valid,
    input wire line_pkg::segment_t in_segment,
    input wire                     out_ready
);
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic             in_ready, out_valid, near, sent = 1'b0, ended = 1'b0;
    records_pkg::piece_t piece;
    logic [5:0]       waited = '0;

    line_setup dut (
        .clk, .rst, .size(2'd0), .bias(16'd3), .in_valid, .in_ready, .in_segment, .out_valid, .out_ready, .out_piece(piece)
    );

    stream_checker #(.WIDTH($bits(in_segment)), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data(in_segment)
    );
    stream_checker #(.WIDTH($bits(piece))) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data(piece)
    );

    // The coordinates are within the first two columns and rows; the first band has 45 rows.
    assign near = {in_segment.a_x[19:9], in_segment.a_y[19:9], in_segment.b_x[19:9], in_segment.b_y[19:9]} == '0;

    always_ff @(posedge clk) if (!rst) begin
        assume (near && in_segment.a_w == in_segment.b_w);

        // A segment takes at most 41 clocks: the clocks of the program, three for pixels, one for a piece, and three for further bands if
        // the line runs upward.
        waited <= in_valid && !in_ready ? waited + 6'(!out_valid || out_ready) : '0;
        sent   <= in_valid && !in_ready && (sent || out_valid && out_ready);
        ended  <= ended || in_ready;

        of_a_segment:   assert (!out_valid || in_valid && piece.colour == in_segment.colour);
        taken_if_given: assert (!in_ready || in_valid);
        one_in_a_band:  assert (!out_valid || !sent);
        within_picture: assert (!out_valid || piece.column < 11'd320 && piece.row < 10'd180);
        with_a_pixel:   assert (!out_valid || piece.count != '0 && piece.count <= 12'd4);
        taken_in_time:  assert (waited <= 6'd40);
        then_the_next:  assert (!out_valid || !in_ready);

        a_piece:      cover (out_valid && piece.up && piece.left);
        second_begun: cover (ended && in_valid && !in_ready && waited == 6'd1);
    end
endmodule

`default_nettype wire

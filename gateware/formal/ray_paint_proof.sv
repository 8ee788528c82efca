// Proof that ray_paint outputs a pixel for each end of a ray, for any pattern of valid and ready on both sides. Each pixel is output once,
// in order, at its position in the band, unchanged while it waits, and in time. Products are 0, and the tables are arbitrary. The column of
// an end is its number.

`default_nettype none

module ray_paint_proof (
    input wire clk,
    input wire in_valid,
    input wire out_ready
);
    localparam int unsigned BITS = 4;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic               in_ready, out_valid, eye, right;
    raymarch_pkg::end_t ending;
    logic [10:0]        row;
    logic [5:0]         line;
    logic [7:0]         column, mask;
    logic [17:0]        code;
    logic [15:0]        colour;
    logic [BITS-1:0]    came = '0, went = '0;
    logic [5:0]         unseen = '0, refused = '0;

    always_comb begin
        ending       = '0;
        ending.place = {1'b0, came[0], 6'd2, 11'(came)};
    end

    ray_paint #(.PLACES(2)) dut (
        .clk, .rst, .stereo(1'b0), .dither(1'b1), .first_line('0), .stride(8'd40), .depth_mantissa('0), .depth_exponent('0), .fog_shift('0),
        .palette('0), .horizon('0), .table_write(1'b0), .table_entry('0), .table_part('0),
        .in_valid, .in_ready, .in_end(ending), .in_colour('0),
        .out_valid, .out_ready, .out_eye(eye), .out_row(row), .out_line(line), .out_column(column), .out_mask(mask),
        .out_code(code), .out_colour(colour)
    );

    stream_checker #(.WIDTH(1), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data(1'b0)
    );
    stream_checker #(.WIDTH(69)) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data({1'b0, eye, row, line, column, mask, code, colour})
    );

    assign right = {eye, row, line, column, mask} == {went[0], 11'd80 + 11'(went[BITS-1:3]), 6'd2, 8'(went[BITS-1:3]), 8'd1 << went[2:0]};

    always_ff @(posedge clk) if (!rst) begin
        if (in_valid && in_ready)   came <= came + 1'b1;
        if (out_valid && out_ready) went <= went + 1'b1;
        unseen  <= came != went && !out_valid ? unseen + 1'b1 : '0;
        refused <= in_valid && !in_ready && out_ready ? refused + 1'b1 : '0;

        assume (came != '1);
        nothing_made_up:  assert (!out_valid || came != went);
        in_order:         assert (!out_valid || right);
        nothing_too_many: assert (came - went <= BITS'(3));
        shown_in_time:    assert (unseen < 6'd37);
        taken_in_time:    assert (refused < 6'd40);

        three_inside: cover (came - went == BITS'(3) && out_valid && !out_ready);
        all_came:     cover (went == BITS'(3) && came == went);
    end
endmodule

`default_nettype wire

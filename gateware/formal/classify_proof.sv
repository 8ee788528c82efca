// Proof that `classify` outputs each triangle once, as a regular triangle, as an exception or as a dropped triangle, in order, with its
// own fields and number. A triangle at the input waits for at most 3 clocks, not counting clocks in which a triangle waits at an output
// for its consumer.

`default_nettype none

module classify_proof #(
    localparam int unsigned BITS = 4
) (
    input wire              clk,
    input wire  [10:0]      width,
    input wire  [9:0]       height,
    input wire              in_valid,
    input wire  [2:0][67:0] in_vertices,
    input wire              regular_ready,
    input wire              exception_ready
);
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic             idle, unseen, in_ready, regular_valid, exception_valid, held_up, leaves;
    logic [31:0]      count, exception_number;
    logic [2:0][65:0] regular_vertices;
    logic [BITS-1:0]  came = '0, went = '0, regular_side;
    logic [2:0]       waited = '0;

    classify #(.SIDE_BITS(BITS)) dut (
        .clk, .rst, .restart(rst), .width, .height, .idle, .unseen, .count, .in_valid, .in_ready, .in_vertices, .in_side(came),
        .regular_valid, .regular_ready, .regular_vertices, .regular_side, .exception_valid, .exception_ready, .exception_number
    );

    stream_checker #(.WIDTH(1), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data(1'b0)
    );
    // Checking one coordinate is enough: the module loads all fields of a triangle at once.
    stream_checker #(.WIDTH(21)) regular (
        .clk, .rst, .valid(regular_valid), .ready(regular_ready), .data(regular_vertices[0][20:0])
    );
    stream_checker #(.WIDTH(32)) exception (
        .clk, .rst, .valid(exception_valid), .ready(exception_ready), .data(exception_number)
    );

    assign leaves  = unseen || regular_valid && regular_ready || exception_valid && exception_ready;
    assign held_up = regular_valid && !regular_ready || exception_valid && !exception_ready;

    always_ff @(posedge clk) if (!rst) begin
        if (in_valid && in_ready) came <= came + 1'b1;
        if (leaves)               went <= went + 1'b1;
        waited <= in_valid && !in_ready ? waited + 3'(!held_up) : '0;

        leaves_one_way:   assert ({1'b0, unseen} + {1'b0, regular_valid} + {1'b0, exception_valid} <= 2'd1);
        nothing_made_up:  assert (came != went || !unseen && !regular_valid && !exception_valid);
        in_order:         assert ((!regular_valid || regular_side == went) && (!exception_valid || exception_number[BITS-1:0] == went));
        counted:          assert (count[BITS-1:0] == went);
        idle_while_empty: assert (idle == (came == went));
        taken_in_time:    assert (waited <= 3'd3);

        all_ways: cover (went == BITS'(3) && regular_valid && !regular_ready);
        dropped:  cover (unseen && went == BITS'(2));
    end
endmodule

`default_nettype wire

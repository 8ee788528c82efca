// Proof of the control logic of the stage `cull`, with a FIFO of 8 entries at its output, for any triangles in any order. Each triangle
// leaves once, culled or drawn, and the FIFO does not overflow. A triangle at the input waits for at most 12 clocks, and while triangles
// are inside, a triangle leaves within 21 clocks. Clocks in which a triangle waits at the output for the consumer are not counted.

`default_nettype none

module cull_proof (
    input wire              clk,
    input wire  [10:0]      width,
    input wire  [9:0]       height,
    input wire              cull_back,
    input wire              mirror,
    input wire              in_valid,
    input wire  [2:0][65:0] in_vertices,
    input wire  [15:0]      in_colour,
    input wire  [2:0][15:0] in_normal,
    input wire              out_ready
);
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic                 busy, culled, in_ready, out_valid, held_up, leaves;
    setup_pkg::oriented_t out_triangle;

    cull #(.PLACES(8)) dut (
        .clk, .rst, .width, .height, .cull_back, .mirror, .busy, .culled,
        .in_valid, .in_ready, .in_vertices, .in_colour, .in_normal, .out_valid, .out_ready, .out_triangle
    );

    stream_checker #(.WIDTH(16), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data(in_colour)
    );
    // Checking the colour is enough: the stage loads all fields of a triangle at once.
    stream_checker #(.WIDTH(16)) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data(out_triangle.colour)
    );

    logic [3:0] inside = '0;
    logic [4:0] waited = '0, stood = '0;
    logic       culled_before = 1'b0;

    assign held_up = out_valid && !out_ready;
    assign leaves  = culled || out_valid && out_ready;

    always_ff @(posedge clk) if (!rst) begin
        inside <= inside + 4'(in_valid && in_ready) - 4'(culled) - 4'(out_valid && out_ready);

        if (in_valid && !in_ready) waited <= waited + 5'(!held_up);
        else                       waited <= '0;

        if (leaves || inside == '0) stood <= '0;
        else if (!held_up)          stood <= stood + 1'b1;

        if (culled) culled_before <= 1'b1;

        taken_in_time:     assert (waited <= 5'd12);
        leaves_in_time:    assert (stood <= 5'd21);
        nothing_too_many:  assert (inside <= 4'd7);
        nothing_made_up:   assert (!leaves || inside != '0);
        busy_while_inside: assert (busy == (inside != '0));

        drawn_after_culled: cover (culled_before && out_valid && out_ready);
        culled_while_held:  cover (culled && held_up);
    end
endmodule

`default_nettype wire

// Proof of the control logic of `setup`, the triangle setup, with beats (the times of a triangle in a stage) of three clocks and any
// pattern of valid and ready on both sides. Each drawn triangle is output once, in order, with its own value in every field. Every wait of
// a triangle is bounded, even if no triangle follows. Exactly one of `culled` and `drawn` is high once for each triangle, and `busy` is
// high while triangles are inside.

`default_nettype none

module setup_proof #(
    // Upper bound on the clocks, without back-pressure, in which no triangle enters or leaves while a triangle is inside: five beats and
    // one clock.
    parameter int unsigned WITHIN = 16
) (
    input wire clk,
    input wire in_valid,
    input wire in_culled,
    input wire out_ready
);
    localparam int unsigned BITS = 4;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic            busy, culled, drawn, in_ready, out_valid, taken, goes, right;
    logic [BITS-1:0] kept = '0, made = '0, went = '0, dropping = '0, number;
    logic [4:0]      stood = '0;
    logic [3:0]      refused = '0;

    records_pkg::descriptor_t descriptor;

    // Culled triangles have the number `'1`, which must never reach the output.
    assign number = in_culled ? '1 : kept;

    setup #(.LAST(4'd2)) dut (
        .clk, .rst, .width(11'd320), .height(10'd180), .cull_back(1'b1), .mirror(1'b0), .row_light('0),
        .light_colour('0), .ambient('0), .busy, .culled, .drawn,
        .in_valid, .in_ready, .in_vertices('0), .in_colour({in_culled, 11'd0, number}), .in_normal('0),
        .out_valid, .out_ready, .out_descriptor(descriptor)
    );

    stream_checker #(.WIDTH(1), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data(in_culled)
    );
    // Checking the colour is enough: the module loads all fields of a triangle at once.
    stream_checker #(.WIDTH(16)) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data(descriptor.colour)
    );

    logic [20:0] x10, y01, x02, y20;

    assign x10 = {17'd1, went};
    assign y01 = {17'd2, went};
    assign x02 = {17'd3, went};
    assign y20 = {17'd4, went};
    assign right = descriptor.colour == {12'd1, went} && descriptor.top == {6'd2, went} && descriptor.bottom == {6'd3, went}
                && descriptor.group_left == {4'd4, went} && descriptor.group_right == {4'd5, went}
                && descriptor.group_start == {4'd6, went}
                && descriptor.depth_step_x == {28'd7, went} && descriptor.depth_step_y == {28'd8, went}
                && descriptor.depth_start == {28'd9, went}
                && descriptor.start[0] == 34'(x10) && descriptor.start[2] == 34'(x02)
                && descriptor.steps[0] == {x10, y01} && descriptor.steps[2] == {x02, y20}
                && descriptor.steps[1] == {-(x10 + x02), -(y01 + y20)};
    assign taken = in_valid && in_ready;
    assign goes  = out_valid && out_ready;

    always_ff @(posedge clk) if (!rst) begin
        if (taken && !in_culled) kept <= kept + 1'b1;
        if (drawn)               made <= made + 1'b1;
        if (goes)                went <= went + 1'b1;
        dropping <= dropping + BITS'(taken && in_culled) - BITS'(culled);

        if (taken || goes || kept == went) stood <= '0;
        else if (!out_valid)               stood <= stood + 1'b1;
        refused <= in_valid && !in_ready && !(out_valid && !out_ready) ? refused + 1'b1 : '0;

        assume (kept != '1);
        nothing_made_up:   assert (!out_valid || kept != went);
        in_order:          assert (!out_valid || right);
        counted:           assert (made + BITS'(drawn) == went + BITS'(out_valid) && dropping <= BITS'(1));
        busy_while_inside: assert (busy == (kept != went || dropping != '0));
        no_standstill:     assert (stood < 5'(WITHIN));
        taken_in_time:     assert (refused < 4'd5);

        filled:  cover (kept - went == BITS'(4) && out_valid);
        drained: cover (went == BITS'(1) && !busy);
    end
endmodule

`default_nettype wire

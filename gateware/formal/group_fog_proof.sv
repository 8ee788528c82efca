// Proof of the queues of `group_fog`, for groups with any masks, any gaps between them and any pattern of ready at the output. Groups are
// numbered, and have no fog. Each group is output once, in order, and each pixel of its mask keeps its colour, which is the group's number
// and the pixel's lane. Every wait of a group is bounded. To keep the proof short, the FIFOs are shorter than in the engine.

`default_nettype none

module group_fog_proof (
    input wire       clk,
    input wire       in_valid,
    input wire [7:0] in_mask,
    input wire       out_ready
);
    localparam int unsigned BITS = 4;
    // Upper bound on the clocks in which a group is inside and no group is at the output.
    localparam int unsigned WITHIN = 15;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic              in_ready, idle, out_valid, right;
    logic [BITS-1:0]   came = '0, went = '0, number;
    logic [4:0]        unseen = '0;
    logic [1:0]        refused = '0;
    logic [7:0]        out_mask;
    logic [7:0][15:0]  out_colours;
    logic [7:0][23:0]  in_colours;
    logic [7:0][17:0]  in_codes, out_codes;

    for (genvar lane = 0; lane < 8; lane++) begin : lanes
        assign in_colours[lane] = colour_pkg::fractions(16'({came, 3'(lane)}));
        assign in_codes[lane]   = 18'(came);
    end

    stream_checker #(.WIDTH(8), .GIVEN(1)) given (.clk, .rst, .valid(in_valid), .ready(in_ready), .data(in_mask));

    group_fog #(.BESIDE_BITS(BITS), .GROUPS(4)) dut (
        .clk, .rst, .enable(1'b0), .dither(1'b1), .fog('0), .first_line('0), .idle,
        .in_valid, .in_ready, .in_beside(came), .in_line('0), .in_mask, .in_codes, .in_colours, .in_added(1'b0),
        .out_valid, .out_ready, .out_beside(number), .out_mask, .out_codes, .out_colours
    );

    stream_checker #(.WIDTH(BITS + 8 + 8 * 16)) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data({number, out_mask, out_colours})
    );

    always_comb begin
        right = number == went && out_codes == {8{18'(went)}};
        for (int i = 0; i < 8; i++) if (out_mask[i]) right = right && out_colours[i] == 16'({went, 3'(i)});
    end

    always_ff @(posedge clk) if (!rst) begin
        came    <= came + BITS'(in_valid && in_ready);
        went    <= went + BITS'(out_valid && out_ready);
        unseen  <= came != went && !out_valid ? unseen + 1'b1 : '0;
        refused <= in_valid && !in_ready && came == went ? refused + 1'b1 : '0;

        assume (in_mask != '0);
        nothing_made_up:  assert (!out_valid || came != went);
        in_order:         assert (!out_valid || right);
        idle_when_empty:  assert (idle == (came == went));
        shown_in_time:    assert (unseen < 5'(WITHIN));
        taken_in_time:    assert (refused < 2'd2);

        filled:  cover (came - went == BITS'(4));
        passed:  cover (went == BITS'(3) && out_valid && out_mask == 8'h81);
    end
endmodule

`default_nettype wire

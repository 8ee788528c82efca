// Proof of the queues of `smooth_shader`, for groups of flat and smooth triangles in any order, with any gaps between them and any
// pattern of ready at the output. Groups are numbered; a group without a covered pixel is dropped on its way to the module. Each other
// group is output once, in order. The colour of each covered pixel is the group's number if the group is flat, and the group's number and
// the pixel's lane otherwise. Every wait of a group is bounded. To keep the proof short, the FIFOs and the latency of a colour are shorter
// than in the engine, and a group covers only pixels of its left half or only of its right half.

`default_nettype none

module smooth_shader_proof (
    input wire       clk,
    input wire       in_valid,
    input wire       in_smooth,
    input wire [7:0] in_mask,
    input wire       out_ready
);
    localparam int unsigned BITS = 4;
    // Upper bound on the clocks in which a group is inside and no group is at the output. The bound is the latency of a smooth group with
    // four pixels.
    localparam int unsigned WITHIN = 13;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    typedef struct packed {
        logic            smooth;
        logic [7:0]      mask;
        logic [BITS-1:0] number;
    } group_t;

    group_t            made, came, group;
    logic              idle, room, sent, comes, out_valid, goes, right;
    logic [BITS-1:0]   kept = '0, arrived = '0, went = '0;
    logic [3:0]        unseen = '0;
    logic [1:0]        refused = '0;
    logic [7:0][15:0]  colours;

    assign made = {in_smooth, in_mask, kept};
    assign sent = in_valid && room && in_mask != '0;
    assign goes = out_valid && out_ready;

    always_ff @(posedge clk) begin
        comes <= sent && !rst;
        came  <= made;
    end

    smooth_shader #(.GROUP_BITS($bits(group)), .FLIGHT(1), .GROUPS(4), .LATENCY(2)) dut (
        .clk, .rst, .dither(1'b1), .idle, .room, .in_valid(comes), .in_group(came), .in_mask(came.mask), .in_line('0), .in_colour(16'(came.number)),
        .in_smooth(came.smooth), .in_depth('0), .in_depth_step_x('0), .in_light({64'd0, 32'({came.number, 3'd0})}),
        .in_light_step_x({64'd0, 32'd1}), .out_valid, .out_ready, .out_group(group), .out_colours(colours)
    );

    stream_checker #(.WIDTH($bits(group) + $bits(colours))) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data({group, colours})
    );

    always_comb begin
        right = group.number == went;
        for (int i = 0; i < 8; i++)
            if (group.mask[i]) right = right && colours[i] == (group.smooth ? 16'({went, 3'(i)}) : 16'(went));
    end

    always_ff @(posedge clk) if (!rst) begin
        kept    <= kept + BITS'(sent);
        arrived <= arrived + BITS'(comes);
        went    <= went + BITS'(goes);
        unseen  <= arrived != went && !out_valid ? unseen + 1'b1 : '0;
        refused <= !room && kept == went ? refused + 1'b1 : '0;

        assume (in_mask[7:4] == '0 || in_mask[3:0] == '0);
        nothing_made_up:  assert (!out_valid || arrived != went);
        in_order:         assert (!out_valid || right);
        idle_when_empty:  assert (idle == (arrived == went));
        shown_in_time:    assert (unseen < 4'(WITHIN));
        taken_in_time:    assert (refused < 2'd3);

        filled:  cover (arrived - went == BITS'(4));
        shaded:  cover (goes && group.smooth && group.mask == 8'h90);
    end
endmodule

`default_nettype wire

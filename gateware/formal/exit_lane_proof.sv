// Proof of exit_lane, a lane of the raymarcher by exits, with an output FIFO for the ends of two rays, for any rays, exits and
// back-pressure.
//
// The proof tracks one arbitrary ray. The column of a ray, which does not affect the results of a lane, is its number. The solid is
// arbitrary, but a ray takes at most two rounds (evaluations). Each ray enters with a limit, a start and a tag. They appear unchanged in
// the ray's end if all memories of the ring are read with the correct slot: the limit as T of a miss and as the sphere, the start as T of a
// hit in the first round, and the tag as the outcome of the second round.

`default_nettype none

module exit_lane_proof (
    input wire       clk,
    input wire       in_valid,
    input wire       in_over,
    input wire       in_tag,
    input wire [2:0] in_start,
    input wire [2:0] in_limit,
    input wire       out_ready
);
    // PLACES: capacity of the lane's FIFO of results (`out_end`). WITHIN: upper bound on the clocks from the entry of a ray until its
    // result is taken, while the consumer is ready: two rounds of 23 clocks, then the wait in the FIFO behind the result of the other
    // ray in the lane. A ray without an evaluation takes one round.
    localparam int unsigned PLACES = 2, WITHIN = 50, ROUND = 23;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic           in_ready, out_valid, evaluates, waits;
    exit_pkg::ray_t ray;
    exit_pkg::end_t out_end;
    logic [3:0]     came, inside;
    (* anyconst *) logic [3:0] followed;
    (* anyconst *) logic [2:0] start, limit;
    (* anyconst *) logic       over, tag;

    // The column of a ray, the lowest bits of its place, is its number.
    always_comb begin
        ray = '0;
        ray.place      = exit_pkg::PLACE_BITS'(came);
        ray.over       = in_over;
        ray.start      = exit_pkg::T_BITS'(in_start);
        ray.sphere     = {in_tag, in_limit, exit_pkg::T_BITS'(in_limit)};
        ray.reached[0] = {8'd0, in_tag, 4'd0};
    end

    exit_lane #(.LEVELS(4), .STEREO(1'b0), .ROUND(1'b1), .PLACES(PLACES)) dut (
        .clk, .rst, .origins('0), .solid('0), .far_t('0), .in_valid, .in_ready, .in_ray(ray), .out_valid, .out_ready, .out_end, .evaluates,
        .waits
    );

    stream_checker #(.WIDTH(1), .GIVEN(1)) given (.clk, .rst, .valid(in_valid), .ready(in_ready), .data(1'b0));
    stream_checker #(.WIDTH(exit_pkg::END_BITS)) ends (.clk, .rst, .valid(out_valid), .ready(out_ready), .data(out_end));

    logic       entered, left, here;
    logic [5:0] on_its_way, refused;

    assign here = out_valid && out_end.place[3:0] == followed;

    always_ff @(posedge clk) begin
        if (in_valid && in_ready) begin
            came <= came + 1'b1;
            if (came == followed) entered <= 1'b1;
        end
        if (here && out_ready) left <= 1'b1;
        inside  <= inside + 4'(in_valid && in_ready) - 4'(out_valid && out_ready);
        if (entered && !left && out_ready) on_its_way <= on_its_way + 1'b1;
        refused <= in_ready || !out_ready || out_valid ? '0 : refused + 1'b1;
        if (rst) {came, entered, left, inside, on_its_way, refused} <= '0;
    end

    always_ff @(posedge clk) if (!rst) begin
        if (in_valid && came == followed) assume ({in_over, in_tag, in_start, in_limit} == {over, tag, start, limit});

        none_made_up:     assert (!out_valid || out_end.place[3:0] < came);
        none_twice:       assert (!here || entered && !left);
        limit_in_step:    assert (!here || out_end.hit || out_end.t[2:0] == limit);
        sphere_in_step:   assert (!here || {out_end.met, out_end.number} == {tag, limit});
        start_in_step:    assert (!here || !out_end.hit || out_end.steps != 8'd1 || out_end.t[2:0] == start);
        tag_in_step:      assert (!here || out_end.steps != 8'd2 || out_end.hit == tag);
        none_lost:        assert (left || on_its_way < 6'(over ? WITHIN - ROUND : WITHIN));
        no_more_than_fit: assert (inside <= 4'(PLACES));
        takes_again:      assert (refused < 6'(WITHIN));
        empty_takes:      assert (inside != '0 || in_ready);
        counts_steps:     assert (!here || (over ? out_end.steps == '0 && !out_end.hit : out_end.steps == 8'd1 || out_end.steps == 8'd2));
        two_rounds:       cover (left && out_end.steps == 8'd2);
    end
endmodule

`default_nettype wire

// Proof of exit_shadow, which finds shadows on faces, for any ends, any lane of rays to the light, and any back-pressure.
//
// The proof tracks one arbitrary end. The column of an end is its number, and its height includes this number. The stand-in for the lane
// decides by the lowest bit of the height whether a ray to the light hits the solid.

`default_nettype none

module exit_shadow_proof (
    input wire       clk,
    input wire       in_valid,
    input wire       in_hit,
    input wire       in_round,
    input wire       in_positive,
    input wire       out_ready
);
    // WITHIN: upper bound on the clocks from the entry of an end that needs no ray until it is taken, while the consumer is ready and no ray to
    // the light ends.
    localparam int unsigned WITHIN = 4;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic           in_ready, out_valid, evaluates, waits;
    exit_pkg::end_t in_end, out_end;
    logic [3:0]     came;
    (* anyconst *) logic [3:0] followed;
    (* anyconst *) logic       hit, round, positive;

    raymarch_registers_pkg::shadow_t shadow;

    // The light is above: only hits on faces with a positive normal need a ray to the light.
    always_comb begin
        in_end          = '0;
        in_end.place    = exit_pkg::PLACE_BITS'(came);
        in_end.height   = {4'd0, came};
        in_end.hit      = in_hit;
        in_end.round    = in_round;
        in_end.positive = in_positive;

        shadow        = '0;
        shadow.enable = 1'b1;
    end

    exit_shadow #(.KEPT_BITS(exit_pkg::ROUND_END_BITS)) dut (
        .clk, .rst, .solid('0), .shadow, .in_valid, .in_ready, .in_end, .out_valid, .out_ready, .out_end, .evaluates, .waits
    );

    stream_checker #(.WIDTH(3), .GIVEN(1)) given (.clk, .rst, .valid(in_valid), .ready(in_ready), .data({in_hit, in_round, in_positive}));
    stream_checker #(.WIDTH(exit_pkg::ROUND_END_BITS)) ends (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data(out_end[exit_pkg::ROUND_END_BITS-1:0])
    );

    logic       entered, left, here, wants;
    logic [2:0] on_its_way;

    assign here  = out_valid && out_end.place[3:0] == followed;
    assign wants = hit && !round && positive;

    always_ff @(posedge clk) begin
        if (in_valid && in_ready) begin
            came <= came + 1'b1;
            if (came == followed) entered <= 1'b1;
        end
        if (here && out_ready) left <= 1'b1;
        if (out_valid && !here || !entered) on_its_way <= '0;
        else if (out_ready && !left) on_its_way <= on_its_way + 1'b1;
        if (rst) {came, entered, left, on_its_way} <= '0;
    end

    always_ff @(posedge clk) if (!rst) begin
        if (in_valid && came == followed) assume ({in_hit, in_round, in_positive} == {hit, round, positive});
        assume (came != '1);

        none_made_up: assert (!out_valid || out_end.place[3:0] < came);
        none_twice:   assert (!here || entered && !left);
        none_changed: assert (!here || {out_end.hit, out_end.round, out_end.positive} == {hit, round, positive});
        in_the_shade: assert (!here || out_end.height == (!hit ? {4'd0, followed} : {7'd0, wants && followed[0]}));
        none_lost:    assert (wants || on_its_way < 3'(WITHIN));
        both_ways:    cover (left && wants);
    end
endmodule

`default_nettype wire

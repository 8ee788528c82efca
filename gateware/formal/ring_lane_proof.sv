// Proof of ring_lane, a lane of the raymarcher, with an output FIFO for the ends of two rays, for any rays, fields and back-pressure.
//
// The proof tracks one arbitrary ray. The column of a ray, which does not affect the results of a lane, is its number. The field returns
// any distance after one clock, so a ray takes any number of rounds (evaluations of the field) up to the limit `cap`, here two.

`default_nettype none

module ring_lane_proof (
    input wire       clk,
    input wire       in_valid,
    input wire [7:0] in_height,
    input wire       out_ready
);
    // PLACES: capacity of the lane's FIFO of ends. WITHIN: upper bound on the clocks from the entry of a ray until its end is taken, while
    // the consumer is ready: two rounds of 11 clocks, then the wait in the FIFO behind the end of the other ray.
    localparam int unsigned PLACES = 2, WITHIN = 26;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic             in_ready, out_valid, evaluates, waits;
    raymarch_pkg::ray_t  ray;
    raymarch_pkg::end_t  out_end;
    logic [10:0]      came, inside;
    (* anyconst *) logic [10:0] followed;
    (* anyconst *) logic [7:0]  height;

    // The column of a ray is its number.
    always_comb begin
        ray = '0;
        ray.place.column = came;
        ray.height       = in_height;
    end

    ring_lane #(.LEVELS(0), .STEREO(1'b0), .FIELD_CLOCKS(2), .PLACES(PLACES)) dut (
        .clk, .rst, .origins('0), .bounds('0), .solid('0), .tuning({16'd1, 4'd7, 10'd2}),
        .sphere_write(1'b0), .sphere_number('0), .sphere('0), .in_valid, .in_ready, .in_ray(ray), .out_valid, .out_ready, .out_end, .evaluates, .waits
    );

    stream_checker #(.WIDTH(1), .GIVEN(1)) given (.clk, .rst, .valid(in_valid), .ready(in_ready), .data(1'b0));
    stream_checker #(.WIDTH(raymarch_pkg::END_BITS)) ends (.clk, .rst, .valid(out_valid), .ready(out_ready), .data(out_end));

    logic       entered, left, here;
    logic [4:0] on_its_way, refused;

    assign here = out_valid && out_end.place.column == followed;

    always_ff @(posedge clk) begin
        if (in_valid && in_ready) begin
            came <= came + 1'b1;
            if (came == followed) entered <= 1'b1;
        end
        if (here && out_ready) left <= 1'b1;
        inside  <= inside + 11'(in_valid && in_ready) - 11'(out_valid && out_ready);
        if (entered && !left && out_ready) on_its_way <= on_its_way + 1'b1;
        refused <= in_ready || !out_ready || out_valid ? '0 : refused + 1'b1;
        if (rst) {came, entered, left, inside, on_its_way, refused} <= '0;
    end

    always_ff @(posedge clk) if (!rst) begin
        if (in_valid && came == followed) assume (in_height == height);

        none_made_up:     assert (!out_valid || out_end.place.column < came);
        none_twice:       assert (!here || entered && !left);
        as_it_came:       assert (!here || out_end.state != raymarch_pkg::MISS || out_end.t[7:0] == height);
        none_lost:        assert (left || on_its_way < 5'(WITHIN));
        no_more_than_fit: assert (inside <= 11'(PLACES));
        takes_again:      assert (refused < 5'(WITHIN));
        empty_takes:      assert (inside != '0 || in_ready);
        counts_steps:     assert (!out_valid || out_end.steps == 8'd1 || out_end.steps == 8'd2);
        two_rounds:       cover (left && out_end.steps == 8'd2);
    end
endmodule

`default_nettype wire

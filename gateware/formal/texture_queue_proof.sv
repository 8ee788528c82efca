// Proof of the queue of texture steps, for steps with any misses, at any distance, and words of memory at any time. Steps are numbered.
// Each step is read once, in order, with its own fields and places. Each block that the step missed is filled with two words after the
// previous step is read and before this step is read, so no block is replaced before all earlier steps have read it. A step leaves only
// while `out_room` is high, or after its blocks have been filled. Every wait is bounded. To keep the proof short, the queue holds fewer
// steps than in the sampler.

`default_nettype none

module texture_queue_proof (
    input wire       clk,
    input wire       in_valid,
    input wire [3:0] in_missed,
    input wire       data_valid,
    input wire       out_room
);
    localparam int unsigned BITS = 3;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic                 idle, room, sent, data_ready, fills, fill_second, reads, in_time;
    logic [1:0]           fill_class;
    texture_pkg::step_t   step, head;
    logic [3:0][6:0]      head_places;
    logic [BITS-1:0]      kept = '0, arrived = '0, went = '0;
    logic [2:0]           sends = '0;
    logic [2:0][BITS-1:0] numbers;
    logic [3:0]           missed [0:2**BITS-1];
    // For the step at the head of the queue: the classes whose blocks are filled, and whether a block is half filled.
    logic [3:0]           done = '0, left, lowest;
    logic                 half = 1'b0;
    logic [1:0]           waits = '0, refused = '0;
    // Whether a step was allowed to leave in the previous clock.
    logic                 may = 1'b0;

    assign sent = in_valid && room && !rst;

    always_comb begin
        step         = '0;
        step.weights = 16'(kept);
    end

    texture_queue #(.STEPS(4)) dut (
        .clk, .rst, .idle, .room, .step_valid(sent), .in_step(step), .places_valid(sends[1]), .in_places(28'(numbers[1])),
        .missed_valid(sends[2]), .in_missed(missed[numbers[2]]), .data_valid, .data_ready, .fills, .fill_class, .fill_second, .out_room,
        .reads, .head_step(head), .head_places
    );

    assign left    = missed[went] & ~done;
    assign lowest  = left & ~(left - 4'd1);
    assign in_time = head.weights == 16'(went) && head_places == 28'(went);

    always_ff @(posedge clk) if (!rst) begin
        if (sent) missed[kept] <= in_missed;
        sends   <= {sends[1:0], sent};
        numbers <= {numbers[1:0], kept};
        kept    <= kept + BITS'(sent);
        arrived <= arrived + BITS'(sends[2]);
        went    <= went + BITS'(reads);
        half    <= half ^ fills;
        if (fills && half) done <= done | lowest;
        if (reads) done <= '0;
        waits   <= arrived != went && !reads && !data_ready && out_room ? waits + 1'b1 : '0;
        may     <= data_ready || out_room;
        refused <= !room && kept == went ? refused + 1'b1 : '0;

        nothing_made_up: assert (!(fills || reads) || arrived != went);
        in_order:        assert (!(fills || reads) || in_time);
        word_taken:      assert (fills == (data_ready && data_valid));
        missed_filled:   assert (!fills || left != '0 && lowest == 4'd1 << fill_class && fill_second == half);
        read_complete:   assert (!reads || left == '0 && !half && !fills);
        idle_when_empty: assert (idle == (kept == went));
        never_too_full:  assert (kept - went <= BITS'(4));
        waits_for_room:  assert (!reads || may);
        goes_in_time:    assert (waits < 2'd2);
        taken_in_time:   assert (refused < 2'd2);

        filled:   cover (kept - went == BITS'(4));
        all_four: cover (reads && missed[went] == '1);
        at_once:  cover (reads && sends == '1 && went == BITS'(2));
    end
endmodule

`default_nettype wire

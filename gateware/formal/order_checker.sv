// Checks that a buffer outputs its items in order, unchanged, each once, and in time.
//
// Items are numbered: the payload of item n is n, and the n-th output must be n. A buffer does not depend on its payload, so the proof
// holds for any payload, as long as no two items in the buffer have the same number. A buffer that contains an item must have a valid
// output within WITHIN clocks, and must accept an item within WITHIN clocks while its consumer is ready.

`default_nettype none

module order_checker #(
    parameter int unsigned WIDTH  = 8,
    parameter int unsigned PLACES = 2,
    parameter int unsigned WITHIN = 2
) (
    input wire             clk,
    input wire             rst,
    input wire             in_valid,
    input wire             in_ready,
    input wire [WIDTH-1:0] in_data,
    input wire             out_valid,
    input wire             out_ready,
    input wire [WIDTH-1:0] out_data
);
    logic [WIDTH-1:0] came, went, inside;
    localparam int unsigned CLOCK_BITS = $clog2(WITHIN + 1);

    logic [CLOCK_BITS-1:0] unseen, refused;

    assign inside = came - went;

    always_ff @(posedge clk) begin
        if (in_valid && in_ready)   came <= came + 1'b1;
        if (out_valid && out_ready) went <= went + 1'b1;
        unseen  <= came != went && !out_valid ? unseen + 1'b1 : '0;
        refused <= !in_ready && out_ready ? refused + 1'b1 : '0;

        if (rst) begin
            came    <= '0;
            went    <= '0;
            unseen  <= '0;
            refused <= '0;
        end
    end

    always_ff @(posedge clk) if (!rst) begin
        assume (in_data == came);
        nothing_made_up: assert (!out_valid || came != went);
        nothing_too_many: assert (inside <= WIDTH'(PLACES));
        in_order:        assert (!out_valid || out_data == went);
        shown_in_time:   assert (unseen < CLOCK_BITS'(WITHIN));
        taken_in_time:   assert (refused < CLOCK_BITS'(WITHIN));
        full:            cover (inside == WIDTH'(PLACES) && !in_ready);
        wrapped:         cover (went == WIDTH'(2 * PLACES) && came == went);
    end
endmodule

`default_nettype wire

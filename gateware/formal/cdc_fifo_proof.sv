// Proof of `cdc_fifo` with two clocks whose edges occur in any order and at any rate and may stop, and with any pattern of valid and ready.
// If a pointer changes while it crosses between the clocks, the received pointer has any subset of the changed bits. Items are numbered:
// each item is output once, unchanged and in order.

`default_nettype none

module cdc_fifo_proof (
    input wire in_clk,
    input wire out_clk,
    input wire in_valid,
    input wire out_ready
);
    localparam int unsigned DEPTH = 4;
    localparam int unsigned BITS  = 4;

    logic            in_ready, out_valid;
    logic [BITS-1:0] out_data, shown = '0;
    logic            waiting = 1'b0;
    logic [BITS-1:0] came = '0, went = '0, inside;
    // Number of output clocks since the FIFO became non-empty, and of input clocks since it became empty, at most 7.
    logic [2:0]      unseen = '0, refused = '0;

    cdc_fifo #(.WIDTH(BITS), .DEPTH(DEPTH)) dut (
        .in_clk, .in_valid, .in_ready, .in_data(came), .out_clk, .out_valid, .out_ready, .out_data
    );

    assign inside = came - went;

    always_ff @(posedge in_clk) begin
        if (in_valid && in_ready) came <= came + 1'b1;
        refused <= in_ready || inside != '0 ? '0 : refused + 3'(refused != '1);
    end

    always_ff @(posedge out_clk) begin
        if (out_valid && out_ready) went <= went + 1'b1;
        waiting <= out_valid && !out_ready;
        shown   <= out_data;
        unseen  <= out_valid || inside == '0 ? '0 : unseen + 3'(unseen != '1);
    end

    always_comb begin
        nothing_made_up:  assert (!out_valid || inside != '0);
        in_order:         assert (!out_valid || out_data == went);
        nothing_too_many: assert (inside <= BITS'(DEPTH + 1));
        valid_stays:      assert (!waiting || out_valid);
        payload_stable:   assert (!waiting || out_data == shown);
        shown_in_time:    assert (unseen < 3'd5);
        taken_in_time:    assert (refused < 3'd5);

        full:    cover (inside == BITS'(DEPTH + 1) && !in_ready);
        wrapped: cover (went == BITS'(2 * DEPTH) && inside == '0);
    end
endmodule

`default_nettype wire

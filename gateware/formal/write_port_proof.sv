// Proof of write_port, at a small size: FIFOs of four entries, and bursts of two words. Words arrive at any time, and memory takes commands
// and data at any time.
//
// The words are numbered: word n has address n and data n. The port does not depend on its payload, so the proof holds for
// any address and data. Memory takes the data of a command at any time, and ignores valid.

`default_nettype none

module write_port_proof (
    input wire clk,
    input wire hurry,
    input wire in_valid,
    input wire cmd_ready,
    input wire wdata_ready
);
    localparam int unsigned DEPTH = 4, NUMBER_BITS = 5;
    // Upper bound on the clocks without a transfer of data while memory takes all words: the time that a word takes through both FIFOs when
    // they are full.
    localparam int unsigned WITHIN = 8;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    // Numbers of received words, of words whose command was taken, and of words whose data were taken, in this clock and in the previous
    // clock.
    logic [NUMBER_BITS-1:0] came, commanded, went, went_before, cmd_addr;
    logic [127:0]           wdata;
    logic [15:0]            wdata_strobe;
    logic                   in_ready, cmd_valid, wdata_valid, idle;

    write_port #(.ADDRESS_BITS(NUMBER_BITS), .DEPTH(DEPTH), .BURST(2)) dut (
        .clk, .rst, .hurry, .idle, .in_valid, .in_ready, .in_addr(came), .in_data(128'(came)), .in_strobe(16'(~came)),
        .cmd_valid, .cmd_ready, .cmd_addr, .wdata_valid, .wdata_ready, .wdata, .wdata_strobe
    );

    stream_checker #(.WIDTH(1), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data(1'b0)
    );
    stream_checker #(.WIDTH(NUMBER_BITS)) commands (
        .clk, .rst, .valid(cmd_valid), .ready(cmd_ready), .data(cmd_addr)
    );

    // Numbers of successive clocks without a transfer of data, although memory takes all words: `unmoved` counts clocks in which the port
    // holds words and must not wait for a full burst (`hurry` is high), `refused` counts clocks in which the port accepts no word.
    logic [3:0] unmoved, refused;

    always_ff @(posedge clk) begin
        came      <= came + NUMBER_BITS'(in_valid && in_ready);
        commanded <= commanded + NUMBER_BITS'(cmd_valid && cmd_ready);
        went      <= went + NUMBER_BITS'(wdata_ready);
        went_before <= went;
        unmoved   <= idle || !hurry || !cmd_ready || commanded != went && !wdata_ready || wdata_ready ? '0 : unmoved + 1'b1;
        refused   <= in_ready || !cmd_ready || commanded != went && !wdata_ready || wdata_ready ? '0 : refused + 1'b1;
        if (rst) {came, commanded, went, went_before, unmoved, refused} <= '0;
    end

    always_ff @(posedge clk) if (!rst) begin
        assume (!wdata_ready || commanded != went);

        commands_in_order: assert (!cmd_valid || commanded != came && cmd_addr == commanded);
        data_in_order:     assert (!wdata_valid || wdata == 128'(went) && wdata_strobe == 16'(~went));
        data_at_command:   assert (commanded == went || wdata_valid);
        none_made_up:      assert (!wdata_valid || went != came);
        idle_is_empty:     assert (idle == (went_before == came));
        goes_in_a_hurry:   assert (unmoved < 4'(WITHIN));
        full_goes:         assert (refused < 4'(WITHIN));
        burst:             cover (went == NUMBER_BITS'(2 * DEPTH) && idle);
    end
endmodule

`default_nettype wire

// Checks the interface of read_port to one client: each address is sent as a command once, each word is returned once, both in the order of
// the addresses and in time.
//
// `delayed` is high in clocks in which the port waits for memory or for a client. Words that memory returns during a drop are discarded.

`default_nettype none

module read_client_checker #(
    parameter int unsigned CLIENT      = 0,
    parameter int unsigned DEPTH       = 2,
    parameter int unsigned NUMBER_BITS = 3
) (
    input  wire                   clk,
    input  wire                   rst,
    input  wire                   drop,
    input  wire                   dropped, // `drop` in the previous clock
    input  wire                   ask_valid,
    input  wire                   ask_ready,
    input  wire                   cmd_valid,
    input  wire                   cmd_ready,
    input  wire [NUMBER_BITS:0]   cmd_addr,
    input  wire                   rdata_valid,
    input  wire                   owner,
    input  wire                   data_valid,
    input  wire                   data_ready,
    input  wire [NUMBER_BITS:0]   data,
    input  wire                   delayed,
    input  wire                   idle,
    output logic [NUMBER_BITS-1:0] asked,
    output logic [NUMBER_BITS-1:0] answered
);
    // Upper bound on the clocks from the answer of memory until the word is valid at the client.
    localparam int unsigned SHOWN_WITHIN = 3;
    // Upper bound on the clocks until an address is taken while `delayed` is low: the clocks of a burst of the other client, the clocks
    // until half of this client's FIFO is empty, and the clocks of the arbitration.
    localparam int unsigned TAKEN_WITHIN = 11;

    // Number of commands that memory has taken, and of words that the client has taken.
    logic [NUMBER_BITS-1:0] commanded, went, inside;
    logic [3:0]             refused;
    logic [2:0]             unseen;
    logic                   commands, answers;

    assign commands = cmd_valid && cmd_addr[NUMBER_BITS] == CLIENT;
    assign answers  = rdata_valid && owner == CLIENT;
    assign inside   = asked - went;

    always_ff @(posedge clk) begin
        asked     <= asked + NUMBER_BITS'(ask_valid && ask_ready);
        commanded <= commanded + NUMBER_BITS'(commands && cmd_ready);
        answered  <= answered + NUMBER_BITS'(answers);
        went      <= drop ? answered + NUMBER_BITS'(answers) : went + NUMBER_BITS'(data_valid && data_ready);
        refused   <= drop || !ask_valid || ask_ready || delayed ? '0 : refused + 1'b1;
        unseen    <= drop || answered == went || data_valid ? '0 : unseen + 1'b1;

        if (rst) begin
            asked     <= '0;
            commanded <= '0;
            answered  <= '0;
            went      <= '0;
            refused   <= '0;
            unseen    <= '0;
        end
    end

    stream_checker #(.WIDTH(1), .GIVEN(1)) given (
        .clk, .rst(rst || drop), .valid(ask_valid), .ready(ask_ready), .data(1'b0)
    );
    stream_checker #(.WIDTH(NUMBER_BITS + 1)) words (
        .clk, .rst(rst || drop), .valid(data_valid), .ready(data_ready), .data
    );

    always_ff @(posedge clk) if (!rst) begin
        commands_in_order: assert (!commands || cmd_addr[NUMBER_BITS-1:0] == commanded && commanded != asked);
        words_in_order:    assert (!data_valid || dropped || data == {1'(CLIENT), went} && went != answered);
        none_after_drop:   assert (!data_valid || !dropped);
        places_suffice:    assert (inside <= NUMBER_BITS'(DEPTH) || dropped);
        shown_in_time:     assert (unseen < 3'(SHOWN_WITHIN));
        taken_in_time:     assert (refused < 4'(TAKEN_WITHIN));
        full:              cover (inside == NUMBER_BITS'(DEPTH) && answered == asked);
        wrapped:           cover (went == NUMBER_BITS'(DEPTH + 2) && idle);
        after_drop:        cover (dropped && !drop && went == NUMBER_BITS'(2));
    end
endmodule

`default_nettype wire

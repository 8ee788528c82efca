// Writes words of 16 bytes to memory through a native write port, in bursts.
//
// Input: a stream of {address, data, strobe}, with strobe bit k for byte k. Memory side, the LiteDRAM native write port:
// commands by valid/ready, and the data of each command in the same order, some time later. Memory takes data without checking
// `wdata_valid`; the data are always valid by then, because they enter their FIFO before the command is sent.
//
// Memory takes a dozen clocks to switch between reads and writes. Words therefore wait in the FIFOs until BURST of them can be sent
// together. While `hurry` is high, which is needed for the last words of a frame, words are sent at once.
//
//   in ──┬─▶ addresses ─▶ gate ─▶ command
//        └─▶ words ─────────────▶ data
//
// Latency 2 clocks from a word to its command during a burst, throughput one word per clock. `idle` is high when memory
// has taken all words; it rises one clock after the last word. The ready signals of memory, which end a long path in LiteDRAM, only control
// the outputs of the FIFOs. `in_ready` is a register, so that no path goes from the FIFOs through the sources of the words.

`default_nettype none

module write_port #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned DEPTH        = 32,
    parameter int unsigned BURST        = 24
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire                     hurry,
    output logic                    idle,
    input  wire                     in_valid,
    output logic                    in_ready,
    input  wire  [ADDRESS_BITS-1:0] in_addr,
    input  wire  [127:0]            in_data,
    input  wire  [15:0]             in_strobe,
    // Memory.
    output logic                    cmd_valid,
    input  wire                     cmd_ready,
    output logic [ADDRESS_BITS-1:0] cmd_addr,
    output logic                    wdata_valid,
    input  wire                     wdata_ready,
    output logic [127:0]            wdata,
    output logic [15:0]             wdata_strobe
);
    localparam int unsigned COUNT_BITS = $clog2(DEPTH + 2) + 1;

    logic move, address_valid, sent, gone, bursting;

    assign move = in_valid && in_ready;

    // `in_ready` is high only if the FIFO of the data has a free entry. An address leaves its FIFO before its data leave theirs, so the
    // FIFO of the addresses then has a free entry too.
    /* verilator lint_off PINCONNECTEMPTY */
    fifo #(.WIDTH(ADDRESS_BITS), .DEPTH(DEPTH)) addresses (
        .clk       (clk),
        .rst       (rst),
        .in_valid  (move),
        .in_ready  (),
        .in_data   (in_addr),
        .out_valid (address_valid),
        .out_ready (cmd_ready && bursting),
        .out_data  (cmd_addr)
    );

    fifo #(.WIDTH(144), .DEPTH(DEPTH), .DIRECT(1'b1)) words (
        .clk       (clk),
        .rst       (rst),
        .in_valid  (move),
        .in_ready  (),
        .in_data   ({in_strobe, in_data}),
        .out_valid (wdata_valid),
        .out_ready (wdata_ready),
        .out_data  ({wdata_strobe, wdata})
    );
    /* verilator lint_on PINCONNECTEMPTY */

    // `gathered` is the number of words whose command memory has not taken, `waiting` the number of words whose data memory has not
    // taken. Both are reduced one clock late, so neither is ever too low, and a burst does not end before its last command is taken.
    logic [COUNT_BITS-1:0] gathered, waiting, waiting_next;

    assign cmd_valid    = address_valid && bursting;
    assign idle         = waiting == '0;
    assign waiting_next = waiting + (move == gone ? '0 : move ? COUNT_BITS'(1) : '1);

    always_ff @(posedge clk) begin
        bursting <= gathered >= COUNT_BITS'(BURST) || hurry || bursting && gathered != '0;

        sent     <= cmd_valid && cmd_ready;
        gone     <= wdata_valid && wdata_ready;
        gathered <= gathered + (move == sent ? '0 : move ? COUNT_BITS'(1) : '1);
        waiting  <= waiting_next;
        in_ready <= waiting_next < COUNT_BITS'(DEPTH);

        if (rst) begin
            in_ready <= 1'b1;
            bursting <= 1'b0;
            sent     <= 1'b0;
            gone     <= 1'b0;
            gathered <= '0;
            waiting  <= '0;
        end
    end
endmodule

`default_nettype wire

// Writes words of 16 bytes to memory through a native write port.
//
// In: a stream of {address, data, strobe}, strobe bit k for byte k. Memory side, the LiteDRAM native write port: commands
// by valid/ready, and the data of each in the same order, by a valid/ready of its own, with the command or later. So a
// word's data goes into a FIFO of DEPTH places when its command goes out.
//
// Latency 1 clock to the command, throughput a word a clock. `idle` when all that came in has been taken by the memory.

`default_nettype none

module write_port #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned DEPTH        = 16
) (
    input  wire                     clk,
    input  wire                     rst,
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
    // A word waits here until the memory takes its command and the FIFO its data.
    logic room, move;

    assign move     = in_valid && in_ready;
    assign in_ready = room && (!cmd_valid || cmd_ready);

    always_ff @(posedge clk) begin
        if (!cmd_valid || cmd_ready) begin
            cmd_valid <= move;
            cmd_addr  <= in_addr;
        end
        if (rst) cmd_valid <= 1'b0;
    end

    fifo #(.WIDTH(144), .DEPTH(DEPTH)) words (
        .clk       (clk),
        .rst       (rst),
        .in_valid  (move),
        .in_ready  (room),
        .in_data   ({in_strobe, in_data}),
        .out_valid (wdata_valid),
        .out_ready (wdata_ready),
        .out_data  ({wdata_strobe, wdata})
    );

    // Words whose data the memory has not taken.
    logic [$clog2(DEPTH + 2):0] waiting;
    logic                       gone;

    assign gone = wdata_valid && wdata_ready;
    assign idle = waiting == '0 && !cmd_valid;

    always_ff @(posedge clk) begin
        if (move != gone) waiting <= move ? waiting + 1'b1 : waiting - 1'b1;
        if (rst) waiting <= '0;
    end
endmodule

`default_nettype wire

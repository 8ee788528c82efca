// Shares one native read port of the memory among CLIENTS clients. Each client has an input stream of word addresses and an
// output stream of words, in the order of its addresses.
//
// Memory side, the LiteDRAM native read port: commands by valid/ready, one word each; data arrives later, in the order of the commands, and
// without back-pressure. A client is therefore only served while its FIFO of DEPTH words has a free entry for every outstanding word.
// Throughput one word per clock.
//
// The DDR3 memory takes four clocks to switch to another bank, and a dozen to switch between writes and reads. A client is therefore
// served in bursts: it keeps its turn until it has no request or all entries of its FIFO are reserved. In the second case it is served
// again when half of the entries are free.
//
// Latency: 2 clocks from `ask` to the command, 3 from the memory's data to the client, or 4 with BLOCK. `ask_ready` comes directly from
// registers, because the ready of the memory's command is the end of a long path in LiteDRAM. `drop`, held until `idle`, cancels all
// requests: from the next clock on no address is accepted, and the words of accepted addresses are discarded.
//
//   ask ──┐           ┌──▶ skid_buffer ──▶ command
//   ask ──┼──▶ turn ──┤
//   ask ──┘           └──▶ owners ──┐
//                                   ▼
//  data ◀── FIFO ◀──┬───── client of word ◀── data
//  data ◀── FIFO ◀──┘

`default_nettype none

module read_port #(
    parameter int unsigned CLIENTS      = 4,
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned DEPTH        = 32,
    // Clients whose FIFO is in block RAM: two RAMB36 instead of 88 LUTs.
    parameter bit [CLIENTS-1:0] BLOCK   = '0
) (
    input  wire                             clk,
    input  wire                             rst,
    input  wire                             drop,
    output logic                            idle,
    // Clients.
    input  wire  [CLIENTS-1:0]              ask_valid,
    output logic [CLIENTS-1:0]              ask_ready,
    input  wire  [CLIENTS*ADDRESS_BITS-1:0] ask_addr,
    output logic [CLIENTS-1:0]              data_valid,
    input  wire  [CLIENTS-1:0]              data_ready,
    output logic [CLIENTS*128-1:0]          data,
    // Memory.
    output logic                            cmd_valid,
    input  wire                             cmd_ready,
    output logic [ADDRESS_BITS-1:0]         cmd_addr,
    input  wire                             rdata_valid,
    input  wire  [127:0]                    rdata
);
    localparam int unsigned CLIENT_BITS = CLIENTS > 1 ? $clog2(CLIENTS) : 1;
    localparam int unsigned ROOM_BITS   = $clog2(DEPTH + 1);
    // At most CLIENTS * DEPTH words are requested and not yet delivered.
    localparam int unsigned OWNER_BITS  = $clog2(CLIENTS * DEPTH);

    // The client of the next command (`turn`) is chosen one clock before the command: the current client while it may continue, otherwise
    // the next client with a request. The choice does not depend on requests in the clock of the command. If the chosen client has no
    // request in that clock, no command is sent.
    logic [CLIENT_BITS-1:0] turn, first, chosen;
    logic [CLIENTS-1:0]     servable;
    logic                   given, any, moves, commands;

    always_comb begin
        any    = 1'b0;
        chosen = '0;
        for (int i = CLIENTS - 1; i >= 0; i--)
            if (servable[i]) begin
                any    = 1'b1;
                chosen = CLIENT_BITS'(i);
            end
        for (int i = CLIENTS - 1; i >= 0; i--)
            if (servable[i] && CLIENT_BITS'(i) >= first) chosen = CLIENT_BITS'(i);
    end

    assign commands = given && ask_valid[turn];

    always_ff @(posedge clk) begin
        if (moves) begin
            given <= any;
            turn  <= chosen;
            if (any) first <= chosen;
        end

        if (rst || drop) given <= 1'b0;
        if (rst) first <= '0;
    end

    skid_buffer #(.WIDTH(ADDRESS_BITS)) command (
        .clk, .rst,
        .in_valid(commands), .in_ready(moves), .in_data(ask_addr[turn * ADDRESS_BITS +: ADDRESS_BITS]),
        .out_valid(cmd_valid), .out_ready(cmd_ready), .out_data(cmd_addr)
    );

    // Queue of the clients of all outstanding words, in the order of the commands.
    (* ram_style = "distributed" *) logic [CLIENT_BITS-1:0] owners [0:2**OWNER_BITS-1];
    logic [OWNER_BITS:0]    asked, answered;
    logic [CLIENT_BITS-1:0] owner;

    assign owner = owners[answered[OWNER_BITS-1:0]];
    assign idle  = asked == answered;

    always_ff @(posedge clk) begin
        if (commands && moves) owners[asked[OWNER_BITS-1:0]] <= turn;
        asked    <= asked + (OWNER_BITS + 1)'(commands && moves);
        answered <= answered + (OWNER_BITS + 1)'(rdata_valid);

        if (rst) begin
            asked    <= '0;
            answered <= '0;
        end
    end

    logic [127:0]       word;
    logic [CLIENTS-1:0] store;

    always_ff @(posedge clk) begin
        word <= rdata;
        for (int i = 0; i < CLIENTS; i++)
            store[i] <= rdata_valid && owner == CLIENT_BITS'(i) && !drop && !rst;
    end

    for (genvar i = 0; i < CLIENTS; i++) begin : client
        // Number of free entries of the client's FIFO that are not reserved for requested words.
        logic [ROOM_BITS-1:0] room;
        logic                 has_turn, asks, taken, bursting;

        assign has_turn     = given && turn == CLIENT_BITS'(i);
        assign servable[i]  = ask_valid[i] && bursting && (room > ROOM_BITS'(1) || room[0] && !has_turn);
        assign ask_ready[i] = moves && has_turn;
        assign asks         = ask_valid[i] && ask_ready[i];

        // `room` includes an entry one clock after its word has left the FIFO: the register `taken` ends the timing path of `data_ready`.
        always_ff @(posedge clk) begin
            taken <= data_valid[i] && data_ready[i];
            room     <= room + (asks == taken ? '0 : asks ? '1 : ROOM_BITS'(1));
            bursting <= room != '0 && (bursting || room >= ROOM_BITS'(DEPTH/2));

            if (rst || drop) begin
                room     <= ROOM_BITS'(DEPTH);
                bursting <= 1'b1;
                taken    <= 1'b0;
            end
        end

        // An entry is reserved for each requested word, so the FIFO's `in_ready` is high whenever a word arrives.
        /* verilator lint_off PINCONNECTEMPTY */
        fifo #(.WIDTH(128), .DEPTH(DEPTH), .BLOCK(BLOCK[i])) words (
            .clk       (clk),
            .rst       (rst || drop),
            .in_valid  (store[i]),
            .in_ready  (),
            .in_data   (word),
            .out_valid (data_valid[i]),
            .out_ready (data_ready[i]),
            .out_data  (data[128*i +: 128])
        );
        /* verilator lint_on PINCONNECTEMPTY */
    end
endmodule

`default_nettype wire

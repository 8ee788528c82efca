// Shares one native read port of the memory among CLIENTS, each with a stream of word addresses in and a stream of words
// out, in its own order.
//
// Memory side, the LiteDRAM native read port: commands by valid/ready, one word each; data comes in the commands' order,
// some time later, and cannot be held back. It need not be: a client is only served while the DEPTH places of its FIFO
// have room for all that it has asked for. Clients take turns; one that is alone gets a word a clock.
//
// Latency: 1 clock from `ask` to the command, 3 from the memory's data to the client.
// `drop`, held until `idle`, forgets everything: nothing is asked, what is still to come from memory is thrown away.
//
//   ask ──┐                    ┌──▶ command
//   ask ──┼──▶ turn ──┬────────┘
//   ask ──┘           └──▶ owners ──┐
//                                   ▼
//  data ◀── FIFO ◀──┬────────── whose word ◀── data
//  data ◀── FIFO ◀──┘

`default_nettype none

module read_port #(
    parameter int unsigned CLIENTS      = 4,
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned DEPTH        = 16
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
    // All that can be on its way at once.
    localparam int unsigned OWNER_BITS  = $clog2(CLIENTS * DEPTH);

    // Whose turn it is: the one after the last served, or the next that asks.
    logic [CLIENT_BITS-1:0] first, chosen;
    logic [CLIENTS-1:0]     servable, taken;
    logic                   any, choose;

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

    assign choose = any && (!cmd_valid || cmd_ready);

    always_ff @(posedge clk) begin
        if (!cmd_valid || cmd_ready) begin
            cmd_valid <= any;
            cmd_addr  <= ask_addr[chosen * ADDRESS_BITS +: ADDRESS_BITS];
        end
        if (choose) first <= chosen + 1'b1;

        if (rst) begin
            cmd_valid <= 1'b0;
            first     <= '0;
        end
    end

    // The owners of the words that are on their way, in order.
    (* ram_style = "distributed" *) logic [CLIENT_BITS-1:0] owners [0:2**OWNER_BITS-1];
    logic [OWNER_BITS:0]    asked, answered;
    logic [CLIENT_BITS-1:0] owner;

    assign owner = owners[answered[OWNER_BITS-1:0]];
    assign idle  = asked == answered && !cmd_valid;

    always_ff @(posedge clk) begin
        if (choose) begin
            owners[asked[OWNER_BITS-1:0]] <= chosen;
            asked <= asked + 1'b1;
        end
        if (rdata_valid) answered <= answered + 1'b1;

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
        // Places of the FIFO that are neither full nor promised.
        logic [ROOM_BITS-1:0] room;

        assign servable[i]  = ask_valid[i] && room != '0 && !drop;
        assign ask_ready[i] = choose && chosen == CLIENT_BITS'(i);
        assign taken[i]     = data_valid[i] && data_ready[i];

        always_ff @(posedge clk) begin
            if (ask_ready[i] != taken[i]) room <= ask_ready[i] ? room - 1'b1 : room + 1'b1;
            if (rst || drop) room <= ROOM_BITS'(DEPTH);
        end

        // The places are there: `in_ready` is always high when something comes.
        /* verilator lint_off PINCONNECTEMPTY */
        fifo #(.WIDTH(128), .DEPTH(DEPTH)) words (
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

// Proof of read_port, at a small size: two clients with FIFOs of two entries. Clients send addresses and take words at any time, and
// memory takes commands and answers at any time.
//
// Addresses are numbered: the n-th address of a client is n, with the client's number in the bits above, and the word at an address equals
// the address. The port does not depend on its payload, so the proof holds for any addresses and words.

`default_nettype none

module read_port_proof (
    input wire       clk,
    input wire       drop,
    input wire [1:0] ask_valid,
    input wire [1:0] data_ready,
    input wire       cmd_ready,
    input wire       rdata_valid
);
    localparam int unsigned DEPTH = 2, NUMBER_BITS = 3, ADDRESS_BITS = NUMBER_BITS + 1;
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    // For each client, the number of its addresses that have been taken, and the number of its words that memory has returned.
    logic [1:0][NUMBER_BITS-1:0] asked, answered;
    logic [1:0]                  ask_ready, data_valid;
    logic [2*ADDRESS_BITS-1:0]   ask_addr;
    logic [255:0]                data;
    logic                        idle, cmd_valid;
    logic [ADDRESS_BITS-1:0]     cmd_addr;

    // The clients of the commands that memory has not answered, the oldest in bit 0, and the number of these commands.
    logic [2*DEPTH-1:0] owners;
    logic [2:0]         pending;
    logic               owner;

    assign owner    = owners[0];
    assign ask_addr = {1'b1, asked[1], 1'b0, asked[0]};

    read_port #(.CLIENTS(2), .ADDRESS_BITS(ADDRESS_BITS), .DEPTH(DEPTH)) dut (
        .clk, .rst, .drop, .idle, .ask_valid, .ask_ready, .ask_addr, .data_valid, .data_ready, .data,
        .cmd_valid, .cmd_ready, .cmd_addr, .rdata_valid, .rdata(128'({owner, answered[owner]}))
    );

    stream_checker #(.WIDTH(ADDRESS_BITS)) commands (
        .clk, .rst, .valid(cmd_valid), .ready(cmd_ready), .data(cmd_addr)
    );

    logic               commanding, dropped;
    logic [2*DEPTH-1:0] next_owners;

    assign commanding = cmd_valid && cmd_ready;

    always_comb begin
        next_owners = owners;
        for (int i = 0; i < 2 * DEPTH; i++)
            if (commanding && pending == 3'(i)) next_owners[i] = cmd_addr[NUMBER_BITS];
    end

    always_ff @(posedge clk) begin
        dropped <= drop;
        owners  <= rdata_valid ? next_owners >> 1 : next_owners;
        pending <= pending + 3'(commanding) - 3'(rdata_valid);
        if (rst) begin
            dropped <= 1'b0;
            pending <= '0;
        end
    end

    always_ff @(posedge clk) if (!rst) begin
        assume (!rdata_valid || pending != '0);
        // `drop` holds until the port is idle.
        assume (!dropped || drop || idle);

        idle_is_answered: assert (idle == (asked == answered));
    end

    logic delayed;

    assign delayed = !cmd_ready || data_ready != '1 || pending != '0 && !rdata_valid;

    read_client_checker #(.CLIENT(0), .DEPTH(DEPTH), .NUMBER_BITS(NUMBER_BITS)) first (
        .clk, .rst, .drop, .dropped, .cmd_valid, .cmd_ready, .cmd_addr, .rdata_valid, .owner, .delayed, .idle,
        .ask_valid(ask_valid[0]), .ask_ready(ask_ready[0]), .data_valid(data_valid[0]), .data_ready(data_ready[0]),
        .data(data[0 +: ADDRESS_BITS]), .asked(asked[0]), .answered(answered[0])
    );

    read_client_checker #(.CLIENT(1), .DEPTH(DEPTH), .NUMBER_BITS(NUMBER_BITS)) second (
        .clk, .rst, .drop, .dropped, .cmd_valid, .cmd_ready, .cmd_addr, .rdata_valid, .owner, .delayed, .idle,
        .ask_valid(ask_valid[1]), .ask_ready(ask_ready[1]), .data_valid(data_valid[1]), .data_ready(data_ready[1]),
        .data(data[128 +: ADDRESS_BITS]), .asked(asked[1]), .answered(answered[1])
    );
endmodule

`default_nettype wire

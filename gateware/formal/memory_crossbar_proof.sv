// Proof of the memory crossbar between three ports (read and write, read only, write only) and two banks, for any commands and data and any
// completion times of the banks. A model stores the pending commands of each bank. In each clock at most one command passes from a port to
// the queue of its bank, unchanged, and only if the queue is not full. The answer to a command returns to the command's port, and the
// commands of a port are answered in order. If no command is pending, a command is taken at once. A port waits only for pending commands of
// the bank that it requests, for its own pending commands, and for a few clocks of arbitration.

`default_nettype none

module memory_crossbar_proof #(
    localparam int unsigned PORTS   = 3,
    localparam int unsigned BANKS   = 2,
    localparam int unsigned PLACES  = 5,
    // Upper bounds: on the clocks of arbitration for which a port waits, and on the clocks in which no command passes although no bank has
    // a pending command.
    localparam int unsigned WITHIN  = 5,
    localparam int unsigned IDLE_WITHIN = 3,
    localparam int unsigned COMMAND_BITS = 2 + 1 + 3
) (
    input wire                   clk,
    input wire [PORTS-1:0]       cmd_valid,
    input wire [PORTS-1:0]       cmd_we,
    input wire [PORTS-1:0]       cmd_row,
    input wire [PORTS-1:0]       cmd_bank,
    input wire [PORTS-1:0][7:0]  wdata,
    input wire [7:0]             memory_rdata,
    input wire                   done,
    input wire                   done_bank
);
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic [PORTS-1:0]       cmd_ready, wdata_ready, rdata_valid;
    logic [PORTS-1:0][4:0]  cmd_addr;
    logic [PORTS-1:0][7:0]  rdata;
    logic [BANKS-1:0]       bank_valid, bank_we, bank_wdata_ready, bank_rdata_valid;
    logic [BANKS-1:0][3:0]  bank_addr;
    logic [7:0]             memory_wdata;

    // The column of a command is its number among the port's commands.
    logic [PORTS-1:0][2:0] kept, went;

    memory_crossbar dut (
        .sys_clk(clk), .sys_rst(rst), .cmd_valid, .cmd_ready, .cmd_we, .cmd_addr, .wdata, .wdata_ready, .rdata, .rdata_valid,
        .bank_valid, .bank_we, .bank_addr, .bank_wdata_ready, .bank_rdata_valid, .memory_wdata, .memory_rdata
    );

    // A command that is not taken stays unchanged.
    logic [PORTS-1:0] waiting, was_we, was_row, was_bank, changes;

    assign changes = ~cmd_valid | (cmd_we ^ was_we) | (cmd_row ^ was_row) | (cmd_bank ^ was_bank);

    always_ff @(posedge clk) begin
        waiting <= rst ? '0 : cmd_valid & ~cmd_ready;
        {was_we, was_row, was_bank} <= {cmd_we, cmd_row, cmd_bank};
    end

    for (genvar p = 0; p < PORTS; p++) begin : ports
        assign cmd_addr[p] = {cmd_row[p], cmd_bank[p], kept[p]};
    end

    // Mask and number of the port whose command is taken.
    logic [PORTS-1:0] taken;
    logic [1:0]       from;

    assign taken = cmd_valid & cmd_ready;
    assign from  = taken[2] ? 2'd2 : taken[1] ? 2'd1 : 2'd0;

    // Pending commands of each bank, the oldest at index 0: {port, write, number}.
    typedef struct packed {
        logic [1:0] port;
        logic       write;
        logic [2:0] number;
    } command_t;

    logic [BANKS-1:0][PLACES:0][COMMAND_BITS-1:0] queues;
    logic [BANKS-1:0][2:0] levels;
    logic [BANKS-1:0]      gets, gives;
    command_t              oldest, new_one;

    assign new_one = {from, cmd_we[from], kept[from]};
    assign oldest  = queues[done_bank][0];

    for (genvar b = 0; b < BANKS; b++) begin : banks
        assign gets[b]  = taken != '0 && cmd_bank[from] == 1'(b);
        assign gives[b] = done && done_bank == 1'(b);
        assign bank_wdata_ready[b] = gives[b] && oldest.write;
        assign bank_rdata_valid[b] = gives[b] && !oldest.write;

        always_ff @(posedge clk) begin
            for (int i = 0; i <= PLACES; i++) begin
                if (gives[b] && i < PLACES) queues[b][i] <= queues[b][i+1];
                if (gets[b] && levels[b] - 3'(gives[b]) == 3'(i)) queues[b][i] <= new_one;
            end
            levels[b] <= rst ? '0 : levels[b] + 3'(gets[b]) - 3'(gives[b]);
        end
    end

    // The commands that were completed one clock ago and two clocks ago.
    logic [2:1] was_done;
    command_t   done_1, done_2;

    always_ff @(posedge clk) begin
        was_done <= rst ? '0 : {was_done[1], done};
        {done_2, done_1} <= {done_1, oldest};
    end

    // Waiting time of each port. A port is `blocked` in each of these cases: the requested bank has pending commands of another port;
    // another port used this bank last and requests it again; the port itself has the maximum number of pending commands; the port has
    // pending commands in another bank.
    logic [PORTS-1:0][2:0] inside, waited;
    logic [PORTS-1:0]      blocked, last_bank;
    logic [2:0]            unused_for;

    always_comb begin
        for (int p = 0; p < PORTS; p++) begin
            blocked[p] = inside[p] == 3'(PLACES) || inside[p] != '0 && last_bank[p] != cmd_bank[p];
            for (int q = 0; q < PORTS; q++)
                if (q != p && last_bank[q] == cmd_bank[p] && (inside[q] != '0 || cmd_valid[q] && cmd_bank[q] == cmd_bank[p]))
                    blocked[p] = 1'b1;
        end
    end

    logic too_many, too_late;

    always_comb begin
        {too_many, too_late} = '0;
        for (int b = 0; b < BANKS; b++) too_many = too_many || levels[b] > 3'(PLACES);
        for (int p = 0; p < PORTS; p++) too_late = too_late || waited[p] >= 3'(WITHIN);
    end

    always_ff @(posedge clk) begin
        for (int p = 0; p < PORTS; p++) begin
            kept[p]   <= kept[p] + 3'(taken[p]);
            went[p]   <= went[p] + 3'(done && oldest.port == 2'(p));
            inside[p] <= inside[p] + 3'(taken[p]) - 3'(done && oldest.port == 2'(p));
            waited[p] <= cmd_valid[p] && !cmd_ready[p] && !blocked[p] ? waited[p] + 1'b1 : '0;
            if (taken[p]) last_bank[p] <= cmd_bank[p];
        end
        unused_for <= cmd_valid != '0 && taken == '0 && levels == '0 ? unused_for + 1'b1 : '0;
        if (rst) begin
            {kept, went, inside, waited, last_bank} <= '0;
            unused_for <= '0;
        end
    end

    always_ff @(posedge clk) if (!rst) begin
        assume ((waiting & changes) == '0);
        assume (!done || levels[done_bank] != '0);
        assume (!cmd_we[1] && cmd_we[2]);

        one_at_a_time: assert ((taken & (taken - 1'b1)) == '0);
        as_it_came:    assert (bank_valid == gets && (taken == '0 || bank_we[cmd_bank[from]] == cmd_we[from]
                               && bank_addr[cmd_bank[from]] == {cmd_row[from], kept[from]}));
        in_order:      assert (!done || oldest.number == went[oldest.port]);
        read_answered: assert (rdata_valid == (was_done[2] && !done_2.write ? PORTS'(1) << done_2.port : '0));
        data_asked:    assert (wdata_ready == (was_done[1] && done_1.write ? PORTS'(1) << done_1.port : '0));
        data_pass:     assert (rdata[1:0] == {2{memory_rdata}} && (wdata_ready == '0 || memory_wdata == wdata[done_1.port]));
        idle_takes:    assert (unused_for < 3'(IDLE_WITHIN));
        room_in_queue: assert (!too_many);
        taken_in_time: assert (!too_late);

        full:     cover (levels[1] == 3'(PLACES) && cmd_valid[0]);
        all_busy: cover (inside[0] != '0 && inside[1] != '0 && cmd_valid[2] && went[2] != '0);
        changed:  cover (went[0] == 3'd3 && levels[1] != '0 && last_bank[0]);
    end
endmodule

`default_nettype wire

// Proof of the joint AXI port of two readers and two writers, for any commands and words, and for a memory that accepts and answers at any
// time, the answers of different ports in any order. Commands, addresses and words are numbered: each passes once, unchanged, in the order of
// its port; a word follows the address of its own write. A port's address is output within a few clocks in which the memory accepts an
// address. A writer counts as pending from its address to the answer.

`default_nettype none

module axi_ports_proof #(
    localparam int unsigned MOST   = 2,
    // Upper bound on the number of clocks with a ready channel for which a command waits.
    localparam int unsigned WITHIN = 3,
    localparam logic [31:0] ORIGIN = 32'h40
) (
    input wire       clk,
    input wire [3:0] cmd_valid,
    input wire [1:0] wdata_valid,
    input wire       ar_ready,
    input wire       aw_ready,
    input wire       w_ready,
    input wire       r_valid,
    input wire       r_id,
    input wire       r_failed,
    input wire       b_valid,
    input wire       b_id,
    input wire       b_failed
);
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    // Numbers modulo 8 of each port's next command, and of its next word or answer. Ports 0 and 1 read, ports 2 and 3 write.
    logic [3:0][2:0] kept, went;
    logic [1:0][2:0] answered;

    logic [3:0]       cmd_ready;
    logic [1:0]       wdata_ready, rdata_valid, pending;
    logic [1:0][15:0] wdata, rdata;
    logic [1:0][1:0]  strobes;
    logic             ar_valid, aw_valid, w_valid, w_last, r_ready, b_ready, error;
    logic [31:0]      ar_addr, aw_addr;
    logic [3:0]       ar_id, aw_id;
    logic [7:0]       ar_len, aw_len;
    logic [2:0]       ar_size, aw_size;
    logic [1:0]       ar_burst, aw_burst, w_strb;
    logic [15:0]      w_data;

    for (genvar p = 0; p < 2; p++) begin : words
        assign wdata[p]   = 16'({1'(p), went[2+p]});
        assign strobes[p] = went[2+p][1:0];
    end

    axi_ports dut (
        .sys_clk(clk), .sys_rst(rst), .cmd_valid, .cmd_addr(kept), .cmd_ready, .wdata_valid, .wdata, .wdata_we(strobes), .wdata_ready,
        .rdata_valid, .rdata, .pending, .error,
        .axi_ar_valid(ar_valid), .axi_ar_ready(ar_ready), .axi_ar_addr(ar_addr), .axi_ar_id(ar_id), .axi_ar_len(ar_len),
        .axi_ar_size(ar_size), .axi_ar_burst(ar_burst),
        .axi_aw_valid(aw_valid), .axi_aw_ready(aw_ready), .axi_aw_addr(aw_addr), .axi_aw_id(aw_id), .axi_aw_len(aw_len),
        .axi_aw_size(aw_size), .axi_aw_burst(aw_burst),
        .axi_w_valid(w_valid), .axi_w_ready(w_ready), .axi_w_data(w_data), .axi_w_strb(w_strb), .axi_w_last(w_last),
        .axi_r_valid(r_valid), .axi_r_ready(r_ready), .axi_r_id(4'(r_id)), .axi_r_data(16'(went[r_id])), .axi_r_resp({r_failed, 1'b0}),
        .axi_b_valid(b_valid), .axi_b_ready(b_ready), .axi_b_id(4'(b_id)), .axi_b_resp({b_failed, 1'b0})
    );

    stream_checker #(.WIDTH(36)) read_addresses (.clk, .rst, .valid(ar_valid), .ready(ar_ready), .data({ar_id, ar_addr}));
    stream_checker #(.WIDTH(36)) write_addresses (.clk, .rst, .valid(aw_valid), .ready(aw_ready), .data({aw_id, aw_addr}));
    stream_checker #(.WIDTH(18)) written_words (.clk, .rst, .valid(w_valid), .ready(w_ready), .data({w_strb, w_data}));

    // Commands and words stay until they are taken.
    logic [3:0] waiting;
    logic [1:0] words_waiting;

    always_ff @(posedge clk) begin
        waiting       <= rst ? '0 : cmd_valid & ~cmd_ready;
        words_waiting <= rst ? '0 : wdata_valid & ~wdata_ready;
    end

    // For each write address that memory has accepted, but whose word it has not yet accepted: the port that wrote it, the oldest at
    // index 0.
    logic [2*MOST:0] order;
    logic [2:0]      level;
    logic            ar, aw, w;

    assign ar = ar_valid && ar_ready;
    assign aw = aw_valid && aw_ready;
    assign w  = w_valid && w_ready;

    always_ff @(posedge clk) begin
        for (int i = 0; i <= 2 * MOST; i++) begin
            if (w && i < 2 * MOST) order[i] <= order[i+1];
            if (aw && level - 3'(w) == 3'(i)) order[i] <= aw_id[0];
        end
        level <= rst ? '0 : level + 3'(aw) - 3'(w);
    end

    logic [3:0]      taken;
    logic [3:0][1:0] waited;
    logic            too_late;

    assign taken = cmd_valid & cmd_ready;

    always_comb begin
        too_late = 1'b0;
        for (int p = 0; p < 4; p++) too_late = too_late || waited[p] >= 2'(WITHIN);
    end

    // Numbers of pending reads, and of writes from their addresses to their answers.
    logic [1:0][2:0] reads, writes;

    for (genvar p = 0; p < 2; p++) begin : counts
        assign reads[p]  = kept[p] - went[p];
        assign writes[p] = kept[2+p] - answered[p];
    end

    always_ff @(posedge clk) begin
        for (int p = 0; p < 4; p++) begin
            kept[p] <= kept[p] + 3'(taken[p]);
            // A writer with the maximum number of pending writes waits for answers.
            if (!cmd_valid[p] || taken[p] || p >= 2 && (writes[p-2] == 3'(MOST) || level >= 3'(MOST))) waited[p] <= '0;
            else if (p < 2 ? ar_ready : aw_ready) waited[p] <= waited[p] + 1'b1;
        end
        for (int p = 0; p < 2; p++) begin
            went[p]     <= went[p] + 3'(r_valid && r_id == 1'(p));
            went[2+p]   <= went[2+p] + 3'(w && order[0] == 1'(p));
            answered[p] <= answered[p] + 3'(b_valid && b_id == 1'(p));
        end
        if (rst) {kept, went, answered, waited} <= '0;
    end

    always_ff @(posedge clk) if (!rst) begin
        assume ((waiting & ~cmd_valid) == '0);
        assume ((words_waiting & ~wdata_valid) == '0);
        // At most seven reads of a port are pending, so that their numbers differ.
        assume (reads[0] < 3'd6 && reads[1] < 3'd6);
        assume (!r_valid || reads[r_id] != '0);
        assume (!b_valid || went[2 + b_id] != answered[b_id]);

        reads_pass:     assert (taken[1:0] == (ar ? 2'(1) << ar_id : '0) && (!ar || ar_addr == ORIGIN + 32'({kept[ar_id[0]], 1'b0})));
        writes_pass:    assert (taken[3:2] == (aw ? 2'(1) << aw_id : '0) && (!aw || aw_addr == ORIGIN + 32'({kept[2 + aw_id[0]], 1'b0})));
        single_words:   assert (ar_len == '0 && aw_len == '0 && ar_size == 3'd1 && aw_size == 3'd1 && ar_burst == 2'd1 && aw_burst == 2'd1
                                && w_last);
        word_follows:   assert (!w_valid || level != '0 && wdata_valid[order[0]] && w_data == wdata[order[0]]
                                && w_strb == strobes[order[0]]);
        word_taken:     assert (wdata_ready == (w ? 2'(1) << order[0] : '0));
        answers_pass:   assert (rdata_valid == (r_valid ? 2'(1) << r_id : '0) && (!r_valid || rdata[r_id] == 16'(went[r_id])));
        answers_taken:  assert (r_ready && b_ready);
        pending_writes: assert (pending == {writes[1] != '0, writes[0] != '0});
        not_too_many:   assert (writes[0] <= 3'(MOST) && writes[1] <= 3'(MOST));
        errors:         assert (error == (r_valid && r_failed || b_valid && b_failed));
        taken_in_time:  assert (!too_late);

        full:  cover (writes[0] == 3'(MOST) && cmd_valid[2]);
        mixed: cover (level == 3'd2 && order[0] != order[1] && w);
        reads_of_both: cover (reads[0] == 3'd2 && reads[1] == 3'd2 && r_valid && r_id);
    end
endmodule

`default_nettype wire

// Proof of the joint Wishbone port of two readers and two writers, for any commands, and for a memory that answers at any time. Commands and
// words are numbered: each access is that of one command, unchanged, in the order of its port, and stays until it is answered. A port waits
// at most for the current access, and for one access of each other port.

`default_nettype none

module wishbone_ports_proof #(
    // One more than the number of accesses for which a command waits.
    localparam int unsigned WITHIN = 5,
    localparam logic [31:0] ORIGIN = 32'h20
) (
    input wire        clk,
    input wire [3:0]  cmd_valid,
    input wire        ack,
    input wire        err,
    input wire [15:0] dat_r
);
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    // Numbers modulo 8 of each port's next command, and of each writer's next word. Ports 0 and 1 read, ports 2 and 3 write.
    logic [3:0][2:0] kept;
    logic [1:0][2:0] went;

    logic [3:0]       cmd_ready;
    logic [1:0]       wdata_ready, rdata_valid;
    logic [1:0][15:0] wdata, rdata;
    logic [1:0][1:0]  strobes;
    logic             cyc, stb, we, error;
    logic [30:0]      adr;
    logic [15:0]      dat_w;
    logic [1:0]       sel;

    for (genvar p = 0; p < 2; p++) begin : words
        assign wdata[p]   = 16'({1'(p), went[p]});
        assign strobes[p] = went[p][1:0];
    end

    wishbone_ports dut (
        .sys_clk(clk), .sys_rst(rst), .cmd_valid, .cmd_addr(kept), .cmd_ready, .wdata_valid(2'b11), .wdata, .wdata_we(strobes),
        .wdata_ready, .rdata_valid, .rdata, .error,
        .bus_cyc(cyc), .bus_stb(stb), .bus_we(we), .bus_adr(adr), .bus_dat_w(dat_w), .bus_sel(sel), .bus_ack(ack), .bus_err(err),
        .bus_dat_r(dat_r)
    );

    stream_checker #(.WIDTH(50)) requests (.clk, .rst, .valid(cyc), .ready(ack || err), .data({we, adr, dat_w & {16{we}}, sel}));

    // The command of the access, and the port of the last word that was read.
    logic [3:0] taken, waiting;
    logic [1:0] owner, was_owner;
    logic [2:0] number;
    logic       busy, ended, was_read;
    logic [15:0] was_word;

    assign taken = cmd_valid & cmd_ready;
    assign ended = cyc && (ack || err);

    logic [3:0][2:0] waited;
    logic            too_late;

    always_comb begin
        too_late = 1'b0;
        for (int p = 0; p < 4; p++) too_late = too_late || waited[p] >= 3'(WITHIN);
    end

    always_ff @(posedge clk) begin
        for (int p = 0; p < 4; p++) begin
            if (taken[p]) {owner, number} <= {2'(p), kept[p]};
            kept[p]   <= kept[p] + 3'(taken[p]);
            waited[p] <= cmd_valid[p] && !taken[p] ? waited[p] + 3'(ended) : '0;
        end
        waiting <= cmd_valid & ~cmd_ready;
        busy    <= taken != '0 || busy && !ended;
        for (int p = 0; p < 2; p++) went[p] <= went[p] + 3'(ended && owner == 2'(2 + p));
        was_read  <= ended && !owner[1];
        was_owner <= owner;
        was_word  <= dat_r;
        if (rst) begin
            {kept, went, waited, waiting} <= '0;
            {busy, was_read} <= '0;
        end
    end

    always_ff @(posedge clk) if (!rst) begin
        assume ((waiting & ~cmd_valid) == '0);
        assume (cyc || !ack && !err);

        one_at_a_time: assert ((taken & (taken - 1'b1)) == '0 && (taken == '0 || !busy));
        as_it_came:    assert (cyc == busy && stb == cyc && (!cyc || we == owner[1] && adr == ORIGIN[30:0] + 31'(number)));
        word_passes:   assert (!cyc || (we ? dat_w == wdata[owner[0]] && sel == strobes[owner[0]] : sel == '1));
        word_taken:    assert (wdata_ready == (ended && owner[1] ? 2'(1) << owner[0] : '0));
        read_answered: assert (rdata_valid == (was_read ? 2'(1) << was_owner[0] : '0) && (!was_read || rdata[was_owner[0]] == was_word));
        errors:        assert (error == (cyc && err));
        taken_in_time: assert (!too_late);

        all_wait: cover (cmd_valid == '1 && ended);
        written:  cover (went[0] == 3'd2 && went[1] == 3'd1);
    end
endmodule

`default_nettype wire

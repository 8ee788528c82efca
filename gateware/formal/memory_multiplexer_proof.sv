// Proof of the multiplexer for memories with one command per clock, between three banks with any commands, the refresher and the memory.
// At most one command is given per clock, and it reaches the memory unchanged one clock later. The times between commands of different
// banks are kept. No command is given during a refresh, and a refresh begins soon after all banks are ready for it. A command waits at most
// for a run of commands of the other direction, and for one turn of each other bank.

`default_nettype none

module memory_multiplexer_proof #(
    localparam int unsigned BANKS = 3,
    // The times of `generated`, in clocks from one command to the next.
    localparam int unsigned ACTIVATES = 2,
    localparam int unsigned FOUR_ACTIVATES = 10,
    localparam int unsigned COLUMNS = 2,
    localparam int unsigned READ_TO_WRITE = 4,
    localparam int unsigned WRITE_TO_READ = 4,
    // Upper bounds in clocks: on the wait of a command, and of a refresh for which all banks are ready.
    localparam int unsigned WITHIN = 31,
    localparam int unsigned REFRESH_WITHIN = 6
) (
    input wire                 clk,
    input wire [BANKS-1:0]     valid,
    input wire [BANKS-1:0]     cas,
    input wire [BANKS-1:0]     we,
    input wire [BANKS-1:0][3:0] a,
    input wire                 refresh_valid,
    input wire                 refresh_last,
    input wire [2:0]           refresh_levels,
    input wire [3:0]           refresh_a,
    input wire [BANKS-1:0]     refresh_gnt
);
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic [BANKS-1:0] ready, refresh_req;
    logic             refresh_ready, ras_n, cas_n, we_n, rddata_en, wrdata_en;
    logic [1:0]       bank;
    logic [3:0]       address;

    memory_multiplexer dut (
        .sys_clk(clk), .sys_rst(rst), .valid, .cas, .ras(~cas), .we, .a, .ready, .refresh_gnt, .refresh_req,
        .refresh_valid, .refresh_last, .refresh_levels, .refresh_a, .refresh_ready,
        .ras_n, .cas_n, .we_n, .bank, .address, .rddata_en, .wrdata_en
    );

    // The command of this clock.
    logic [BANKS-1:0] given;
    logic [1:0]       from;
    logic             any, reads, writes, activates;

    always_comb begin
        given     = valid & ready;
        any       = given != '0;
        from      = given[2] ? 2'd2 : given[1] ? 2'd1 : 2'd0;
        reads     = any && cas[from] && !we[from];
        writes    = any && cas[from] && we[from];
        activates = any && !cas[from] && !we[from];
    end

    // The kinds of the previous commands, the latest in bit 0.
    logic [FOUR_ACTIVATES-2:0] was_activate, was_read, was_write;
    logic [3:0]                row_count;

    always_comb begin
        row_count = '0;
        for (int i = 0; i < FOUR_ACTIVATES - 1; i++) row_count = row_count + 4'(was_activate[i]);
    end

    logic             was_any, was_refresh;
    logic [2:0]       was_levels;
    logic [1:0]       was_from;
    logic [3:0]       was_a;
    logic [BANKS-1:0] waiting, was_cas, was_we, was_gnt;
    logic [BANKS-1:0][4:0] waited;
    logic [2:0]       refresh_waited;
    logic             too_late;

    always_comb begin
        too_late = 1'b0;
        for (int b = 0; b < BANKS; b++) too_late = too_late || waited[b] >= 5'(WITHIN);
    end

    always_ff @(posedge clk) begin
        was_activate <= rst ? '0 : {was_activate[FOUR_ACTIVATES-3:0], activates};
        was_read     <= rst ? '0 : {was_read[FOUR_ACTIVATES-3:0], reads};
        was_write    <= rst ? '0 : {was_write[FOUR_ACTIVATES-3:0], writes};
        was_any      <= rst ? 1'b0 : any;
        was_refresh  <= rst ? 1'b0 : refresh_ready;
        was_levels   <= rst ? 3'b000 : any ? {!cas[from], cas[from], we[from]} : refresh_levels;
        was_from     <= from;
        was_a        <= any ? a[from] : refresh_a;
        waiting      <= rst ? '0 : valid & ~ready;
        was_gnt      <= rst ? '0 : refresh_gnt;
        {was_cas, was_we} <= {cas, we};
        for (int b = 0; b < BANKS; b++) waited[b] <= !rst && valid[b] && !ready[b] && !refresh_valid ? waited[b] + 1'b1 : '0;
        refresh_waited <= !rst && &refresh_gnt && !refresh_ready ? refresh_waited + 1'b1 : '0;
    end

    always_ff @(posedge clk) if (!rst) begin
        // A command waits unchanged, unless a refresh is due. A bank that is ready for a refresh has no command until the refresh ends.
        assume ((waiting & (~valid | (cas ^ was_cas) | (we ^ was_we))) == '0 || refresh_valid);
        assume (refresh_valid || refresh_ready || refresh_gnt == '0);
        assume (!(refresh_valid || refresh_ready) || (was_gnt & ~refresh_gnt) == '0);
        assume ((refresh_gnt & valid) == '0);
        assume (refresh_levels == '0 || refresh_ready && was_refresh);
        assume (!refresh_last || refresh_ready && refresh_levels == '0);

        one_at_a_time:   assert ((given & (given - 1'b1)) == '0);
        reaches_memory:  assert ({!ras_n, !cas_n, !we_n} == was_levels && (!was_any || {bank, address} == {was_from, was_a})
                                 && (was_levels == '0 || address == was_a));
        data_pass:       assert (rddata_en == was_read[0] && wrdata_en == was_write[0]);
        activates_apart: assert (!activates || was_activate[ACTIVATES-2:0] == '0);
        four_activates:  assert (!activates || row_count < 4'd4);
        columns_apart:   assert (!(reads || writes) || (was_read[COLUMNS-2:0] | was_write[COLUMNS-2:0]) == '0);
        read_to_write:   assert (!writes || was_read[READ_TO_WRITE-2:0] == '0);
        write_to_read:   assert (!reads || was_write[WRITE_TO_READ-2:0] == '0);
        refresh_alone:   assert (!refresh_ready || !any && refresh_gnt == '1);
        refresh_in_time: assert (refresh_waited < 3'(REFRESH_WITHIN));
        asks_all:        assert (refresh_req == {BANKS{refresh_valid}});
        given_in_time:   assert (!too_late);

        turned:    cover (reads && was_write != '0 && was_read != '0);
        refreshed: cover (refresh_levels == 3'b110);
        busy:      cover (row_count == 4'd3 && activates);
    end
endmodule

`default_nettype wire

// Proof of the stage between the CPU's two buses and the shared bus, for any requests, and for a slave that answers at any time. A model
// stores the pending request. One clock after a request is accepted, the shared bus carries it unchanged, and the words of a burst in
// order. Each word of a read goes to the bus that requested it. A write is acknowledged once, in the clock in which it is accepted. The
// data bus has priority over the instruction bus, and no clock is lost between two requests.

`default_nettype none

module cpu_bus_proof #(
    localparam int unsigned DATA = 0,
    localparam int unsigned INSTRUCTIONS = 1
) (
    input wire              clk,
    // Requests of both buses of the CPU: whether a request is present, whether it is a burst, its address, and the data of a write.
    input wire [1:0]        cyc,
    input wire [1:0]        burst,
    input wire [1:0][29:0]  start,
    input wire              we,
    input wire [31:0]       dat_w,
    input wire [3:0]        sel,
    // Answer of the slave.
    input wire              answers,
    input wire [31:0]       dat_r
);
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic [1:0]       ack;
    logic [1:0][31:0] read;
    logic [1:0][29:0] adr;
    logic [1:0][2:0]  cti;
    logic             bus_cyc, bus_stb, bus_we;
    logic [29:0]      bus_adr;
    logic [31:0]      bus_dat_w;
    logic [3:0]       bus_sel;
    logic [2:0]       bus_cti;

    cpu_bus dut (
        .sys_clk(clk), .sys_rst(rst),
        .data_cyc(cyc[DATA]), .data_we(we), .data_adr(adr[DATA]), .data_cti(cti[DATA]), .data_dat_w(dat_w), .data_sel(sel),
        .data_ack(ack[DATA]), .data_dat_r(read[DATA]),
        .instructions_cyc(cyc[INSTRUCTIONS]), .instructions_adr(adr[INSTRUCTIONS]), .instructions_cti(cti[INSTRUCTIONS]),
        .instructions_ack(ack[INSTRUCTIONS]), .instructions_dat_r(read[INSTRUCTIONS]),
        .bus_cyc, .bus_stb, .bus_we, .bus_adr, .bus_dat_w, .bus_sel, .bus_cti, .bus_ack(answers), .bus_dat_r(dat_r)
    );

    // The pending request. `word` is the number of its words that have been answered.
    logic        pending, from, is_write, is_burst;
    logic [29:0] place;
    logic [31:0] written;
    logic [3:0]  bytes;
    logic [2:0]  word;

    logic [1:0] asks, ends;
    logic       is_last, done, next;

    always_comb begin
        is_last = !is_burst || word == '1;
        done    = pending && answers && is_last;
        for (int i = 0; i < 2; i++) begin
            // A bus holds its read request until the last word has arrived.
            asks[i] = cyc[i] && !(pending && !is_write && from == 1'(i));
            adr[i]  = {start[i][29:3], burst[i] ? (asks[i] ? 3'd0 : word) : start[i][2:0]};
            cti[i]  = burst[i] && adr[i][2:0] != '1 ? 3'b010 : burst[i] ? 3'b111 : 3'b000;
            ends[i] = ack[i] && (asks[i] || is_last);
        end
        next = !asks[DATA];
    end

    // A request that has not ended stays unchanged.
    logic [1:0]       waits, was_burst;
    logic [1:0][29:0] was_start;
    logic             was_we;
    logic [31:0]      was_dat_w;
    logic [3:0]       was_sel;

    always_ff @(posedge clk) begin
        waits <= rst ? '0 : cyc & ~ends;
        {was_burst, was_start, was_we, was_dat_w, was_sel} <= {burst, start, we, dat_w, sel};
        if (!pending || done) begin
            pending  <= asks != '0;
            from     <= next;
            is_write <= asks[DATA] && we;
            is_burst <= burst[next];
            place    <= adr[next];
            written  <= dat_w;
            bytes    <= sel;
            word     <= '0;
        end else if (answers) begin
            word <= word + 1'b1;
        end
        if (rst) pending <= 1'b0;
    end

    always_ff @(posedge clk) if (!rst) begin
        assume (!answers || bus_cyc);
        assume (!(burst[DATA] && we));
        for (int i = 0; i < 2; i++) assume (!waits[i] || cyc[i] && burst[i] == was_burst[i] && start[i] == was_start[i]);
        assume (!waits[DATA] || we == was_we && (!we || dat_w == was_dat_w && sel == was_sel));

        shown:      assert (bus_cyc == pending && bus_stb == pending);
        unchanged:  assert (!pending || bus_we == is_write && bus_adr == {place[29:3], place[2:0] + word});
        written_as: assert (!pending || !is_write || bus_dat_w == written && bus_sel == bytes);
        read_whole: assert (!pending || is_write || bus_sel == (from == 1'(DATA) ? bytes : '1));
        burst_ends: assert (!pending || (bus_cti == 3'b010) == !is_last);
        answered:   assert (ack == ((asks[DATA] && we && (!pending || done) ? 2'b01 : 2'b00)
                                    | (pending && answers && !is_write ? 2'b01 << from : 2'b00)));
        data_pass:  assert (read == {2{dat_r}});

        both:       cover (asks == '1 && done);
        after_line: cover (pending && from == 1'(INSTRUCTIONS) && is_burst && done && asks[DATA] && we);
    end
endmodule

`default_nettype wire

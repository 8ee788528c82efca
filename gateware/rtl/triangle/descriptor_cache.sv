// A cache of descriptors (triangles after the setup). The input is descriptor numbers, the output descriptors. A triangle may be drawn in
// several bands, one after the other; with the cache its descriptor is usually read from memory only once.
//
//                 ┌──────┐ miss                              ┌───────┐
//   numbers ─────▶│ tags ├──────▶ addresses ─▶ memory ─words▶│       │
//                 └──┬───┘                                   │ lines ├──▶ read ──▶ out
//                    └─────────────▶ marks ──────── fill ───▶│       │
//                                                            └───────┘
//
// The cache is direct-mapped: the low bits of a number select the line. The first stage looks up and replaces tags in the order of the
// numbers, the second stage fills lines in this order, and the third stage reads lines in this order. A number that hits therefore finds
// the descriptor of its tag. The FIFO `marks` controls the second stage for each item: fill a line, or pass the item on. After a miss, too,
// the descriptor is read from its line, so no multiplexer follows the block RAM. An item without a descriptor (`in_end`) passes in order.
//
// Latency: 8 clocks for a hit, 11 clocks plus the latency of memory for a miss. Throughput one hit per 4 clocks, or one miss per 5
// clocks, 7 with TEXTURE, 8 with SMOOTH, 10 with both. Descriptors must not change in memory while `forget` is low. If `forget` is high for
// one clock, all lines are invalidated, one line per clock, and numbers wait until all lines are invalid. `forget` may only be high while the cache holds no
// item: each item from the input has left at the output.
//
// Stream protocol as in `fifo`. Memory: a client of read_port.

`default_nettype none

module descriptor_cache #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned COUNT_BITS   = 20,
    parameter int unsigned LINE_BITS    = 8,
    // A descriptor has three words of 16 bytes; with TEXTURE two words for the texture follow, with SMOOTH three for the planes of light.
    parameter bit          SMOOTH       = 1'b0,
    parameter bit          TEXTURE      = 1'b0,
    localparam int unsigned PLANES_BITS = triangle_pkg::planes_bits(SMOOTH, TEXTURE)
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       forget,
    // Base addresses of the descriptors of set 0 (written by the geometry unit) and of set 1 (written by the firmware).
    input  wire  [2*ADDRESS_BITS-1:0] base,
    input  wire                       in_valid,
    output logic                      in_ready,
    input  wire                       in_end,
    input  wire                       in_set,
    input  wire  [COUNT_BITS-1:0]     in_number,
    // Memory.
    output logic                      ask_valid,
    input  wire                       ask_ready,
    output logic [ADDRESS_BITS-1:0]   ask_addr,
    input  wire                       data_valid,
    output logic                      data_ready,
    input  wire  [127:0]              data,
    output logic                      out_valid,
    input  wire                       out_ready,
    output logic                      out_end,
    output records_pkg::descriptor_t out_descriptor,
    output logic [PLANES_BITS-1:0]    out_planes
);
    localparam int unsigned WORDS     = triangle_pkg::descriptor_words(SMOOTH, TEXTURE);
    localparam int unsigned WORD_BITS = $clog2(WORDS + 1);
    localparam int unsigned MARKS     = 16;
    // A tag consists of the set, the high bits of the number, and a valid bit.
    localparam int unsigned TAG_BITS  = COUNT_BITS - LINE_BITS + 2;

    // First stage: for three clocks the tag of the item's line is read from block RAM (`latched`, `found`) and compared. The item then
    // waits until the FIFO `marks` has a free entry and, for a miss, until the descriptor's addresses can be requested.
    (* ram_style = "block", rw_addr_collision = "no", no_rw_check *)
    logic [TAG_BITS-1:0]     tags [0:2**LINE_BITS-1];
    logic                    looked, read_out, compared, is_end, set, hit, passes, asks;
    logic [COUNT_BITS-1:0]   number;
    // Offset of the descriptor, in words, from the first descriptor of its set.
    logic [ADDRESS_BITS-1:0] place;
    logic [TAG_BITS-1:0]     tag, latched, found;
    logic [LINE_BITS-1:0]    line, swept_line;
    logic                    swept, used;
    logic                    mark_ready, words_asked;
    logic [ADDRESS_BITS-1:0] set_base;

    assign line     = number[LINE_BITS-1:0];
    assign tag      = {1'b1, set, number[COUNT_BITS-1:LINE_BITS]};
    assign passes   = compared && mark_ready && (is_end || hit || words_asked);
    assign asks     = passes && !is_end && !hit;
    assign in_ready = !looked && swept;

    always_ff @(posedge clk) begin
        if (in_ready) begin
            looked   <= in_valid;
            is_end   <= in_end;
            set      <= in_set;
            number   <= in_number;
            latched  <= tags[in_number[LINE_BITS-1:0]];
            set_base <= in_set ? base[ADDRESS_BITS +: ADDRESS_BITS] : base[0 +: ADDRESS_BITS];
        end
        hit      <= found == tag;
        case (WORDS)
            5:       place <= ADDRESS_BITS'(number) + (ADDRESS_BITS'(number) << 2);
            8:       place <= ADDRESS_BITS'(number) << 3;
            default: place <= (ADDRESS_BITS'(number) + (ADDRESS_BITS'(number) << 1)) << SMOOTH;
        endcase
        found    <= latched;
        read_out <= looked && !passes;
        compared <= read_out && !passes;
        if (passes) looked <= 1'b0;

        if (asks || !swept) tags[swept ? line : swept_line] <= swept ? tag : '0;
        if (asks) used <= 1'b1;
        if (!swept) begin
            swept_line <= swept_line + 1'b1;
            swept      <= swept_line == '1;
        end else if (forget && used) begin
            swept <= 1'b0;
            used  <= 1'b0;
        end

        if (rst) begin
            looked     <= 1'b0;
            read_out   <= 1'b0;
            compared   <= 1'b0;
            swept      <= 1'b0;
            swept_line <= '0;
            used       <= 1'b0;
        end
    end

    // Requests the words of a descriptor, one address per clock.
    logic [WORD_BITS-1:0] word;

    assign words_asked = !ask_valid || ask_ready && word == WORD_BITS'(WORDS - 1);

    always_ff @(posedge clk) begin
        if (words_asked) begin
            ask_valid <= asks;
            ask_addr  <= set_base + place;
            word      <= '0;
        end else if (ask_ready) begin
            ask_addr <= ask_addr + 1'b1;
            word     <= word + 1'b1;
        end
        if (rst) ask_valid <= 1'b0;
    end

    logic                 marked, mark_end, mark_hit, mark_done, reads, reads_again;
    logic [LINE_BITS-1:0] mark_line;

    fifo #(.WIDTH(2 + LINE_BITS), .DEPTH(MARKS)) marks (
        .clk, .rst, .in_valid(passes), .in_ready(mark_ready), .in_data({is_end, hit, line}),
        .out_valid(marked), .out_ready(reads_again), .out_data({mark_end, mark_hit, mark_line})
    );

    // Second stage: after a miss, the words of the descriptor are written to its cache line, one per clock.
    logic [WORD_BITS-1:0] words;
    logic                 takes;

    assign mark_done  = mark_end || mark_hit || words == WORD_BITS'(WORDS);
    assign data_ready = marked && !mark_done;
    assign takes      = data_ready && data_valid;

    always_ff @(posedge clk) begin
        if (takes) words <= words + 1'b1;
        if (reads_again) words <= '0;
        if (rst) words <= '0;
    end

    // Third stage: each descriptor is read from its cache line, in clocks in which no line is written. A block RAM holds two words of each
    // line, because one word of each line would fill only half of the RAM. The first word is read one clock before the second. The block
    // RAM holds the second word at its output until the item has moved, so the register after it needs no enable. If WORDS is odd, the last
    // word is split into two words of 64 bits. The second of these is written one clock late, but before it is read.
    logic                 read_valid, arrives;
    logic [128*WORDS-1:0] descriptor;

    assign reads = marked && mark_done && !read_valid;

    for (genvar i = 0; i < WORDS / 2 + WORDS % 2; i++) begin : pairs
        localparam int unsigned WIDTH = i < WORDS / 2 ? 128 : 64;

        (* ram_style = "block", rw_addr_collision = "no", no_rw_check *)
        logic [WIDTH-1:0] lines [0:2**(LINE_BITS+1)-1];
        logic [WIDTH-1:0] part, cached;
        logic             stores, second;
        // A copy of `reads_again` for each block RAM, so that no copy enables more than 128 flip-flops. `reads` is never high in two
        // successive clocks; each copy depends on itself, because synthesis would otherwise merge registers with equal inputs.
        logic             first_is_read;

        if (WIDTH == 128) begin : of_two_words
            assign stores = takes && words[WORD_BITS-1:1] == (WORD_BITS-1)'(i);
            assign second = words[0];
            assign part   = data;
        end else begin : of_the_last_word
            logic        first;
            logic [63:0] high;

            assign first  = takes && words == WORD_BITS'(WORDS - 1);
            assign stores = first || second;
            assign part   = second ? high : data[63:0];

            always_ff @(posedge clk) begin
                second <= first;
                high   <= data[127:64];
            end
        end

        always_ff @(posedge clk) begin
            first_is_read <= reads && !first_is_read;
            if (stores) lines[{second, mark_line}] <= part;
            if (reads || reads_again) cached <= lines[{reads_again, mark_line}];
            if (first_is_read) descriptor[256*i +: WIDTH] <= cached;
            descriptor[256*i+WIDTH +: WIDTH] <= cached;
        end
    end

    always_ff @(posedge clk) begin
        read_valid  <= reads || read_valid && !(out_valid && out_ready);
        reads_again <= reads;
        arrives     <= reads_again;
        out_valid   <= arrives || out_valid && !out_ready;
        if (reads) out_end <= mark_end;

        if (rst) begin
            read_valid  <= 1'b0;
            reads_again <= 1'b0;
            arrives     <= 1'b0;
            out_valid   <= 1'b0;
        end
    end

    assign out_descriptor = descriptor[383:0];

    localparam int unsigned LIGHT = TEXTURE ? 640 : 384;

    if (SMOOTH && TEXTURE) begin : light_and_texture
        assign out_planes = {descriptor[576 +: triangle_pkg::TEXTURE_BITS], descriptor[LIGHT + 288], descriptor[384 +: 192],
                             descriptor[LIGHT +: 288]};
    end else if (SMOOTH || TEXTURE) begin : light_or_texture
        assign out_planes = descriptor[384 +: PLANES_BITS];
    end else begin : flat
        assign out_planes = '0;
    end

    wire _unused = &{1'b0, descriptor};
endmodule

`default_nettype wire

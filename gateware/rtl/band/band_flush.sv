// Reads spans of rows of a finished band out of its bank, writes them to memory, and clears each row behind itself.
//
//   span ─▶ row ─▶ ┄┄ band_bank's read ┄┄ ─▶ compose ─▶ word ──▶ fifo ─▶ wdata
//            └──▶ clear_row, a clock later, ─▶ address ─▶ fifo ─▶ cmd ─▶ owed ┘
//
// One row is one 128-bit word: eight RGB565 pixels, the leftmost in the lowest bits; a pixel that nobody has drawn takes
// the clear colour. With `with_depth` two words follow, four depths of 32 bits each, 0 where nobody has drawn. The colour word
// of row r goes to `base` + r, its depth words to `depth_base` + 2r and the word after it.
//
// `start` takes these parameters and begins; it may come while `idle` is high, which falls until memory has taken the last
// word. The rows are those of the spans, an item {first, last} each, last >= first, in their order; `spans_busy`
// is high until the last of them has been taken. Throughput one word a clock where spans are there in time and memory keeps up;
// the first command comes 7 clocks after the first span was taken.
//
// Memory side, the LiteDRAM native write port: 128-bit word addresses by valid/ready, data by valid/ready in the order of
// the addresses. LiteDRAM takes the data of a command some time after it without looking at `wdata_valid`, so a command is
// offered only when its data are in the FIFO, and data are valid from the clock after their command was taken on.
// There is a place for a word before its row is read: memory may stall as it likes.
//
// `restart`, and reset, leave the band and clear all 2^ROW_BITS rows of both banks, one a clock, while `sweeping` is high.
// Nothing may be drawn then. Memory is not waited for: words that have been read go there whenever it takes them.

`default_nettype none

module band_flush #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned ROW_BITS     = 11,
    // Words on their way, a power of two.
    parameter int unsigned WORDS        = 32
) (
    input  wire                     clk,
    input  wire                     rst,
    // Work.
    input  wire                     start,
    input  wire  [ADDRESS_BITS-1:0] base,
    input  wire  [ADDRESS_BITS-1:0] depth_base,
    input  wire                     with_depth,
    input  wire  [15:0]             clear_colour,
    input  wire                     restart,
    output logic                    idle,
    output logic                    sweeping,
    output logic                    reads_depth,
    output logic                    waits,
    // Spans.
    input  wire                     span_valid,
    output logic                    span_ready,
    input  wire  [ROW_BITS-1:0]     span_first,
    input  wire  [ROW_BITS-1:0]     span_last,
    input  wire                     spans_busy,
    // Bank: what is there belongs to the `row` of 3 clocks before. `clears`: `clear_row` is to be marked as not written.
    output logic [ROW_BITS-1:0]     row,
    input  wire  [8*16-1:0]         colours,
    input  wire  [8*18-1:0]         codes,
    input  wire  [7:0]              written,
    output logic                    clears,
    output logic [ROW_BITS-1:0]     clear_row,
    // Memory.
    output logic                    cmd_valid,
    input  wire                     cmd_ready,
    output logic [ADDRESS_BITS-1:0] cmd_addr,
    output logic                    wdata_valid,
    input  wire                     wdata_ready,
    output logic [127:0]            wdata_data
);
    localparam int unsigned COUNT_BITS = $clog2(WORDS + 1);

    // The words of a row.
    typedef enum logic [1:0] {COLOUR, DEPTH_LEFT, DEPTH_RIGHT} part_t;

    function automatic part_t next_part(input part_t part, input logic depth);
        case (part)
            COLOUR:     next_part = depth ? DEPTH_LEFT : COLOUR;
            DEPTH_LEFT: next_part = DEPTH_RIGHT;
            default:    next_part = COLOUR;
        endcase
    endfunction

    typedef enum logic [1:0] {IDLE, FLUSH, SWEEP} state_t;
    state_t                state;
    part_t                 part;
    logic                  depth_too, in_span, issue, row_ends, span_ends;
    logic [ROW_BITS-1:0]   last_row;
    logic [15:0]           background;
    logic [ADDRESS_BITS-1:0] colour_base, depth_words_base;
    // Words that may still be asked for.
    logic [COUNT_BITS-1:0] places;

    assign idle        = state == IDLE && places == COUNT_BITS'(WORDS);
    assign sweeping    = state == SWEEP;
    assign reads_depth = state == FLUSH && depth_too;
    assign waits       = state == FLUSH && in_span && places == '0;
    assign issue       = state == FLUSH && in_span && places != '0;
    assign row_ends    = part == (depth_too ? DEPTH_RIGHT : COLOUR);
    assign span_ends   = issue && row_ends && row == last_row;
    assign span_ready  = state == FLUSH && (!in_span || span_ends);

    // Rows, and their clearing a clock behind: the read is then under way.
    always_ff @(posedge clk) begin
        clears    <= 1'b0;
        clear_row <= row;

        case (state)
            FLUSH: begin
                if (issue) begin
                    part   <= next_part(part, depth_too);
                    clears <= row_ends;
                    if (row_ends) row <= row + 1'b1;
                end
                if (span_ready) begin
                    in_span  <= span_valid;
                    row      <= span_first;
                    last_row <= span_last;
                end
                if (!in_span && !spans_busy) state <= IDLE;
            end
            SWEEP: begin
                clears <= 1'b1;
                row    <= row + 1'b1;
                if (row == '1) state <= IDLE;
            end
            default: if (start) begin
                state            <= FLUSH;
                part             <= COLOUR;
                in_span          <= 1'b0;
                colour_base      <= base;
                depth_words_base <= depth_base;
                depth_too        <= with_depth;
                background       <= clear_colour;
            end
        endcase

        if (rst || restart) begin
            state  <= SWEEP;
            row    <= '0;
            clears <= 1'b0;
        end
    end

    // The way through the bank.
    logic  asked_0, asked_1, asked_2;
    part_t part_0, part_1, part_2;
    logic [ADDRESS_BITS-1:0] address_1, address_2, address;

    always_ff @(posedge clk) begin
        // Here `clear_row` is the row that was asked for.
        case (part_0)
            COLOUR:     address_1 <= colour_base + ADDRESS_BITS'(clear_row);
            DEPTH_LEFT: address_1 <= depth_words_base + ADDRESS_BITS'({clear_row, 1'b0});
            default:    address_1 <= depth_words_base + ADDRESS_BITS'({clear_row, 1'b1});
        endcase
        address_2 <= address_1;
        address   <= address_2;

        asked_0 <= issue;
        asked_1 <= asked_0;
        asked_2 <= asked_1;
        part_0  <= part;
        part_1  <= part_0;
        part_2  <= part_1;

        if (rst) begin
            asked_0 <= 1'b0;
            asked_1 <= 1'b0;
            asked_2 <= 1'b0;
        end
    end

    logic                  word_valid, word_ready, word_stored;
    logic [COUNT_BITS-1:0] owed;
    logic [127:0]          word, colour_word, depth_left_word, depth_right_word;

    for (genvar lane = 0; lane < 8; lane++) begin : lanes
        assign colour_word[16*lane +: 16] = written[lane] ? colours[16*lane +: 16] : background;
    end
    for (genvar lane = 0; lane < 4; lane++) begin : depth_lanes
        assign depth_left_word[32*lane +: 32]  = {14'b0, codes[18*lane +: 18] & {18{written[lane]}}};
        assign depth_right_word[32*lane +: 32] = {14'b0, codes[18*(lane + 4) +: 18] & {18{written[lane + 4]}}};
    end

    always_ff @(posedge clk) begin
        word_valid <= asked_2 && !rst;
        case (part_2)
            COLOUR:     word <= colour_word;
            DEPTH_LEFT: word <= depth_left_word;
            default:    word <= depth_right_word;
        endcase
    end

    fifo #(.WIDTH(128), .DEPTH(WORDS)) words (
        .clk, .rst,
        .in_valid(word_valid), .in_ready(word_ready), .in_data(word),
        .out_valid(word_stored), .out_ready(wdata_ready && owed != '0), .out_data(wdata_data)
    );

    // Commands: a word's address enters its FIFO with the word, so it comes out of it no sooner, and a word is at the end of the
    // words' FIFO when its command shows in `owed`: words of commands that memory has taken. There are places in both.
    logic commanded, taken, address_ready;

    fifo #(.WIDTH(ADDRESS_BITS), .DEPTH(WORDS)) addresses (
        .clk, .rst,
        .in_valid(word_valid), .in_ready(address_ready), .in_data(address),
        .out_valid(cmd_valid), .out_ready(cmd_ready), .out_data(cmd_addr)
    );

    wire _unused = &{1'b0, word_ready, address_ready};

    assign wdata_valid = word_stored && owed != '0;
    assign commanded   = cmd_valid && cmd_ready;
    assign taken       = wdata_valid && wdata_ready;

    always_ff @(posedge clk) begin
        if (commanded && !taken)        owed <= owed + 1'b1;
        else if (!commanded && taken)   owed <= owed - 1'b1;
        if (taken && !issue)            places <= places + 1'b1;
        else if (!taken && issue)       places <= places - 1'b1;

        if (rst) begin
            owed   <= '0;
            places <= COUNT_BITS'(WORDS);
        end
    end
endmodule

`default_nettype wire

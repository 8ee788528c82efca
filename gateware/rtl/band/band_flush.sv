// Flushes a finished band from the band buffer to memory: reads spans of consecutive rows from the band's bank, sends their
// words, and clears each row after its last read.
//
//   span ─▶ row ─▶ ┄┄ band_bank's read ┄┄ ─▶ compose ─▶ fifo ─▶ out
//            └──▶ clear_row, a clock later, ─▶ address ──┘
//
// One row is one 128-bit word: eight RGB565 pixels, the leftmost in the lowest bits, with the clear colour for pixels that are not
// written, or, with `with_sky` (SKY only), with the next colour of the stream `sky_*` (band_sky). Colours of the sky and averages are
// dithered with `dither`, and otherwise rounded to nearest. With `compose` other than 0 (STEREO only) a pixel holds the luminances of two
// eyes, {right, left}. If `compose` is 1, the left luminance becomes red, the right luminance blue, and the smaller of the two green. If it
// is 2, the left luminance becomes red, and the right luminance green and blue. The colour word of row r is written to address `base` + r.
// With `with_depth`, the rows of a span are read again after its colours: the depths of each row are two words of four 32-bit depths (0 for
// pixels that are not written), at the addresses `depth_base` + 2r and `depth_base` + 2r + 1. Colour words are output in the order of their
// addresses, and so are depth words, so the DDR3 memory rarely has to open another row.
//
// With `average` (AVERAGE only) the band holds four samples for each pixel, and a word is the average of four rows: of two rows side by
// side in each of two lines. Spans come in pairs, of whole lines of `stride` rows. The first word is written to the address `base`; `gap`
// addresses lie between the last word of a line and the first word of the next line. The sky has a colour for each word. There are no depths.
// The sum of a channel is rounded by one of four thresholds (docs/formats/triangle.md, "Samples").
//
//   row of 8 samples ─▶ 4 pairs ─┬────────▶ sum of 4 ─▶ 4 pixels ─┬────────────▶ right half of a word
//                                └▶ previous ──▲                  └▶ left half
//
// `start` (only while `idle`) takes these parameters and begins a flush; `idle` is low until the last word has been taken.
// Spans are items {first, last}, last >= first; `spans_busy` must be high until the last span has been taken. Throughput one
// row per clock unless spans or memory are slower; the first word is output 6 clocks after the first span is taken, and an average
// 12 clocks after it.
//
// Output: a stream of {address, data}; valid does not wait for ready, and a word holds until it has moved. A FIFO entry is reserved before
// a row is read, so `out_ready` may stay low for any time.
//
// `restart` and reset cancel the band and clear all 2^ROW_BITS rows of both banks, one row per clock, while `sweeping` is high.
// No group may be drawn during this time. Words that were already read are output during the sweep or later.

`default_nettype none

module band_flush #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned ROW_BITS     = 11,
    parameter int unsigned COLUMN_BITS  = 8,
    // Depth of the word FIFO, a power of two: the largest number of words that are requested and not yet taken. If words are taken at
    // once, an entry is free again 6 clocks after the request of its row.
    parameter int unsigned WORDS        = 16,
    parameter bit          STEREO       = 1'b0,
    parameter bit          SKY          = 1'b0,
    parameter bit          AVERAGE      = 1'b0
) (
    input  wire                     clk,
    input  wire                     rst,
    // The flush to perform, and its state.
    input  wire                     start,
    input  wire  [ADDRESS_BITS-1:0] base,
    input  wire  [ADDRESS_BITS-1:0] depth_base,
    input  wire                     with_depth,
    input  wire  [15:0]             clear_colour,
    input  wire                     with_sky,
    input  wire                     dither,
    input  wire  [1:0]              compose,
    input  wire                     average,
    input  wire  [COLUMN_BITS-1:0]  stride,
    input  wire  [COLUMN_BITS-1:0]  gap,
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
    // Port to the bank: colours, depth codes and written bits belong to the `row` of 3 clocks ago. `clears` resets the written
    // bits of `clear_row`.
    output logic [ROW_BITS-1:0]     row,
    input  wire  [8*16-1:0]         colours,
    input  wire  [8*18-1:0]         codes,
    input  wire  [7:0]              written,
    output logic                    clears,
    output logic [ROW_BITS-1:0]     clear_row,
    // Colours of the sky, one for each row.
    input  wire                     sky_valid,
    output logic                    sky_ready,
    input  wire  [1:0]              sky_line,
    input  wire  [23:0]             sky_colour,
    // Words.
    output logic                    out_valid,
    input  wire                     out_ready,
    output logic [ADDRESS_BITS-1:0] out_addr,
    output logic [127:0]            out_data
);
    localparam int unsigned COUNT_BITS = $clog2(WORDS + 1);

    // The word that a read of a row produces: its eight colours, its left four depths, or its right four depths.
    typedef enum logic [1:0] {COLOUR, DEPTH_LEFT, DEPTH_RIGHT} part_t;

    typedef enum logic [1:0] {IDLE, FLUSH, SWEEP} state_t;
    state_t                state;
    part_t                 part, last_part;
    logic                  depth_too, in_span, issue, part_ends, span_ends, takes_sky, dithers, averaging, paired;
    // Which of the four rows of an average is read: {right, lower}.
    logic [1:0]            corner;
    logic                  word_ends;
    // Differences of row numbers: to the next row, and in an average from the upper to the lower row, and back to the next upper row.
    logic [ROW_BITS-1:0]   step, down, back;
    logic [ROW_BITS-1:0]   first_row, last_row;
    logic [15:0]           clear;
    logic [1:0]            composing;
    logic [ADDRESS_BITS-1:0] colour_base, depth_words_base;
    // Number of words that may still be requested: the number of FIFO entries that are not reserved.
    logic [COUNT_BITS-1:0] places;

    assign idle        = state == IDLE && places == COUNT_BITS'(WORDS);
    assign sweeping    = state == SWEEP;
    assign reads_depth = state == FLUSH && depth_too;
    assign waits       = state == FLUSH && in_span && places == '0;
    assign issue       = state == FLUSH && in_span && places != '0 && (!takes_sky || part != COLOUR || sky_valid);
    assign sky_ready   = issue && takes_sky && part == COLOUR && word_ends;
    assign last_part   = depth_too ? DEPTH_RIGHT : COLOUR;
    assign word_ends   = !averaging || corner == '1;
    assign part_ends   = part != DEPTH_LEFT && row == last_row && word_ends;
    assign step        = !averaging ? ROW_BITS'(1) : corner[0] ? back : down;
    assign span_ends   = issue && part_ends && part == last_part;
    assign span_ready  = state == FLUSH && (!in_span || span_ends);

    // Requests one row of the bank in each clock, and clears it one clock later, when the read has started.
    always_ff @(posedge clk) begin
        clears    <= 1'b0;
        clear_row <= row;

        case (state)
            FLUSH: begin
                if (issue) begin
                    clears <= part == last_part;
                    case (part)
                        COLOUR:     if (part_ends && depth_too) part <= DEPTH_LEFT;
                        DEPTH_LEFT: part <= DEPTH_RIGHT;
                        default:    part <= part_ends ? COLOUR : DEPTH_LEFT;
                    endcase
                    if (part_ends)               row <= first_row;
                    else if (part != DEPTH_LEFT) row <= row + step;
                end
                if (span_ready) begin
                    in_span   <= span_valid && (!averaging || paired);
                    if (!paired) row <= span_first;
                    first_row <= span_first;
                    last_row  <= span_last;
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
                depth_too        <= with_depth && !(AVERAGE && average);
                clear            <= clear_colour;
                takes_sky        <= SKY && with_sky;
                dithers          <= dither;
                composing        <= compose;
            end
        endcase

        if (rst || restart) begin
            state  <= SWEEP;
            row    <= '0;
            clears <= 1'b0;
        end
    end

    // Number of the requested word from the beginning of the band, and the parity of its line.
    logic [ROW_BITS-1:0] place, place_0;
    logic                odd;

    if (AVERAGE) begin : averages
        logic [ROW_BITS-1:0] word_place;

        always_ff @(posedge clk) begin
            if (issue) corner <= corner + 1'b1;
            if (issue && word_ends) word_place <= word_place + 1'b1 + (span_ends ? ROW_BITS'(gap) : '0);
            if (span_ends) odd <= !odd;
            if (state == FLUSH && span_ready && span_valid && averaging) paired <= !paired;
            if (state == IDLE) begin
                averaging  <= average;
                down       <= ROW_BITS'(stride);
                back       <= ROW_BITS'(1) - ROW_BITS'(stride);
                corner     <= '0;
                word_place <= '0;
                odd        <= 1'b0;
                paired     <= 1'b0;
            end
        end
        assign place = averaging ? word_place : row;
    end else begin : rows_alone
        assign {averaging, paired, corner, odd, down, back} = '0;
        assign place = row;
        wire _unused = &{1'b0, average, stride, gap, odd};
    end

    // Delays the kind and the address of each requested word by the latency of the bank's read.
    logic  asked_0, asked_1, asked_2;
    part_t part_0, part_1, part_2;
    logic [ADDRESS_BITS-1:0] address_1, address_2, address;

    always_ff @(posedge clk) begin
        place_0 <= place;
        case (part_0)
            COLOUR:     address_1 <= colour_base + ADDRESS_BITS'(place_0);
            DEPTH_LEFT: address_1 <= depth_words_base + ADDRESS_BITS'({place_0, 1'b0});
            default:    address_1 <= depth_words_base + ADDRESS_BITS'({place_0, 1'b1});
        endcase
        address_2 <= address_1;
        address   <= address_2;

        asked_0 <= issue && word_ends;
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

    logic         word_valid, word_ready, taken, asked;
    logic [127:0] word, colour_word, depth_left_word, depth_right_word, backgrounds;

    if (SKY) begin : sky
        // The clear colour in the format of the sky, which no threshold changes.
        logic [23:0] clear_colours, seen_colour;
        logic [1:0]  line, seen_line;

        assign clear_colours = colour_pkg::fractions(clear);

        // The line of samples in an average.
        assign line = averaging ? {sky_line[0], corner[0]} : sky_line;

        delay #(.WIDTH(26), .CLOCKS(3)) waits (
            .clk, .enable(1'b1), .in({line, takes_sky ? sky_colour : clear_colours}), .out({seen_line, seen_colour})
        );

        for (genvar lane = 0; lane < 8; lane++) begin : lanes
            assign backgrounds[16*lane +: 16] = colour_pkg::rounded(seen_colour, colour_pkg::threshold(dithers, 2'(lane), seen_line));
        end
    end else begin : plain_clear
        assign backgrounds = {8{clear}};
        wire _unused = &{1'b0, dithers, sky_line, sky_colour};
    end

    for (genvar lane = 0; lane < 8; lane++) begin : lanes
        logic [15:0] seen;

        if (STEREO) begin : composed
            logic [7:0] left, right;
            assign {right, left} = colours[16*lane +: 16];
            assign seen = composing == 2'd0 ? {right, left}
                        : {left[7:3], composing[0] && left < right ? left[7:2] : right[7:2], right[7:3]};
        end else begin : plain
            assign seen = colours[16*lane +: 16];
        end

        assign colour_word[16*lane +: 16] = written[lane] ? seen : backgrounds[16*lane +: 16];
    end
    for (genvar lane = 0; lane < 4; lane++) begin : depth_lanes
        assign depth_left_word[32*lane +: 32]  = {14'b0, codes[18*lane +: 18] & {18{written[lane]}}};
        assign depth_right_word[32*lane +: 32] = {14'b0, codes[18*(lane + 4) +: 18] & {18{written[lane + 4]}}};
    end

    always_ff @(posedge clk) begin
        word_valid <= asked_2 && !rst;
        word <= part_2 == COLOUR ? colour_word : part_2 == DEPTH_LEFT ? depth_left_word : depth_right_word;
    end

    logic                    sent_valid;
    logic [127:0]            sent;
    logic [ADDRESS_BITS-1:0] sent_address;

    if (AVERAGE) begin : averaged
        // The four rows of a word are requested in successive clocks, because a free FIFO entry and a colour of the sky stay until the last
        // of them. The sums have the threshold 2·t1 + t0 of their pixel: t1 in each of both pairs, t0 in their sum.
        logic       odd_word, is_left, was_left;
        logic [3:0] t1, t0;
        logic [63:0]      half, left_half;
        logic [1:0]       corner_word;
        logic             ends_pairs, ends_sums;
        logic [ADDRESS_BITS-1:0] address_sums;

        delay #(.WIDTH(3), .CLOCKS(4)) corners (.clk, .enable(1'b1), .in({odd, corner}), .out({odd_word, corner_word}));
        delay #(.WIDTH(ADDRESS_BITS), .CLOCKS(2)) addresses (.clk, .enable(1'b1), .in(address), .out(address_sums));

        for (genvar i = 0; i < 4; i++) begin : pixels
            logic [18:0] pair, previous;

            always_ff @(posedge clk) begin
                pair             <= colour_pkg::pair(word[32*i +: 16], word[32*i+16 +: 16], t1[i]);
                previous         <= pair;
                half[16*i +: 16] <= colour_pkg::average(pair, previous, t0[i]);
            end
        end

        assign t1 = dithers ? {odd_word, !odd_word, !odd_word, odd_word} : '1;

        always_ff @(posedge clk) begin
            t0 <= dithers ? {!odd_word, !odd_word, odd_word, odd_word} : '0;
            is_left  <= corner_word == 2'd1;
            was_left <= is_left;
            if (was_left) left_half <= half;
            ends_pairs <= word_valid && averaging && !rst;
            ends_sums  <= ends_pairs && !rst;
        end

        assign sent_valid   = averaging ? ends_sums : word_valid;
        assign sent_address = averaging ? address_sums : address;
        assign sent         = averaging ? {half, left_half} : word;
    end else begin : direct
        assign {sent_valid, sent_address, sent} = {word_valid, address, word};
    end

    // A FIFO entry is reserved for each requested word, so `word_ready` is high whenever a word arrives.
    fifo #(.WIDTH(ADDRESS_BITS + 128), .DEPTH(WORDS), .DIRECT(1'b1)) words (
        .clk, .rst,
        .in_valid(sent_valid), .in_ready(word_ready), .in_data({sent_address, sent}),
        .out_valid, .out_ready, .out_data({out_addr, out_data})
    );

    assign taken = out_valid && out_ready;
    assign asked = issue && word_ends;

    always_ff @(posedge clk) begin
        if (taken && !asked)      places <= places + 1'b1;
        else if (!taken && asked) places <= places - 1'b1;

        if (rst) places <= COUNT_BITS'(WORDS);
    end

    wire _unused = &{1'b0, word_ready, composing};
endmodule

`default_nettype wire

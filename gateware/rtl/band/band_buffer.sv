// The band buffer: block RAM for colour and depth of a band (a horizontal strip of the picture, at most 15,360 pixels), shared
// by all renderers. While one band is drawn, the previous band is flushed to memory. Of each line, the flush only writes the words from the
// first to the last word that was drawn in this frame or in the last frame of the same frame buffer.
//
//                        ┌────────────┐  drawn  ┌─────────────────┐ flushed  ┌────────────┐
//   groups ─▶ band_pipe ─┤            ├────────▶│ colour bank 0/1 │─────────▶│            │
//        │       ▲       │            │         ├─────────────────┤          │ band_flush │─▶ words
//        │       └───────┤  compare   │◀───────▶│ depth (shared)  │┄ debug ┄▶│            │
//        │               └────────────┘         └─────────────────┘          └─────▲──────┘
//        │               ┌──────────────┐             rows to write                │
//        └──────────────▶│ band_extents │──────────────────────────────────────────┘
//                        └──────────────┘
//
// A row of these memories holds eight neighbouring pixels. Its address is line * (W/8) + column, with W the width of the
// picture, line = y in the band, and column = x/8. Besides its colour each pixel has a written bit; a bank is clear when no written bit is
// set. A pixel whose written bit is 0 has depth 0 and the clear colour, but neither value is stored. Both banks can therefore share one
// depth memory, and the clear colour may change from band to band. The flush resets the written bits of each row that it has read, so
// clearing takes no clock of its own. The buffer takes 25 RAMB36.
//
// Groups: {row, line, column, mask, eight depth codes u18, eight colours RGB565}, lane 0 (the leftmost) in the lowest bits.
// Lane i is written if mask[i] is set and code[i] is at least the stored depth code. With STEREO a group may belong to one eye:
// `halves` is 1 for the left eye and 2 for the right one, and the corresponding half of each colour is the eye's luminance. Such a group is
// written without a depth test, and only the depth of the left eye is stored. The flush composes the colours of both eyes, see band_flush;
// every pixel must then be drawn for both eyes. Without DEPTHS there is no depth memory: each stored depth counts as 0, so every lane of
// the mask is written. Throughput one group per clock; band_pipe explains the hazards.
//
// With BLEND, pixels can be blended with the stored colours: first a group asks for the lanes that pass the depth test, then groups of one
// blended pixel each follow (band_pipe). From the answer until the last of these groups, `behind` is the stored colour in this row of the
// lane that `behind_lane` selected in the previous clock; for a pixel not yet written it is `band_clear`, which must be constant while
// groups are blended. After the answer `group_ready` stays high until the last blended pixel, because the lanes of these pixels are not in
// the pipe. `group_row` must hold from the group that asks until then.
//
// Bands: an item of the stream `band_*` ends the drawing of a band and has the parameters of its flush: the address of its first
// 128-bit word, its `lines` (at least 1), `stride` (rows of a line) and clear colour. Groups accepted up to and including the first clock
// of `band_valid` belong to the band. After this clock no group is accepted until the item has moved. The item moves when the last group is
// written and the previous band is in memory; in this clock the banks are exchanged.
//
// There are two frame buffers in memory, `slot` 0 and 1. For each line of their pictures (from `first_line` on) the band buffer stores one
// extent: the words of the line that may differ from the clear colour since the last flush to this slot. The union of that extent and of
// the words drawn now is written to memory. With `whole` all words are written to memory. `whole` is required if the lines in the frame
// buffer have changed since the last flush to this slot, or if the clear colour or the stride differs from that flush.
//
// With SKY, a band with `band_sky` has, in place of the clear colour, a colour of the stream `sky_*` for each of its words, in the order of
// the words. It must be `whole`.
//
// With AVERAGE, a band with `band_average` holds four samples for each pixel: its lines must be an even number of whole lines in memory, and
// it must be `whole`. `band_gap` is the number of words in memory between its lines (band_flush).
//
// `with_depth` is for debugging: the depths of the whole band are also written to memory, as 32-bit words from `depth_base` on, and
// `whole` is implied. The next band is drawn only after this flush, which writes three words per row.
//
// `restart` (and reset) drops the band that is being drawn and stops the flush. Words that were already read, at most 16, are still sent to
// memory. Then both banks are cleared: for 2,048 clocks `clearing` is high, and no group or band is accepted. This time does not depend on
// memory. After `restart`, the next flush of the interrupted band's lines to the same slot must be `whole`; after a reset, the first flush
// of every line to each slot. The renderers must also be restarted, because the band buffer accepts all groups and bands that they offer
// afterwards.
//
// Stream protocol as in `fifo`. Words for memory: see band_flush. `flushed` is high when memory has taken all words of all bands.

`default_nettype none

module band_buffer #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter bit          STEREO       = 1'b0,
    parameter bit          DEPTHS       = 1'b1,
    parameter bit          BLEND        = 1'b0,
    parameter bit          SKY          = 1'b0,
    parameter bit          AVERAGE      = 1'b0
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire                     restart,
    output logic                    clearing,
    output logic                    flushed,
    // Groups.
    input  wire                     group_valid,
    output logic                    group_ready,
    input  wire  [10:0]             group_row,
    input  wire  [5:0]              group_line,
    input  wire  [7:0]              group_column,
    input  wire  [7:0]              group_mask,
    input  wire  [1:0]              group_halves,
    input  wire  [8*18-1:0]         group_codes,
    input  wire  [8*16-1:0]         group_colours,
    // Blended pixels.
    input  wire                     group_asks,
    input  wire                     group_blended,
    output logic                    answer_valid,
    output logic [7:0]              answer_lanes,
    input  wire  [2:0]              behind_lane,
    output logic [15:0]             behind,
    // Bands.
    input  wire                     band_valid,
    output logic                    band_ready,
    input  wire  [ADDRESS_BITS-1:0] band_base,
    input  wire  [ADDRESS_BITS-1:0] band_depth_base,
    input  wire  [5:0]              band_lines,
    input  wire  [7:0]              band_stride,
    input  wire  [9:0]              band_first_line,
    input  wire                     band_slot,
    input  wire                     band_whole,
    input  wire                     band_with_depth,
    input  wire  [15:0]             band_clear,
    input  wire  [1:0]              band_compose,
    input  wire                     band_average,
    input  wire  [7:0]              band_gap,
    input  wire                     band_sky,
    input  wire                     band_dither,
    // Colours of the sky, one for each row of a band with `band_sky`.
    input  wire                     sky_valid,
    output logic                    sky_ready,
    input  wire  [1:0]              sky_line,
    input  wire  [23:0]             sky_colour,
    // Words for memory.
    output logic                    word_valid,
    input  wire                     word_ready,
    output logic [ADDRESS_BITS-1:0] word_addr,
    output logic [127:0]            word_data,
    output triangle_registers_pkg::events_t events
);
    localparam int unsigned ROW_BITS = 11;

    // `drawn` is the number of the colour bank that is drawn; the other bank is flushed. `closing` is high while the end of the band waits
    // for the band's last groups and for the flush of the previous band. `swap` is high in the clock in which the banks are exchanged.
    logic drawn, closing, swap;

    // State of band_pipe, which draws, and its signals to and from the memories.
    logic                open, empty, held;
    logic [ROW_BITS-1:0] draw_read_row, draw_write_row;
    logic [7:0]          draw_lanes, draw_depths, drawn_lanes, drawn_written;
    logic [1:0]          draw_halves;
    logic [8*18-1:0]     draw_codes, stored_codes;
    logic [8*16-1:0]     draw_colours;
    // State of band_flush, which reads and clears the bank that is not drawn, and its signals to and from the memories.
    logic                flush_idle, flush_reads_depth, flush_waits, flush_clears;
    logic [ROW_BITS-1:0] flush_row, flush_clear_row;
    logic [8*16-1:0]     flushed_colours;
    logic [7:0]          flushed_written;

    assign flushed    = flush_idle;
    assign band_ready = closing && empty && flush_idle;
    assign swap       = band_valid && band_ready;

    always_ff @(posedge clk) begin
        closing <= band_valid && !swap && !clearing;
        if (swap) drawn <= !drawn;
        // `open` is !clearing && !closing && !flush_reads_depth, registered; after clearing and after a flush of depths it rises one clock
        // later.
        open    <= !(clearing || flush_reads_depth || rst || restart || (swap ? band_with_depth : band_valid));

        if (rst || restart) closing <= 1'b0;
        if (rst) drawn <= 1'b0;
    end

    band_pipe #(.ROW_BITS(ROW_BITS), .BLEND(BLEND)) pipe (
        .clk, .rst, .open,
        .group_valid, .group_ready, .group_row, .group_mask, .group_halves(STEREO ? group_halves : 2'b11), .group_codes, .group_colours,
        .group_asks, .group_blended, .answer_valid, .answer_lanes,
        .read_row(draw_read_row), .stored(stored_codes), .stored_written(drawn_written),
        .write_row(draw_write_row), .write_lanes(draw_lanes), .write_depths(draw_depths), .write_halves(draw_halves),
        .write_codes(draw_codes), .write_colours(draw_colours), .drawn_lanes, .empty, .held
    );

    logic                span_valid, span_ready, spans_busy;
    logic [ROW_BITS-1:0] span_first, span_last;

    band_extents #(.ROW_BITS(ROW_BITS)) extents (
        .clk, .rst, .sweep(clearing), .drawn,
        .group_valid(group_valid && group_ready && group_mask != '0 && !(BLEND && group_asks)), .group_line, .group_column,
        .start(swap), .lines(band_lines), .stride(band_stride), .first_line(band_first_line), .slot(band_slot),
        .whole(band_whole || band_with_depth), .busy(spans_busy), .span_valid, .span_ready, .span_first, .span_last
    );

    band_flush #(.ADDRESS_BITS(ADDRESS_BITS), .ROW_BITS(ROW_BITS), .STEREO(STEREO), .SKY(SKY), .AVERAGE(AVERAGE)) flush (
        .clk, .rst,
        .start(swap), .base(band_base), .depth_base(band_depth_base), .with_depth(band_with_depth),
        .clear_colour(band_clear), .with_sky(band_sky), .dither(band_dither), .compose(band_compose), .average(band_average),
        .stride(band_stride), .gap(band_gap), .restart, .idle(flush_idle), .sweeping(clearing),
        .reads_depth(flush_reads_depth), .waits(flush_waits),
        .span_valid, .span_ready, .span_first, .span_last, .spans_busy,
        .row(flush_row), .colours(flushed_colours), .codes(stored_codes), .written(flushed_written),
        .clears(flush_clears), .clear_row(flush_clear_row), .sky_valid, .sky_ready, .sky_line, .sky_colour,
        .out_valid(word_valid), .out_ready(word_ready), .out_addr(word_addr), .out_data(word_data)
    );

    // A pixel in a colour bank is {written, colour}; with STEREO it is {written, half of the colour} for each half.
    localparam int unsigned PIXEL_BITS = STEREO ? 18 : 17;
    localparam int unsigned HALVES     = STEREO ? 2 : 1;
    logic [8*PIXEL_BITS-1:0] bank_pixels [0:1];
    logic [8*16-1:0] bank_colours [0:1];
    logic [7:0]      bank_written [0:1];

    for (genvar bank = 0; bank < 2; bank++) begin : banks
        logic                    flushes;
        logic [8*PIXEL_BITS-1:0] store;
        // During clearing, groups that are still in the pipe are not written.
        assign flushes = clearing || drawn != 1'(bank);

        for (genvar lane = 0; lane < 8; lane++) begin : lanes
            if (STEREO) begin : halves
                logic [17:0] pixel;
                assign pixel = bank_pixels[bank][18*lane +: 18];
                assign store[18*lane +: 18] = {
                    !flushes, draw_colours[16*lane+8 +: 8], !flushes, draw_colours[16*lane +: 8]
                };
                assign bank_written[bank][lane] = pixel[8];
                assign bank_colours[bank][16*lane +: 16] = {pixel[16:9], pixel[7:0]};
                wire _unused = pixel[17];
            end else begin : whole
                assign store[17*lane +: 17] = {!flushes, draw_colours[16*lane +: 16]};
                assign {bank_written[bank][lane], bank_colours[bank][16*lane +: 16]} = bank_pixels[bank][17*lane +: 17];
            end
        end

        band_bank #(.WIDTH(PIXEL_BITS), .ROW_BITS(ROW_BITS), .HALVES(HALVES)) pixels (
            .clk,
            .read_row(flushes ? flush_row : draw_read_row),
            .read_data(bank_pixels[bank]),
            .write_row(flushes ? flush_clear_row : draw_write_row),
            .write_lanes(flushes ? {8{flush_clears}} : draw_lanes),
            .write_halves(draw_halves[HALVES-1:0] | {HALVES{flushes}}),
            .write_data(store)
        );
    end

    assign drawn_written   = bank_written[drawn];
    assign flushed_written = bank_written[!drawn];
    assign flushed_colours = bank_colours[!drawn];

    if (DEPTHS) begin : of_depths
        band_bank #(.WIDTH(18), .ROW_BITS(ROW_BITS)) depths (
            .clk,
            .read_row(flush_reads_depth ? flush_row : draw_read_row),
            .read_data(stored_codes),
            .write_row(draw_write_row),
            .write_lanes(draw_depths & {8{draw_halves[0]}}),
            .write_halves(1'b1),
            .write_data(draw_codes)
        );
    end else begin : without_depths
        assign stored_codes = '0;
        wire _unused = &{1'b0, draw_codes, draw_depths};
    end

    if (BLEND) begin : blend
        // The pixels of both banks.
        logic [15:0]      written;
        logic [16*16-1:0] colours;
        logic [3:0]       place;

        assign written = {bank_written[1], bank_written[0]};
        assign colours = {bank_colours[1], bank_colours[0]};
        assign place   = {drawn, behind_lane};

        always_ff @(posedge clk) behind <= written[place] ? colours[{place, 4'd0} +: 16] : band_clear;
    end else begin : plain
        assign behind = '0;
        wire _unused = &{1'b0, behind_lane};
    end

    // Without STEREO both halves of a colour are always written.
    wire _unused_half = draw_halves[1];

    function automatic logic [3:0] ones(input logic [7:0] lanes);
        ones = '0;
        for (int i = 0; i < 8; i++) ones = ones + 4'(lanes[i]);
    endfunction

    // Masks of the covered and drawn pixels, and the other events: registered, so the events leave the module one clock late.
    logic [7:0] covered_mask, drawn_mask;
    logic       group_taken, was_held, waited, waited_for_flush;

    always_ff @(posedge clk) begin
        // Blended pixels have been counted with the group that asked.
        group_taken      <= group_valid && group_ready && !(BLEND && group_blended);
        covered_mask     <= group_mask;
        drawn_mask       <= drawn_lanes;
        was_held         <= held;
        waited           <= flush_waits;
        waited_for_flush <= closing && empty && !flush_idle;
    end

    always_comb begin
        events = '0;
        events.groups         = group_taken;
        events.pixels_covered = group_taken ? ones(covered_mask) : '0;
        events.pixels_drawn   = ones(drawn_mask);
        events.cycles_held    = was_held;
        events.cycles_memory  = waited;
        events.cycles_flush   = waited_for_flush;
    end
endmodule

`default_nettype wire

// Proof of band_flush, which writes the rows of a band from a bank of the band buffer to memory and clears them. The size is small: a flush
// has any of four rows in any spans (ranges of rows), and four words may be requested at a time. Back-pressure and restarts occur at any
// time.
//
// Row r of the bank holds r in every colour and r + 1 in every depth, and all its pixels but the rightmost are drawn. The expected words
// are therefore the colours of the rows in the spans, in order, each once, and both halves of each row's depths, after its colours. The
// rightmost pixel has the clear colour, or, in a flush with a sky, the number of its word. After the flush these
// rows must be clear, and the other rows must not be clear. The model of the bank has the latencies of band_bank; a cleared row loses its
// pixels.

`default_nettype none

module band_flush_proof (
    input wire       clk,
    input wire       start,
    // Mask of the rows to flush. The proof offers these rows to the module at any time (`gives`): neighbouring rows as one span, or each
    // row as a span (`in_pieces`).
    input wire [3:0] rows,
    input wire       gives,
    input wire       in_pieces,
    input wire       lingers,
    input wire       with_depth,
    input wire       with_sky,
    input wire       sky_valid,
    input wire       restart,
    input wire       out_ready
);
    localparam logic [15:0] BACKGROUND = 16'h8421;
    // Upper bound on the clocks between two words while memory accepts all words.
    localparam int unsigned WITHIN = 10;

    (* anyconst *) logic [5:0] base, depth_base;
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic             idle, sweeping, clears, out_valid;
    logic [1:0]       row, clear_row;
    logic [5:0]       out_addr;
    logic [127:0]     out_data;
    logic [8*16-1:0]  colours;
    logic [8*18-1:0]  codes;
    logic [7:0]       written;

    logic             span_valid, span_ready, spans_busy;
    logic [1:0]       span_first, span_last;

    logic             sky_ready;
    logic [2:0]       sky_number;

    band_flush #(.ADDRESS_BITS(6), .ROW_BITS(2), .COLUMN_BITS(2), .WORDS(4), .SKY(1)) dut (
        .clk, .rst, .start, .base, .depth_base, .with_depth, .compose('0), .average(1'b0), .stride('0), .gap('0), .clear_colour(BACKGROUND),
        .with_sky, .dither(1'b1), .restart,
        .sky_valid, .sky_ready, .sky_line(2'd0), .sky_colour({5'(sky_number), 3'd0, 16'd0}),
        .idle, .sweeping, .reads_depth(), .waits(),
        .span_valid, .span_ready, .span_first, .span_last, .spans_busy,
        .row, .colours, .codes, .written, .clears, .clear_row,
        .out_valid, .out_ready, .out_addr, .out_data
    );

    function automatic logic [17:0] depth_of(input logic [1:0] of_row);
        depth_of = 18'(of_row) + 1'b1;
    endfunction

    // Model of the bank. Bit r of `drawn` is set while row r has drawn pixels; at the start of a flush all bits are set.
    logic [3:0] drawn;
    logic [1:0] from_row, latched_row, read_row, to_row;
    logic       latched_drawn, read_drawn, to_clear;

    assign colours = {8{14'b0, read_row}};
    assign codes   = {8{depth_of(read_row)}};
    assign written = {1'b0, {7{read_drawn}}};

    always_ff @(posedge clk) begin
        from_row      <= row;
        latched_row   <= from_row;
        read_row      <= latched_row;
        latched_drawn <= drawn[from_row];
        read_drawn    <= latched_drawn;
        to_row        <= clear_row;
        to_clear      <= clears;
        if (to_clear) drawn[to_row] <= 1'b0;
        if (start) begin
            drawn    <= '1;
            to_clear <= 1'b0;
        end
        if (rst) to_clear <= 1'b0;
    end

    function automatic logic [1:0] first_of(input logic [3:0] of_rows);
        first_of = of_rows[0] ? 2'd0 : of_rows[1] ? 2'd1 : of_rows[2] ? 2'd2 : 2'd3;
    endfunction

    // `to_give` is the set of rows that the module has not yet taken in a span. `lingering` keeps `spans_busy` high, so that the module
    // must wait for more spans even if no rows remain.
    logic [3:0] to_give;
    logic       offered, pieces, lingering;

    assign span_valid = to_give != '0 && offered;
    assign span_first = first_of(to_give);
    assign spans_busy = to_give != '0 || lingering;

    always_comb begin
        span_last = span_first;
        for (int i = 1; i < 4; i++)
            if (!pieces && to_give[i] && span_last == 2'(i - 1) && 2'(i) > span_first) span_last = 2'(i);
    end

    always_ff @(posedge clk) begin
        offered <= span_valid && !span_ready || gives;
        if (!span_valid || span_ready) pieces <= in_pieces;
        for (int i = 0; i < 4; i++)
            if (span_valid && span_ready && 2'(i) <= span_last) to_give[i] <= 1'b0;
        if (!lingers) lingering <= 1'b0;
        if (start) begin
            to_give   <= rows;
            lingering <= 1'b1;
        end
        if (rst || sweeping) begin
            to_give   <= '0;
            lingering <= 1'b0;
        end
    end

    // The expected words: masks of the rows whose colours, and of the rows whose depths, have not been output yet, and the half of a row's
    // depths that is expected next.
    logic [5:0] flush_base, flush_depth_base, expected_addr;
    logic [3:0] flush_rows, colour_rows, depth_rows;
    logic [1:0] colour_row, depth_row;
    logic       half, flush_depth, flushing, moves, is_depth, dropped, none_left;

    assign moves      = out_valid && out_ready;
    assign colour_row = first_of(colour_rows);
    assign depth_row  = first_of(depth_rows);
    assign none_left  = colour_rows == '0 && depth_rows == '0;
    // Whether the word holds depths. The lowest 32 bits of a word are either a depth, whose halves differ, or two neighbouring colours,
    // which are equal.
    assign is_depth   = out_data[31:16] != out_data[15:0];

    // The number of colour words of the flush that have been output.
    logic [2:0]   word_number;
    logic         flush_sky;
    logic [127:0] expected;
    always_comb begin
        expected = is_depth ? {4{14'b0, depth_of(depth_row)}} : {8{14'b0, colour_row}};
        if (!is_depth)  expected[127:112] = flush_sky ? 16'(word_number) : BACKGROUND;
        else if (half)  expected[127:96]  = '0;
    end
    assign expected_addr = is_depth ? flush_depth_base + {3'b0, depth_row, half} : flush_base + 6'(colour_row);

    logic [3:0] without_word, without_end, sweep_clocks;

    always_ff @(posedge clk) begin
        if (moves && is_depth) begin
            half <= !half;
            if (half) depth_rows[depth_row] <= 1'b0;
        end
        if (moves && !is_depth) colour_rows[colour_row] <= 1'b0;
        if (start) begin
            flushing         <= 1'b1;
            dropped          <= restart;
            flush_base       <= base;
            flush_depth_base <= depth_base;
            flush_depth      <= with_depth;
            flush_rows       <= rows;
            flush_sky        <= with_sky;
            colour_rows      <= rows;
            depth_rows       <= with_depth ? rows : '0;
            half             <= 1'b0;
        end else begin
            if (idle) flushing <= 1'b0;
            if (restart) dropped <= 1'b1;
        end

        sky_number  <= start ? '0 : sky_number + 3'(sky_ready);
        word_number <= start ? '0 : word_number + 3'(moves && !is_depth);
        without_word <= idle || sweeping || moves || !out_ready || spans_busy && !span_valid || flush_sky && !sky_valid
                        ? '0 : without_word + 1'b1;
        without_end  <= idle || sweeping || dropped || spans_busy || !none_left ? '0 : without_end + 1'b1;
        sweep_clocks <= !sweeping || restart ? '0 : sweep_clocks + 1'b1;

        if (rst) begin
            colour_rows  <= '0;
            depth_rows   <= '0;
            flushing     <= 1'b0;
            dropped      <= 1'b1;
            without_word <= '0;
            without_end  <= '0;
            sweep_clocks <= '0;
        end
    end

    stream_checker #(.WIDTH(6 + 128)) words (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data({out_addr, out_data})
    );

    // A row of the bank is clear two clocks after the request to clear it, so `drawn` is compared two clocks after a sweep.
    logic [1:0] settled;
    logic       fresh;
    always_ff @(posedge clk) begin
        if (settled != '1) settled <= settled + 1'b1;
        if (start) fresh <= 1'b0;
        if (sweeping) begin
            settled <= '0;
            fresh   <= 1'b1;
        end
        if (rst) fresh <= 1'b0;
    end

    always_ff @(posedge clk) if (!rst) begin
        assume (!start || idle);

        words_in_order:    assert (!out_valid || out_data == expected);
        in_their_places:   assert (!out_valid || out_addr == expected_addr);
        sky_in_time:       assert (!sky_ready || sky_valid && flush_sky);
        none_made_up:      assert (!out_valid || (is_depth ? depth_rows : colour_rows) != '0);
        colour_first:      assert (!out_valid || !is_depth || !colour_rows[depth_row]);
        all_taken:         assert (!idle || !out_valid);
        none_left_out:     assert (!(flushing && idle) || dropped || none_left);
        no_standstill:     assert (without_word < 4'(WITHIN));
        ends:              assert (without_end < 4'd4);
        sweep_ends:        assert (sweep_clocks < 4'd5);
        all_swept:         assert (!(fresh && settled == 2'd2) || drawn == '0);
        // After a flush the flushed rows are clear, and all other rows are not clear.
        cleared_behind:    assert (!(flushing && idle) || dropped || drawn == ~flush_rows);
        flushed:           cover (flushing && idle && !dropped && flush_rows == 4'b1001);
        deep:              cover (flushing && idle && !dropped && flush_depth && flush_rows == 4'b0100);
        stopped:           cover (flushing && idle && dropped && !none_left);
    end
endmodule

`default_nettype wire

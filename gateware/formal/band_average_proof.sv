// Proof of the averages of band_flush: each word is the average of four rows, side by side in each of two lines. The size is small: a line
// has two rows, and a band one or two pairs of lines, so the rows of the first word are 0, 1, 2 and 3, and those of the second word 4, 5, 6
// and 7. Two words may be requested at a time. Back-pressure and restarts occur at any time.
//
// All pixels of a row except the rightmost have the same colour, one of two. The rightmost pixel is not drawn: it has the clear colour, or,
// in a flush with a sky, the number of its word, dithered. After the flush the rows must be clear, and rows of other lines must not be
// clear.

`default_nettype none

module band_average_proof (
    input wire       clk,
    input wire       start,
    // Whether the flush has both pairs of lines.
    input wire       both,
    input wire       gives,
    input wire       with_sky,
    input wire       sky_valid,
    input wire       restart,
    input wire       out_ready
);
    localparam logic [15:0] BACKGROUND = 16'h8421;
    // Upper bound on the clocks between two words while memory accepts all words.
    localparam int unsigned WITHIN = 13;

    (* anyconst *) logic [5:0] base;
    (* anyconst *) logic [1:0] gap;
    (* anyconst *) logic [7:0] contents;
    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic             idle, sweeping, clears, out_valid;
    logic [2:0]       row, clear_row;
    logic [5:0]       out_addr;
    logic [127:0]     out_data;
    logic [8*16-1:0]  colours;
    logic [7:0]       written;
    logic             span_valid, span_ready;
    logic [2:0]       span_first;
    logic             sky_ready;
    logic [1:0]       sky_number;

    band_flush #(.ADDRESS_BITS(6), .ROW_BITS(3), .COLUMN_BITS(2), .WORDS(2), .SKY(1), .AVERAGE(1)) dut (
        .clk, .rst, .start, .base, .depth_base('0), .with_depth(1'b1), .compose('0), .average(1'b1), .stride(2'd2), .gap,
        .clear_colour(BACKGROUND), .with_sky, .dither(1'b1), .restart,
        .sky_valid, .sky_ready, .sky_line(sky_number), .sky_colour({16'd0, 3'd0, sky_number, 3'd3}),
        .idle, .sweeping, .reads_depth(), .waits(),
        .span_valid, .span_ready, .span_first, .span_last(span_first + 3'd1), .spans_busy(lines_left != '0),
        .row, .colours, .codes('0), .written, .clears, .clear_row,
        .out_valid, .out_ready, .out_addr, .out_data
    );

    // The colour of a row: all channels 0, or all channels 1.
    function automatic logic [15:0] colour(input logic content);
        colour = {4'd0, content, 5'd0, content, 4'd0, content};
    endfunction

    // Model of the bank. Bit r of `drawn` is set while row r has drawn pixels; at the start of a flush all bits are set.
    logic [7:0] drawn;
    logic [2:0] from_row, latched_row, read_row, to_row;
    logic       latched_drawn, read_drawn, to_clear;

    assign colours = {8{colour(contents[read_row])}};
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

    // The lines that the module has not yet taken as spans.
    logic [2:0] lines_left, lines;
    logic       offered;

    assign lines      = both ? 3'd4 : 3'd2;
    assign span_valid = lines_left != '0 && offered;
    assign span_first = {2'(flush_lines - lines_left), 1'b0};

    // The words that have been output, the words that are expected, and their colours.
    logic [2:0]   flush_lines;
    logic [5:0]   flush_base;
    logic [1:0]   word_number;
    logic         flush_sky, flushing, dropped, moves, none_left;
    logic [127:0] expected;
    logic [5:0]   expected_addr;

    assign moves         = out_valid && out_ready;
    assign none_left     = word_number == flush_lines[2:1];
    assign expected_addr = flush_base + (word_number[0] ? 6'(gap) + 6'd1 : '0);

    // The average of four samples for the pixel in this column, in a line with this parity.
    function automatic logic [15:0] average(input logic [4*16-1:0] samples, input logic [1:0] column, input logic odd);
        logic [1:0] threshold;
        logic [6:0] red, blue;
        logic [7:0] green;
        case ({odd, column})
            3'd0, 3'd6: threshold = 2'd0;
            3'd3, 3'd5: threshold = 2'd1;
            3'd1, 3'd7: threshold = 2'd2;
            default:    threshold = 2'd3;
        endcase
        {red, blue, green} = {7'(threshold), 7'(threshold), 8'(threshold)};
        for (int i = 0; i < 4; i++) begin
            red   = red + 7'(samples[16*i+11 +: 5]);
            green = green + 8'(samples[16*i+5 +: 6]);
            blue  = blue + 7'(samples[16*i +: 5]);
        end
        average = {red[6:2], green[7:2], blue[6:2]};
    endfunction

    // The rightmost sample of a line of samples, with the clear colour or the colour of the sky.
    function automatic logic [15:0] behind(input logic sky, input logic [1:0] number, input logic lower);
        behind = sky ? colour_pkg::rounded({16'd0, 3'd0, number, 3'd3}, colour_pkg::threshold(1'b1, 2'd3, {number[0], lower})) : BACKGROUND;
    endfunction

    // The colours of the rows of the expected word.
    logic [3:0] of_word;

    assign of_word = word_number[0] ? contents[7:4] : contents[3:0];

    for (genvar i = 0; i < 8; i++) begin : pixels
        // The left four pixels are those of rows 0 and 2 of the word, the right four those of its rows 1 and 3.
        logic [15:0] upper, lower, upper_right, lower_right;

        assign upper       = colour(of_word[i > 3 ? 1 : 0]);
        assign lower       = colour(of_word[i > 3 ? 3 : 2]);
        assign upper_right = i % 4 == 3 ? behind(flush_sky, word_number, 1'b0) : upper;
        assign lower_right = i % 4 == 3 ? behind(flush_sky, word_number, 1'b1) : lower;

        assign expected[16*i +: 16] = average({upper, upper_right, lower, lower_right}, 2'(i), word_number[0]);
    end

    logic [3:0] without_word, without_end;

    always_ff @(posedge clk) begin
        offered <= span_valid && !span_ready || gives;
        if (span_valid && span_ready) lines_left <= lines_left - 3'd1;
        if (moves) word_number <= word_number + 2'd1;
        if (sky_ready) sky_number <= sky_number + 2'd1;
        if (start) begin
            lines_left  <= lines;
            flush_lines <= lines;
            flush_base  <= base;
            flush_sky   <= with_sky;
            word_number <= '0;
            sky_number  <= '0;
            flushing    <= 1'b1;
            dropped     <= restart;
        end else begin
            if (idle) flushing <= 1'b0;
            if (restart) dropped <= 1'b1;
        end
        without_word <= idle || sweeping || moves || !out_ready || lines_left != '0 && !span_valid || flush_sky && !sky_valid
                        ? '0 : without_word + 1'b1;
        without_end  <= idle || sweeping || dropped || lines_left != '0 || !none_left ? '0 : without_end + 1'b1;

        if (rst || sweeping) lines_left <= '0;
        if (rst) begin
            flushing     <= 1'b0;
            dropped      <= 1'b1;
            without_word <= '0;
            without_end  <= '0;
        end
    end

    stream_checker #(.WIDTH(6 + 128)) words (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data({out_addr, out_data})
    );

    always_ff @(posedge clk) if (!rst) begin
        assume (!start || idle);
        // A colour of the sky stays until it is taken.
        assume (!$past(flush_sky && sky_valid && !sky_ready && !start) || sky_valid);

        words_in_order:  assert (!out_valid || out_data == expected);
        in_their_places: assert (!out_valid || out_addr == expected_addr);
        sky_in_time:     assert (!sky_ready || sky_valid && flush_sky);
        none_made_up:    assert (!out_valid || !none_left);
        all_taken:       assert (!idle || !out_valid);
        none_left_out:   assert (!(flushing && idle) || dropped || none_left);
        no_standstill:   assert (without_word < 4'(WITHIN));
        ends:            assert (without_end < 4'd4);
        // After a flush the flushed rows are clear, and all other rows are not clear.
        cleared_behind:  assert (!(flushing && idle) || dropped || drawn == (flush_lines[2] ? 8'h00 : 8'hF0));
        flushed:         cover (flushing && idle && !dropped && flush_lines[2] && flush_sky);
        stopped:         cover (flushing && idle && dropped && !none_left);
    end
endmodule

`default_nettype wire

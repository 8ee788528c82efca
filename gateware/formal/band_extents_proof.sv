// Proof of band_extents, which computes for each line of a band the span of words that the flush of the band writes. The size is
// small: bands of one to four lines with one to three columns (words of eight pixels), and two frame buffers of four lines.
// Bands, groups (each draws one column of a line), and the times at which spans are taken are arbitrary.
//
// The proof stores a set of columns for each line of the current band (the columns drawn so far), and a set of columns for each line of a
// frame buffer (the columns drawn there in the last flushed band). The expected span of a line is from the first to the last column of the
// union of both sets. After a reset the second set is unknown for all lines, and after a cancelled band for the lines of that band; a band
// with such a line must be flushed `whole`.

`default_nettype none

module band_extents_proof (
    input wire       clk,
    input wire       group_valid,
    input wire [1:0] group_line,
    input wire [1:0] group_column,
    input wire       start,
    input wire [1:0] first_line,
    input wire       slot,
    input wire       whole,
    input wire       span_ready,
    input wire       restart
);
    // Upper bound on the clocks until the next expected span is valid, and on the clocks from the last span until `busy` falls.
    localparam int unsigned WITHIN = 10;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    (* anyconst *) logic [1:0] last_line, stride;

    logic       sweep, drawn, busy, span_valid;
    logic [3:0] span_first, span_last;

    band_extents #(.ROW_BITS(4), .LINE_BITS(2), .COLUMN_BITS(2), .PICTURE_BITS(2)) dut (
        .clk, .rst, .sweep, .drawn, .group_valid, .group_line, .group_column,
        .start, .lines(last_line + 1'b1), .stride, .first_line, .slot, .whole, .busy,
        .span_valid, .span_ready, .span_first, .span_last
    );

    stream_checker #(.WIDTH(8)) spans (
        .clk, .rst(rst || sweep), .valid(span_valid), .ready(span_ready), .data({span_first, span_last})
    );

    // Sets of columns of each line. `marked` is the set of the band's drawn columns, and `to_come` the set of columns of a span that is
    // still expected. `left` is, for each frame buffer, the set of columns drawn in the last flushed band.
    logic [3:0][2:0]      marked, to_come;
    logic [1:0][3:0][2:0] left;
    logic [1:0][3:0]      known;
    logic [2:0]           all;
    // First line and slot (number of the frame buffer) of the band whose spans are expected, and the number of clocks since the start of
    // the sweep, which clears the extents after a reset or restart.
    logic [1:0]           band_line, swept;
    logic                 band_slot, all_known;

    assign all = {stride == 2'd3, stride >= 2'd2, 1'b1};

    function automatic logic [2:0] hull(input logic [2:0] columns);
        hull = columns == 3'b101 ? 3'b111 : columns;
    endfunction

    // Whether a span is expected (`comes`), and for the next span: its line, the number of this line's first word in the band, and its set
    // of columns.
    logic       comes;
    logic [1:0] next_line;
    logic [3:0] next_row;
    logic [2:0] next;

    always_comb begin
        comes     = 1'b0;
        next_line = '0;
        for (int i = 3; i >= 0; i--) begin
            if (to_come[i] != '0) begin
                comes     = 1'b1;
                next_line = 2'(i);
            end
        end
        next     = to_come[next_line];
        next_row = next_line * stride;

        all_known = 1'b1;
        for (int i = 0; i < 4; i++)
            if (2'(i) <= last_line && !known[slot][2'(first_line + i)]) all_known = 1'b0;
    end

    logic [3:0] without_span, without_end;
    // Condition of the cover `both`: a band is not `whole`, and one of its lines has drawn columns, but not all columns that the last band
    // has drawn in this line of the frame buffer.
    logic       united;

    always_ff @(posedge clk) begin
        if (group_valid) marked[group_line][group_column] <= 1'b1;
        if (span_valid && span_ready) to_come[next_line] <= '0;
        if (start) begin
            drawn     <= !drawn;
            band_line <= first_line;
            band_slot <= slot;
            marked    <= '0;
            united    <= 1'b0;
            for (int i = 0; i < 4; i++) begin
                to_come[i] <= '0;
                if (2'(i) <= last_line) begin
                    to_come[i] <= whole ? all : hull(marked[i] | left[slot][2'(first_line + i)]);
                    left[slot][2'(first_line + i)]  <= marked[i];
                    known[slot][2'(first_line + i)] <= 1'b1;
                    if (!whole && marked[i] != '0 && (left[slot][2'(first_line + i)] & ~marked[i]) != '0) united <= 1'b1;
                end
            end
        end

        if (sweep) begin
            swept <= swept + 1'b1;
            if (swept == '1 && !restart) sweep <= 1'b0;
            marked  <= '0;
            to_come <= '0;
        end
        if (restart) begin
            sweep <= 1'b1;
            swept <= '0;
            if (busy || start)
                for (int i = 0; i < 4; i++)
                    if (2'(i) <= last_line)
                        known[start ? slot : band_slot][2'((start ? first_line : band_line) + i)] <= 1'b0;
        end

        without_span <= !comes || span_valid || sweep ? '0 : without_span + 1'b1;
        without_end  <= comes || !busy || sweep ? '0 : without_end + 1'b1;

        if (rst) begin
            sweep        <= 1'b1;
            swept        <= '0;
            drawn        <= 1'b0;
            known        <= '0;
            to_come      <= '0;
            marked       <= '0;
            united       <= 1'b0;
            without_span <= '0;
            without_end  <= '0;
        end
    end

    always_ff @(posedge clk) if (!rst) begin
        assume (stride != '0);
        assume (group_column < stride && group_line <= last_line);
        assume (!(group_valid && (start || sweep)));
        assume (!start || !busy && !sweep && (whole || all_known));

        in_order:        assert (!span_valid || sweep || !comes
                                 || (span_first == next_row + (next[0] ? 4'd0 : next[1] ? 4'd1 : 4'd2)
                                     && span_last == next_row + (next[2] ? 4'd2 : next[1] ? 4'd1 : 4'd0)));
        nothing_made_up: assert (!span_valid || sweep || comes);
        none_left_out:   assert (busy || sweep || !comes);
        no_standstill:   assert (without_span < 4'(WITHIN));
        ends:            assert (without_end < 4'(WITHIN));
        both:            cover (united && !busy && last_line != '0);
    end
endmodule

`default_nettype wire

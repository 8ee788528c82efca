// Plans the flush of a band: finds the words to write in each line, from the first to the last word that was drawn in this band or in the
// last frame of the same frame buffer. All other words of the line already hold the clear colour in memory.
//
//               ┌───────────────┐
//   groups ────▶│ now, bank 0/1 │──┬──────────────▶ union ─▶ + line's first row ─▶ skid_buffer ─▶ spans
//               └───────────────┘  ▼                 ▲
//                          ┌───────────────┐         │
//                          │ last, slot 0/1├─────────┘
//                          └───────────────┘
//
// The extent of a line is its first and its last drawn column. A column is eight pixels wide. The memory `now`, in LUTs, holds the extents
// of the lines of two bands, one for each colour bank. A group updates the extent of its line in two clocks, a read and a write; if a
// line's extent is read in the clock of its write, the read returns the written value. The last update ends 2 clocks after its group. The
// memory `last` in a block RAM holds the extents of all lines of both frame buffers. An empty extent has the largest column as its first
// column and 0 as its last column, so the union of an empty extent and another extent is the other extent. The largest column, all ones,
// must therefore not be drawn.
//
// `start` (one clock, not while `busy` or `sweep` is high) plans the flush of the band that has just been drawn. From the next clock on,
// `drawn` must select the other bank. The band has `lines` lines (at least 1) of `stride` columns each, and begins at the line `first_line`
// of the picture. For every line whose union is not empty, in order, the output has a span: the first and the last row of the band buffer
// to write. With `whole` every line has a span of all its rows. `busy` falls when the last span has been taken. At this time the extents of
// the lines have been moved from `now` to `last`. Latency 6 clocks from `start` to the first span; throughput one line per clock, empty or
// not.
//
// `sweep` empties the memory `now`; it must be high for at least 2^LINE_BITS clocks. Sweep and reset cancel a running plan. After a sweep,
// `last` is undefined for the lines of the cancelled plan; after a reset, for all lines. The next band with any of these lines must be
// `whole`.

`default_nettype none

module band_extents #(
    parameter int unsigned ROW_BITS     = 11,
    parameter int unsigned LINE_BITS    = 6,
    parameter int unsigned COLUMN_BITS  = 8,
    parameter int unsigned PICTURE_BITS = 10
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire                     sweep,
    // Number of the bank that is drawn.
    input  wire                     drawn,
    // Groups that cover at least one pixel.
    input  wire                     group_valid,
    input  wire  [LINE_BITS-1:0]    group_line,
    input  wire  [COLUMN_BITS-1:0]  group_column,
    // Band.
    input  wire                     start,
    input  wire  [LINE_BITS-1:0]    lines,
    input  wire  [COLUMN_BITS-1:0]  stride,
    input  wire  [PICTURE_BITS-1:0] first_line,
    input  wire                     slot,
    input  wire                     whole,
    output logic                    busy,
    // Spans.
    output logic                    span_valid,
    input  wire                     span_ready,
    output logic [ROW_BITS-1:0]     span_first,
    output logic [ROW_BITS-1:0]     span_last
);
    localparam int unsigned EXTENT_BITS = 2 * COLUMN_BITS;
    localparam int unsigned PLACE_BITS  = PICTURE_BITS + 1;

    // An extent is {last column, first column}.
    localparam logic [EXTENT_BITS-1:0] EMPTY = {{COLUMN_BITS{1'b0}}, {COLUMN_BITS{1'b1}}};

    function automatic logic [EXTENT_BITS-1:0] united(input logic [EXTENT_BITS-1:0] a, input logic [EXTENT_BITS-1:0] b);
        logic [COLUMN_BITS-1:0] a_first, a_last, b_first, b_last;
        {a_last, a_first} = a;
        {b_last, b_first} = b;
        united = {a_last > b_last ? a_last : b_last, a_first < b_first ? a_first : b_first};
    endfunction

    // Progress of a plan: the current line in the band, its address in `last`, and the number of columns in a line.
    logic                    planning, plan;
    logic [LINE_BITS-1:0]    line, last_line;
    logic [PLACE_BITS-1:0]   place;
    logic [COLUMN_BITS-1:0]  columns, last_column;
    logic                    all;
    logic                    advance;

    assign plan = planning && advance;

    // Update of the extent `old` by the column of a group: signals with the suffix `_1` belong to the clock of the read, signals with `_2`
    // to the clock of the write.
    logic                   adds_1, adds_2, sweeps_1, sweeps_2, drawn_1, to_write;
    logic [COLUMN_BITS-1:0] column_1, column_2;
    logic [EXTENT_BITS-1:0] old, updated;

    // For each bank: the extent that is read, and whether the extent of the same line is written in this clock.
    logic [EXTENT_BITS-1:0] kept [0:1];
    logic [1:0]             same;

    assign updated = sweeps_2 ? EMPTY : united(old, {column_2, column_2});

    always_ff @(posedge clk) begin
        adds_1   <= group_valid && !rst;
        adds_2   <= adds_1;
        sweeps_1 <= sweep;
        sweeps_2 <= sweeps_1;
        column_1 <= group_column;
        column_2 <= column_1;
        drawn_1  <= drawn;
        old      <= same[drawn_1] ? updated : kept[drawn_1];
    end

    for (genvar bank = 0; bank < 2; bank++) begin : banks
        (* ram_style = "distributed" *) logic [EXTENT_BITS-1:0] now [0:2**LINE_BITS-1];
        logic                 empties_1, empties_2, stores;
        logic [LINE_BITS-1:0] line_1, line_2;

        assign kept[bank] = now[line_1];
        assign stores     = sweeps_2 || (empties_2 ? to_write : adds_2);
        assign same[bank] = (sweeps_2 || adds_2) && line_1 == line_2;

        always_ff @(posedge clk) begin
            empties_1 <= sweep || drawn != 1'(bank);
            empties_2 <= empties_1;
            if (sweep || drawn != 1'(bank)) begin
                if (sweep || advance) line_1 <= line;
            end else begin
                line_1 <= group_line;
            end
            line_2 <= line_1;
            if (stores) now[line_2] <= empties_2 ? EMPTY : updated;
        end
    end

    always_ff @(posedge clk) begin
        if (sweep || plan) line <= line + 1'b1;
        if (plan) begin
            place[PICTURE_BITS-1:0] <= place[PICTURE_BITS-1:0] + 1'b1;
            if (line == last_line) planning <= 1'b0;
        end
        if (start) begin
            planning    <= 1'b1;
            line        <= '0;
            last_line   <= lines - 1'b1;
            place       <= {slot, first_line};
            columns     <= stride;
            last_column <= stride - 1'b1;
            all         <= whole;
        end

        if (rst || sweep) planning <= 1'b0;
    end

    // In the clock after its read, the extent in `last` is replaced by the new extent.
    (* ram_style = "block", rw_addr_collision = "no", no_rw_check *)
    logic [EXTENT_BITS-1:0] last [0:2**PLACE_BITS-1];
    logic [PLACE_BITS-1:0]  from, to;
    logic [EXTENT_BITS-1:0] latched, earlier, now_2, now_3, united_4;
    logic [4:1]             valid;
    // Band buffer row at which the line in the last pipeline stage begins.
    logic [ROW_BITS-1:0]    line_row;

    always_ff @(posedge clk) begin
        to_write <= valid[1] && advance;
        to       <= from;
        if (to_write) last[to] <= now_2;

        if (advance) begin
            valid    <= {valid[3:1], planning};
            from     <= place;
            now_2    <= kept[!drawn_1];
            now_3    <= now_2;
            latched  <= last[from];
            earlier  <= latched;
            united_4 <= all ? {last_column, {COLUMN_BITS{1'b0}}} : united(earlier, now_3);
            if (valid[4]) line_row <= line_row + ROW_BITS'(columns);
        end
        if (start) line_row <= '0;

        if (rst || sweep) begin
            valid    <= '0;
            to_write <= 1'b0;
        end
    end

    logic [ROW_BITS-1:0] first, final_row;

    assign first     = line_row + ROW_BITS'(united_4[COLUMN_BITS-1:0]);
    assign final_row = line_row + ROW_BITS'(united_4[EXTENT_BITS-1:COLUMN_BITS]);
    assign busy      = planning || valid != '0 || span_valid;

    skid_buffer #(.WIDTH(2 * ROW_BITS)) spans (
        .clk, .rst(rst || sweep),
        .in_valid(valid[4] && united_4[COLUMN_BITS-1:0] != '1), .in_ready(advance), .in_data({first, final_row}),
        .out_valid(span_valid), .out_ready(span_ready), .out_data({span_first, span_last})
    );
endmodule

`default_nettype wire

// Keeps the marked pixels of a line that belong to a run of at least `reach` + 1 marked pixels, and drops all others: a horizontal
// opening (docs/formats/gesture.md, "Gestures").
//
//   marked    . M . M M M M . .        reach 2
//   run       0 0 1 0 1 2 3 4 0        marked pixels immediately before this pixel, at most 15
//   full      . . . . . F F . .        the last of three consecutive marked pixels
//   kept      . . . . . K K K K        for the column two to the left: the pixels of the run
//
// The decision about a pixel needs the `reach` pixels after it, so `out_x` lags by `reach`. The clocks `blank` and `next`
// after the end of a line count as unmarked pixels. No memory of the marks is needed: when `full` is high, the current pixel and the
// `reach` pixels before it are marked. Latency one clock, throughput one pixel per clock.

`default_nettype none

module run_filter (
    input  wire                       clk,
    input  wire  [3:0]                reach,
    input  wire  gesture_pkg::item_t  item,
    input  wire                       marked,
    input  wire  [10:0]               x,
    input  wire  [10:0]               y,
    output logic                      kept,
    output logic [10:0]               out_x,
    output logic [10:0]               out_y
);
    // `more` is the number of further clocks in which pixels are kept.
    logic [3:0] run, more;
    logic       moves, full;

    assign moves = item.pixel || item.blank || item.next;
    assign full  = item.pixel && marked && run >= reach;

    always_ff @(posedge clk) begin
        kept  <= full || moves && more != '0;
        out_x <= x - 11'(reach);
        out_y <= y;
        if (moves) begin
            run  <= item.pixel && marked ? run + 4'(run != '1) : '0;
            more <= full ? reach : more - 4'(more != '0);
        end
    end

    wire _unused = &{1'b0, item};
endmodule

`default_nettype wire

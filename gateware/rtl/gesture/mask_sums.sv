// Accumulates the kept pixels of a frame: their number, the sums of their columns and lines, their bounding box, and with MOMENTS the sums
// of the products of columns and lines. `results` holds the values of the last whole frame.
//
// `kept`, `x` and `y` are sampled in every clock. A frame ends with `frame`, at least one clock after its last pixel and at least four
// clocks before the next `frame`; if `whole` is high in this clock, the frame's sums are in `results` two clocks later, when `latched` is
// high. No sum of a frame of up to 1280x720 pixels overflows.

`default_nettype none

module mask_sums #(
    parameter bit MOMENTS = 1'b0
) (
    input  wire                               clk,
    input  wire                               rst,
    input  wire                               kept,
    input  wire  [10:0]                       x,
    input  wire  [10:0]                       y,
    input  wire                               frame,
    input  wire                               whole,
    output logic                              latched,
    output logic [15:0]                       sequence_number,
    output gesture_registers_pkg::results_t   results
);
    gesture_registers_pkg::results_t sums;
    logic                            found, next, loading, clear;
    // Complements of the smallest column and line, which start at 0 like all other sum registers.
    logic [10:0]                     most_left, most_up;

    assign next = frame && whole;

    assign sums.box_x.first = ~most_left;
    assign sums.box_y.first = ~most_up;

    always_ff @(posedge clk) begin
        // The last products are valid one clock after the last pixel, and `results` latches the sums two clocks after `frame`.
        clear   <= frame;
        loading <= next && !rst;
        latched <= loading;
        sequence_number <= sequence_number + 16'(loading);

        sums.count <= sums.count + 20'(kept);
        sums.sum_x <= sums.sum_x + 30'(x & {11{kept}});
        sums.sum_y <= sums.sum_y + 29'(y & {11{kept}});
        if (kept) begin
            if (~x > most_left)        most_left       <= ~x;
            if (x > sums.box_x.last)   sums.box_x.last <= x;
            if (!found)                most_up         <= ~y;
            sums.box_y.last <= y;
            found           <= 1'b1;
        end
        if (clear) begin
            sums.count      <= '0;
            sums.sum_x      <= '0;
            sums.sum_y      <= '0;
            sums.box_x.last <= '0;
            sums.box_y.last <= '0;
            most_left       <= '0;
            most_up         <= '0;
            found           <= 1'b0;
        end
        if (rst) sequence_number <= '0;
    end

    if (MOMENTS) begin : moments
        logic [21:0] product_xx, product_xy, product_yy;

        always_ff @(posedge clk) begin
            product_xx  <= kept ? x * x : '0;
            product_xy  <= kept ? x * y : '0;
            product_yy  <= kept ? y * y : '0;
            sums.sum_xx <= sums.sum_xx + 40'(product_xx);
            sums.sum_xy <= sums.sum_xy + 40'(product_xy);
            sums.sum_yy <= sums.sum_yy + 40'(product_yy);
            if (clear) begin
                sums.sum_xx <= '0;
                sums.sum_xy <= '0;
                sums.sum_yy <= '0;
            end
        end
    end else begin : no_moments
        assign sums.sum_xx = '0;
        assign sums.sum_xy = '0;
        assign sums.sum_yy = '0;
    end

    wide_register #(.WIDTH($bits(results)), .LOADS(80)) result (.clk, .next, .in(sums), .out(results));
endmodule

`default_nettype wire

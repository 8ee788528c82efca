// Generates the video timing: counters of pixels and lines, the signals hsync and vsync, and a tick in each line.
//
// A line consists of active pixels, front porch, sync and back porch; a frame consists of lines in the same four parts. hsync and vsync are
// active high, and vsync changes with the leading edge of hsync, as in CEA-861. The only inputs are clock and reset. The last V_BORDER
// lines of the back porch and the first V_BORDER lines of the front porch are visible lines around the picture.
//
// `tick` is the first clock of hsync. `tick_line` is then the number of the line that follows, 0 to V_ACTIVE - 1, or V_ACTIVE
// and more in the vertical blanking; the tick with V_ACTIVE begins the blanking. Throughput one pixel per clock; the outputs are
// registers. Reset sets the counters to the end of the last active line, so that the first frame begins with a vertical blanking.

`default_nettype none

module scanout_timing #(
    parameter int unsigned H_ACTIVE = 1280,
    parameter int unsigned H_FRONT  = 110,
    parameter int unsigned H_SYNC   = 40,
    parameter int unsigned H_BACK   = 220,
    parameter int unsigned V_ACTIVE = 720,
    parameter int unsigned V_FRONT  = 5,
    parameter int unsigned V_SYNC   = 5,
    parameter int unsigned V_BACK   = 20,
    parameter int unsigned V_BORDER = 0,
    localparam int unsigned H_TOTAL = H_ACTIVE + H_FRONT + H_SYNC + H_BACK,
    localparam int unsigned V_TOTAL = V_ACTIVE + V_FRONT + V_SYNC + V_BACK,
    localparam int unsigned X_BITS  = $clog2(H_TOTAL),
    localparam int unsigned Y_BITS  = $clog2(V_TOTAL)
) (
    input  wire               clk,
    input  wire               rst,
    output logic [X_BITS-1:0] x,
    output logic              active,
    output logic              hsync,
    output logic              vsync,
    output logic              tick,
    output logic [Y_BITS-1:0] tick_line
);
    logic [Y_BITS-1:0] y;
    logic              in_lines;

    always_ff @(posedge clk) begin
        tick <= 1'b0;
        if (rst) begin
            x         <= X_BITS'(H_ACTIVE);
            y         <= Y_BITS'(V_ACTIVE - 1);
            tick_line <= '0;
            active    <= 1'b0;
            in_lines  <= 1'b0;
            hsync     <= 1'b0;
            vsync     <= 1'b0;
        end else begin
            if (x == X_BITS'(H_TOTAL - 1)) begin
                x      <= '0;
                y      <= tick_line;
                active <= in_lines;
            end else begin
                x <= x + 1'b1;
            end
            if (x == X_BITS'(H_ACTIVE - 1)) active <= 1'b0;
            if (x == X_BITS'(H_ACTIVE + H_FRONT + H_SYNC - 1)) hsync <= 1'b0;
            if (x == X_BITS'(H_ACTIVE + H_FRONT - 1)) begin
                hsync     <= 1'b1;
                tick      <= 1'b1;
                tick_line <= (y == Y_BITS'(V_TOTAL - 1)) ? '0 : y + 1'b1;
                if (y == Y_BITS'(V_TOTAL - 1 - V_BORDER))            in_lines <= 1'b1;
                if (y == Y_BITS'(V_ACTIVE - 1 + V_BORDER))           in_lines <= 1'b0;
                if (y == Y_BITS'(V_ACTIVE + V_FRONT - 1))            vsync    <= 1'b1;
                if (y == Y_BITS'(V_ACTIVE + V_FRONT + V_SYNC - 1))   vsync    <= 1'b0;
            end
        end
    end
endmodule

`default_nettype wire

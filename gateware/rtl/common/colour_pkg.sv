// Conversion of colours to the format of the frame buffer.

`default_nettype none

package colour_pkg;
    /* verilator lint_off UNUSEDSIGNAL */
    // Returns the threshold of `rounded` for the pixel in column x and line y of a pattern of 4x4 pixels. Without `dither` the threshold is
    // half a step, which rounds to nearest.
    function automatic logic [2:0] threshold(input logic dither, input logic [1:0] x, input logic [1:0] y);
        threshold = dither ? {x[0] ^ y[0], y[0], x[1] ^ y[1]} : 3'd4;
    endfunction

    // Converts {blue, green, red}, with 248 for full red and blue and 252 for full green, to RGB565: adds a threshold below one step, in
    // eighths of a step (quarters for green), to each channel, and rounds down. The next step of a channel is the same for all thresholds,
    // so only the choice between the steps is made for each pixel.
    function automatic logic [15:0] rounded(input logic [2:0][7:0] colour, input logic [2:0] limit);
        logic [4:0] red, blue;
        logic [5:0] green;
        red     = colour[0][2:0] > ~limit ? colour[0][7:3] + 1'b1 : colour[0][7:3];
        green   = colour[1][1:0] > ~limit[2:1] ? colour[1][7:2] + 1'b1 : colour[1][7:2];
        blue    = colour[2][2:0] > ~limit ? colour[2][7:3] + 1'b1 : colour[2][7:3];
        rounded = {red, green, blue};
    endfunction

    // Converts RGB565 to the input format of `rounded`; the fraction bits are then 0.
    function automatic logic [23:0] fractions(input logic [15:0] colour);
        fractions = {colour[4:0], 3'd0, colour[10:5], 2'd0, colour[15:11], 3'd0};
    endfunction

    // Adds the channels of two pixels in RGB565, and `carry` to each sum: {red, green, blue}, each a bit wider than the channel.
    function automatic logic [18:0] pair(input logic [15:0] a, input logic [15:0] b, input logic carry);
        logic [5:0] red, blue;
        logic [6:0] green;
        red   = 6'(a[15:11]) + 6'(b[15:11]) + 6'(carry);
        green = 7'(a[10:5]) + 7'(b[10:5]) + 7'(carry);
        blue  = 6'(a[4:0]) + 6'(b[4:0]) + 6'(carry);
        pair  = {red, green, blue};
    endfunction

    // Returns the average of four pixels in RGB565, from two sums of two pixels: adds `carry` to each sum of four, divides it by four, and
    // rounds down.
    function automatic logic [15:0] average(input logic [18:0] a, input logic [18:0] b, input logic carry);
        logic [6:0] red, blue;
        logic [7:0] green;
        red     = 7'(a[18:13]) + 7'(b[18:13]) + 7'(carry);
        green   = 8'(a[12:6]) + 8'(b[12:6]) + 8'(carry);
        blue    = 7'(a[5:0]) + 7'(b[5:0]) + 7'(carry);
        average = {red[6:2], green[7:2], blue[6:2]};
    endfunction
    /* verilator lint_on UNUSEDSIGNAL */
endpackage

`default_nettype wire

// Stand-in for the module pixel_colour in proofs, with a latency of 2 clocks. The colour is the low 7 bits of the red light, which identify
// the pixel.

`default_nettype none

module pixel_colour (
    input  wire              clk,
    input  wire              dither,
    input  wire  [31:0]      depth,
    input  wire  [2:0][31:0] light,
    output logic [2:0][7:0]  colour
);
    delay #(.WIDTH(24), .CLOCKS(2)) waits (.clk, .enable(1'b1), .in(colour_pkg::fractions({9'd0, light[0][6:0]})), .out(colour));

    wire _unused = &{1'b0, dither, depth, light};
endmodule

`default_nettype wire

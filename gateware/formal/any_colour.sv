// Stand-in for the module pixel_colour in proofs. The colour is the light in red, which identifies the pixel.

`default_nettype none

module pixel_colour (
    input  wire              clk,
    input  wire  [31:0]      depth,
    input  wire  [2:0][31:0] light,
    output logic [15:0]      colour
);
    delay #(.WIDTH(16), .CLOCKS(7)) waits (.clk, .enable(1'b1), .in(light[0][15:0]), .out(colour));

    wire _unused = &{1'b0, depth, light};
endmodule

`default_nettype wire

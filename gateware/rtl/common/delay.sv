// Delays its input by CLOCKS clocks, counting only clocks in which `enable` is high.

`default_nettype none

module delay #(
    parameter int unsigned WIDTH  = 8,
    parameter int unsigned CLOCKS = 2
) (
    input  wire              clk,
    input  wire              enable,
    input  wire  [WIDTH-1:0] in,
    output logic [WIDTH-1:0] out
);
    logic [CLOCKS-1:0][WIDTH-1:0] passing;

    assign out = passing[CLOCKS-1];

    always_ff @(posedge clk) if (enable) passing <= (CLOCKS * WIDTH)'({passing, in});
endmodule

`default_nettype wire

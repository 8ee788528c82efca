// Delays its input by CLOCKS clocks in block RAM, for words too wide for the shift registers of the module delay.
//
//   in ─▶ ring of CLOCKS - 1 places in block RAM ─▶ output register ─▶ out
//
// CLOCKS is at least 3.

`default_nettype none

module block_delay #(
    parameter int unsigned WIDTH  = 72,
    parameter int unsigned CLOCKS = 4
) (
    input  wire              clk,
    input  wire  [WIDTH-1:0] in,
    output logic [WIDTH-1:0] out
);
    localparam int unsigned PLACES     = CLOCKS - 1;
    localparam int unsigned PLACE_BITS = $clog2(PLACES);

    (* ram_style = "block", no_rw_check *) logic [WIDTH-1:0] places [0:2**PLACE_BITS-1];
    logic [WIDTH-1:0]      latched;
    logic [PLACE_BITS-1:0] newest, oldest;

    always_ff @(posedge clk) begin
        places[newest] <= in;
        latched        <= places[oldest];
        out            <= latched;
        newest         <= oldest;
        oldest         <= oldest == PLACE_BITS'(PLACES - 1) ? '0 : oldest + 1'b1;
    end
endmodule

`default_nettype wire

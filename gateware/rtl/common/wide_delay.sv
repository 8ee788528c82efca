// Delays its input by CLOCKS clocks in LUT memory, which stores three bits in two LUTs. The module `delay` uses shift registers, one LUT
// per bit. Because of its address counter, this module only takes fewer LUTs than `delay` if words are wide.
//
//   in ─▶ ring of CLOCKS - 1 places in LUT memory ─▶ output register ─▶ out
//
// CLOCKS is at least 3. If `zero` is high, `out` is 0 in the next clock in place of the word: the reset of the output register takes no
// LUT.

`default_nettype none

module wide_delay #(
    parameter int unsigned WIDTH  = 72,
    parameter int unsigned CLOCKS = 4
) (
    input  wire              clk,
    input  wire              zero,
    input  wire  [WIDTH-1:0] in,
    output logic [WIDTH-1:0] out
);
    localparam int unsigned PLACES     = CLOCKS - 1;
    localparam int unsigned PLACE_BITS = $clog2(PLACES);

    (* ram_style = "distributed" *) logic [WIDTH-1:0] places [0:2**PLACE_BITS-1];
    // Address of the oldest word, which is read and then replaced by the newest word.
    logic [PLACE_BITS-1:0] place;

    always_ff @(posedge clk) begin
        places[place] <= in;
        out           <= zero ? '0 : places[place];
        place         <= place == PLACE_BITS'(PLACES - 1) ? '0 : place + 1'b1;
    end
endmodule

`default_nettype wire

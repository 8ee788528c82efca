// Compares two values. One LUT compares three bits of each. The attribute `keep` preserves this division: when synthesis optimises for
// the shortest path, it would otherwise use a LUT for every two bits.

`default_nettype none

module equal #(
    parameter int unsigned WIDTH = 8
) (
    input  wire  [WIDTH-1:0] a,
    input  wire  [WIDTH-1:0] b,
    output logic             same
);
    localparam int unsigned PARTS = (WIDTH + 2) / 3;

    (* keep *) logic [PARTS-1:0] differ;
    logic [3*PARTS-1:0] difference;

    assign difference = (3 * PARTS)'(a ^ b);
    assign same       = differ == '0;

    for (genvar i = 0; i < PARTS; i++) begin : parts
        assign differ[i] = difference[3*i +: 3] != '0;
    end
endmodule

`default_nettype wire

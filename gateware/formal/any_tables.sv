// Stand-ins for the tables, the depth codes, the reciprocals and the quotients of the raymarcher in proofs. They return arbitrary results,
// so properties proven with them hold for all contents.

`default_nettype none

module paint_table (
    input  wire        clk,
    input  wire        write,
    input  wire  [8:0] write_entry,
    input  wire  [7:0] write_part,
    input  wire  [7:0] fog_entry,
    output logic [7:0] fog,
    input  wire  [7:0] light_entry,
    output logic [7:0] light
);
    (* anyseq *) logic [7:0] any_fog, any_light;

    assign fog   = any_fog;
    assign light = any_light;
endmodule

module depth_code (
    input  wire               clk,
    input  wire  [16:0]       mantissa,
    input  wire  signed [5:0] exponent,
    input  wire  [39:0]       depth,
    output logic [17:0]       code
);
    (* anyseq *) logic [17:0] any;

    assign code = any;
endmodule

module exit_reciprocal (
    input  wire                                clk,
    input  wire  [26:0]                        magnitude,
    output logic [exit_pkg::INVERSE_BITS-1:0]  inverse
);
    (* anyseq *) logic [exit_pkg::INVERSE_BITS-1:0] any;

    assign inverse = any;
endmodule

module exit_quotient (
    input  wire                                clk,
    input  wire  [exit_pkg::PLANE_BITS-1:0]   distance,
    input  wire  [exit_pkg::INVERSE_BITS-1:0]  inverse,
    output logic [exit_pkg::EXIT_BITS-1:0]     t
);
    (* anyseq *) logic [exit_pkg::EXIT_BITS-1:0] any;

    assign t = any;
endmodule

`default_nettype wire

// Stand-in for the module field_unit in proofs. It returns an arbitrary distance to an arbitrary surface, so properties proven
// with it hold for all distance fields.

`default_nettype none

module field_unit #(
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1
) (
    input  wire                     clk,
    input  wire raymarch_registers_pkg::solid_t solid,
    input  wire                     sphere_write,
    input  wire  [2:0]              sphere_number,
    input  wire raymarch_registers_pkg::sphere_t sphere,
    input  wire  [2:0]              pass,
    input  wire  [2:0][21:0]        point,
    input  wire raymarch_pkg::nearest_t so_far,
    output logic signed [21:0]      distance,
    output logic [2:0]              surface,
    output logic [2:0]              face,
    output logic [7:0]              share,
    output raymarch_pkg::nearest_t     nearest
);
    (* anyseq *) logic signed [21:0] any_distance;
    (* anyseq *) logic [2:0]         any_surface;

    assign distance = any_distance;
    assign surface  = any_surface;
    assign {face, share, nearest} = '0;
endmodule

`default_nettype wire

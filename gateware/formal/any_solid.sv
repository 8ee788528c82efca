// Stand-ins for the modules exit_borders and exit_choice in proofs: an arbitrary solid and arbitrary exits, with at most two evaluations
// per ray.
//
// The first evaluation has an arbitrary outcome. If the ray continues, it crosses a plane perpendicular to x, and the second evaluation
// ends it, with a hit if the lowest digit of `reached` was set when the ray entered. The bit above this digit is set in the next
// interval, and marks the second evaluation.

`default_nettype none

module exit_borders #(
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1,
    parameter bit          LATTICE = 1'b0
) (
    input  wire                                      clk,
    input  wire exit_pkg::solid_t                    solid,
    input  wire  [2:0][exit_pkg::POINT_BITS-1:0]     point,
    input  wire  [2:0][exit_pkg::INTERVAL_BITS-1:0]  reached_3,
    output logic [2:0][exit_pkg::INTERVAL_BITS-1:0]  next,
    output logic [2:0]                               there,
    output logic [1:0]                               choice,
    output logic [2:0]                               above,
    output logic                                     hit,
    output logic                                     gone,
    output logic [2:0][exit_pkg::PLANE_BITS-1:0]     at,
    output logic [2:0]                               over
);
    localparam int unsigned LOWEST = exit_pkg::DIGIT_BITS - 8;

    (* anyseq *) logic any_hit, any_gone;
    logic crossed_7, tag_7;

    delay #(.WIDTH(2), .CLOCKS(4)) reached_waits (
        .clk, .enable(1'b1), .in(reached_3[0][LOWEST+1 -: 2]), .out({crossed_7, tag_7})
    );

    assign hit  = crossed_7 ? tag_7 : any_hit;
    assign gone = crossed_7 ? !tag_7 : any_gone;
    assign next[0] = {1'b1, {exit_pkg::DIGIT_BITS - LOWEST - 2{1'b0}}, 1'b1, tag_7, {LOWEST{1'b0}}};
    assign {next[2:1], there, choice, above, at, over} = '0;
endmodule

module exit_choice (
    input  wire                                  clk,
    input  wire  [2:0][exit_pkg::EXIT_BITS-1:0]  exits,
    input  wire  [2:0]                           there,
    input  wire  [1:0]                           choice,
    output logic [exit_pkg::EXIT_BITS-1:0]       t,
    output logic [1:0]                           axis,
    output logic [2:0]                           crossed
);
    (* anyseq *) logic [2:0] any_t;

    assign t       = exit_pkg::EXIT_BITS'(any_t);
    assign axis    = 2'd0;
    assign crossed = 3'b001;
endmodule

`default_nettype wire

// Stand-ins for the modules edge_stepper and stepper in proofs. Edge functions and depths are arbitrary, but constant while the
// walker stalls.

`default_nettype none

module edge_stepper (
    input  wire                     clk,
    input  wire                     advance,
    input  wire                     keep,
    input  wire                     next_resume,
    input  wire raster_pkg::move_t  move,
    input  wire  [33:0]             load_best,
    input  wire                     load_beside_fails,
    input  wire                     rises,
    input  wire  [19:0]             slope,
    input  wire  [20:0]             step_y,
    input  wire  [24:0]             beside_step,
    output logic [33:0]             best,
    output logic                    beside_fails
);
    (* anyseq *) logic [34:0] any;

    always_ff @(posedge clk) if (advance) {best, beside_fails} <= any;
endmodule

module stepper (
    input  wire                     clk,
    input  wire                     advance,
    input  wire                     keep,
    input  wire                     resume,
    input  wire raster_pkg::move_t  move,
    input  wire  [31:0]             load_value,
    input  wire  [31:0]             step_x,
    input  wire  [31:0]             step_y,
    output logic [31:0]             current
);
    (* anyseq *) logic [31:0] any;

    always_ff @(posedge clk) if (advance) current <= any;
endmodule

`default_nettype wire

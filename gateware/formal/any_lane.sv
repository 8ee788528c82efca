// Stand-in for the module exit_lane in proofs: a lane for rays to the light, which holds up to two rays for an arbitrary time. A ray hits
// the solid if the lowest bit of `in_carried` is set.

`default_nettype none

module exit_lane #(
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1,
    parameter bit          STEREO = 1'b1,
    parameter int unsigned CARRIED = 1
) (
    input  wire                                           clk,
    input  wire                                           rst,
    input  wire  [1:0][2:0][exit_pkg::PLANE_BITS-1:0]     origins,
    input  wire exit_pkg::solid_t                         solid,
    input  wire  [exit_pkg::T_BITS-1:0]                   far_t,
    input  wire                                           in_valid,
    output logic                                          in_ready,
    input  wire exit_pkg::ray_t                           in_ray,
    input  wire  [2:0][exit_pkg::PLANE_BITS-1:0]          in_origin,
    input  wire  [CARRIED-1:0]                            in_carried,
    output logic                                          out_valid,
    input  wire                                           out_ready,
    output exit_pkg::end_t                                out_end,
    output logic [CARRIED-1:0]                            out_carried,
    output logic                                          evaluates,
    output logic                                          waits
);
    (* anyseq *) logic ends;
    logic has_ended, kept_valid;

    fifo #(.WIDTH(CARRIED), .DEPTH(2)) rays (
        .clk, .rst, .in_valid, .in_ready, .in_data(in_carried), .out_valid(kept_valid), .out_ready(out_valid && out_ready),
        .out_data(out_carried)
    );

    assign out_valid = kept_valid && (ends || has_ended);
    always_ff @(posedge clk) has_ended <= out_valid && !out_ready && !rst;

    always_comb begin
        out_end     = '0;
        out_end.hit = out_carried[0];
    end
    assign {evaluates, waits} = '0;
endmodule

`default_nettype wire

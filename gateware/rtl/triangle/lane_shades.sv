// Smooth shading of eight pixels: computes the colours of a group in parallel with `lanes`, and delays the outputs of `lanes`
// to match.
//
//   stage   2         4                5                    7              11
//           light ───────────────────────▶ lane_values ─────▶ ┌──────────────┐
//                     depths ───────────────────────────────▶ │ lane_colours │─▶ colours
//                                      group ─────────────────└──────────────┘─▶ group
//
// Stage numbers count from the input of `lanes`. Like `lanes`, the pipeline cannot be stopped. Latency 6 clocks from the group's
// output by `lanes` to the coloured group, throughput a group a clock.

`default_nettype none

module lane_shades #(
    parameter int unsigned GROUP_BITS = 8
) (
    input  wire                    clk,
    input  wire                    rst,
    output logic                   idle,
    // Stage 2.
    input  wire  [2:0][31:0]       in_light,  // red in the lowest bits
    input  wire  [2:0][31:0]       in_step_x,
    input  wire                    in_smooth,
    // Stage 4.
    input  wire  [7:0][31:0]       in_depths, // with half a depth code added
    // Stage 5.
    input  wire                    in_valid,
    input  wire  [GROUP_BITS-1:0]  in_group,
    input  wire  [15:0]            in_colour, // of a flat triangle
    output logic                   out_valid,
    output logic [GROUP_BITS-1:0]  out_group,
    output logic [7:0][15:0]       out_colours
);
    localparam int unsigned LATENCY = 6;

    logic [LATENCY-1:0] valid;

    assign idle      = valid == '0;
    assign out_valid = valid[LATENCY-1];

    always_ff @(posedge clk) begin
        valid <= {valid[LATENCY-2:0], in_valid};
        if (rst) valid <= '0;
    end

    logic        smooth_9, smooth;
    logic [15:0] colour;

    delay #(.WIDTH(GROUP_BITS + 16), .CLOCKS(LATENCY)) group_delay (
        .clk, .enable(1'b1), .in({in_colour, in_group}), .out({colour, out_group})
    );
    delay #(.WIDTH(1), .CLOCKS(8)) smooth_delay (.clk, .enable(1'b1), .in(in_smooth), .out(smooth_9));

    always_ff @(posedge clk) smooth <= smooth_9;

    // The light of a group is delayed until the depths are there. Before `lane_values` it is an accumulator and its step, after
    // `lane_values` the accumulators of eight lanes.
    logic [2:0][7:0][31:0] lights;

    for (genvar k = 0; k < 3; k++) begin : channels
        logic [31:0] light, step_x;

        delay #(.WIDTH(64), .CLOCKS(2)) light_delay (.clk, .enable(1'b1), .in({in_light[k], in_step_x[k]}), .out({light, step_x}));
        lane_values spread (.clk, .in(light), .step_x, .values(lights[k]));
    end

    for (genvar pair = 0; pair < 4; pair++) begin : pairs
        // The following signals are vectors, because Yosys does not support arrays here.
        logic [2*96-1:0] pair_lights;
        logic [2*16-1:0] colours;

        for (genvar lane = 0; lane < 2; lane++) begin : lanes
            localparam int unsigned LANE = 2 * pair + lane;

            assign pair_lights[96 * lane +: 96] = {lights[2][LANE], lights[1][LANE], lights[0][LANE]};
            assign out_colours[LANE] = smooth ? colours[16 * lane +: 16] : colour;
        end

        lane_colours quotients (.clk, .depths(in_depths[2 * pair +: 2]), .lights(pair_lights), .colours);
    end
endmodule

`default_nettype wire

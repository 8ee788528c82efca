// Computes colours from the texels of a step: averages neighbours, and multiplies by the light.
//
//   clock  0                       5       6
//   neighbours, texels of 0, 1 ─▶ texture_lerp ─▶ texture_light ─▶ lanes 0 and 1; bilinear: or 2 and 3
//   texels of 2, 3 ─────────────▶ delay ────────▶ texture_light ─▶ nearest: lanes 2 and 3
//                                 light ────────▶
//
// With nearest filtering, a step contains one texel for each of four lanes. With bilinear filtering, a step contains the four neighbours of
// each of two lanes: 0 and 1, or 2 and 3. Two instances of texture_lerp therefore suffice for both kinds of filtering.
//
// Without FRACTIONS, colours are rounded to RGB565; with `dither`, the threshold depends on the position of the pixel. With FRACTIONS,
// colours have the format of the input of colour_pkg::rounded.
//
// `in_bilinear` and `dither` must be constant while steps are inside. `light`, and `line`, the lowest bits of the number of the picture's
// line, belong to the step that entered LIGHT clocks earlier. Colours are output FILTER clocks after their step; the colours of lanes
// outside of `out_mask` are undefined. Throughput one step per clock; the pipeline cannot be stopped, and its consumer must always be
// ready.

`default_nettype none

module texture_filter #(
    parameter  bit          FRACTIONS   = 1'b0,
    localparam int unsigned COLOUR_BITS = FRACTIONS ? 24 : 16
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       dither,
    input  wire                       in_valid,
    input  wire  [3:0]                in_mask,       // lanes of this step
    input  wire                       in_half,
    input  wire                       in_last,
    input  wire                       in_bilinear,
    input  wire  [3:0]                in_opaque,
    input  wire  [3:0][15:0]          in_texels,     // nearest: RGB565 of each lane
    input  wire  [1:0][3:0][15:0]     in_neighbours, // bilinear: of each pixel, (u, v), (u+1, v), (u, v+1), (u+1, v+1)
    input  wire  [1:0][1:0][3:0]      in_weights,    // of each pixel, across and down; u0.4
    input  wire  [2:0][7:0]           light,         // red in the lowest bits; u0.8, at most 248, green 252
    input  wire  [1:0]                line,
    output logic                      out_valid,
    output logic [3:0]                out_mask,
    output logic                      out_half,
    output logic                      out_last,
    output logic [3:0]                out_opaque,
    output logic [3:0][COLOUR_BITS-1:0] out_colours
);
    localparam int unsigned FILTER = texture_pkg::FILTER;

    logic [FILTER-1:0] valid;

    assign out_valid = valid[FILTER-1];

    always_ff @(posedge clk) valid <= rst ? '0 : {valid[FILTER-2:0], in_valid};

    delay #(.WIDTH(10), .CLOCKS(FILTER)) step (
        .clk, .enable(1'b1), .in({in_mask, in_half, in_last, in_opaque}), .out({out_mask, out_half, out_last, out_opaque})
    );

    logic [1:0][2:0][7:0] averages;
    logic [1:0][15:0]     late;
    logic [1:0][COLOUR_BITS-1:0] wide, narrow;

    for (genvar i = 0; i < 2; i++) begin : pixels
        texture_lerp lerp (
            .clk, .bilinear(in_bilinear), .nearest(in_texels[i]), .neighbours(in_neighbours[i]), .weights(in_weights[i]),
            .texel(averages[i])
        );
    end

    // The latency of texture_lerp.
    delay #(.WIDTH(32), .CLOCKS(6)) late_delay (.clk, .enable(1'b1), .in(in_texels[3:2]), .out(late));

    // The thresholds of the four lanes, or with bilinear filtering of the two pixels, in the clock in which texture_light adds them.
    logic [3:0][2:0] thresholds_8;
    logic [1:0]      line_7;
    logic            second_7;

    delay #(.WIDTH(2), .CLOCKS(2)) line_delay (.clk, .enable(1'b1), .in(line), .out(line_7));
    delay #(.WIDTH(1), .CLOCKS(7)) second_delay (.clk, .enable(1'b1), .in(in_bilinear && in_mask[1:0] == '0), .out(second_7));

    always_ff @(posedge clk)
        for (int lane = 0; lane < 4; lane++)
            thresholds_8[lane] <= colour_pkg::threshold(dither, 2'(lane) | {lane < 2 && second_7, 1'b0}, line_7);

    for (genvar k = 0; k < 3; k++) begin : channels
        localparam int unsigned BITS = k == 1 ? 6 : 5;
        localparam int unsigned LOW  = k == 0 ? 11 : k == 1 ? 5 : 0;
        localparam int unsigned REST = 8 - BITS;
        // Lowest bit of the channel in a colour.
        localparam int unsigned AT   = FRACTIONS ? 8 * k : LOW;
        localparam int unsigned SIZE = FRACTIONS ? 8 : BITS;

        texture_light #(.CHANNEL(BITS), .FRACTIONS(FRACTIONS)) light_wide (
            .clk, .dither, .light(light[k]), .texels({averages[1][k], averages[0][k]}), .thresholds(thresholds_8[1:0]),
            .colours({wide[1][AT +: SIZE], wide[0][AT +: SIZE]})
        );
        texture_light #(.CHANNEL(BITS), .FRACTIONS(FRACTIONS)) light_narrow (
            .clk, .dither, .light(light[k]), .texels({late[1][LOW +: BITS], REST'(0), late[0][LOW +: BITS], REST'(0)}),
            .thresholds(thresholds_8[3:2]), .colours({narrow[1][AT +: SIZE], narrow[0][AT +: SIZE]})
        );
    end

    assign out_colours = {in_bilinear ? wide : narrow, wide};
endmodule

`default_nettype wire

// Makes colours of the texels of a step: averages neighbours, and multiplies by the light.
//
//   clock  0                               6                7
//   neighbours, texels of 0, 1 ─▶ texture_lerp ────────────────▶ texture_light, 8 bits ──▶ lanes 0 and 1; bilinear: or 2 and 3
//   texels of 2, 3 ─────────────▶ delay ───────────────────────▶ texture_light, 5, 6, 5 ─▶ nearest: lanes 2 and 3
//                                      lights ─▶ texture_share ─▶
//
// A step of a nearest texture has a texel for each of four lanes, one of a bilinear texture has the neighbours of the lanes 0 and 1, or 2
// and 3. Two lanes therefore only need the bits of a channel, and two lerps and two wide multipliers serve both kinds of texture.
//
// `in_bilinear` must be constant while steps are inside. `lights` belongs to the step of LIGHT clocks before, by the lanes of the quad. The
// colours come FILTER clocks after their step; those of lanes without a bit in `out_mask` have no meaning. Throughput one step per clock;
// the pipeline cannot be stopped, and what follows always has room.

`default_nettype none

module texture_filter (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       in_valid,
    input  wire  [3:0]                in_mask,       // lanes of this step
    input  wire                       in_half,
    input  wire                       in_last,
    input  wire                       in_bilinear,
    input  wire  [3:0]                in_opaque,
    input  wire  [3:0][15:0]          in_texels,     // nearest: RGB565 of each lane
    input  wire  [1:0][3:0][15:0]     in_neighbours, // bilinear: of each pixel, (u, v), (u+1, v), (u, v+1), (u+1, v+1)
    input  wire  [1:0][1:0][3:0]      in_weights,    // of each pixel, across and down; u0.4
    input  wire  [3:0][2:0][7:0]      lights,        // of each lane, red in the lowest bits; u0.8, at most 248, green 252
    output logic                      out_valid,
    output logic [3:0]                out_mask,
    output logic                      out_half,
    output logic                      out_last,
    output logic [3:0]                out_opaque,
    output logic [3:0][15:0]          out_colours
);
    localparam int unsigned LIGHT  = texture_pkg::LIGHT;
    localparam int unsigned FILTER = texture_pkg::FILTER;

    logic [FILTER-1:0] valid;

    assign out_valid = valid[FILTER-1];

    always_ff @(posedge clk) valid <= rst ? '0 : {valid[FILTER-2:0], in_valid};

    delay #(.WIDTH(10), .CLOCKS(FILTER)) step (
        .clk, .enable(1'b1), .in({in_mask, in_half, in_last, in_opaque}), .out({out_mask, out_half, out_last, out_opaque})
    );

    // Whether a bilinear step has the upper lanes; from a register of its own, because it selects the lights.
    logic upper, upper_last;

    delay #(.WIDTH(1), .CLOCKS(LIGHT - 1)) upper_delay (.clk, .enable(1'b1), .in(in_mask[3:2] != '0), .out(upper_last));

    always_ff @(posedge clk) upper <= upper_last && in_bilinear;

    logic [1:0][2:0][7:0] averages;
    logic [1:0][15:0]     wide, nearest, narrow;

    for (genvar i = 0; i < 2; i++) begin : pixels
        texture_lerp lerp (
            .clk, .bilinear(in_bilinear), .nearest(in_texels[i]), .neighbours(in_neighbours[i]), .weights(in_weights[i]),
            .texel(averages[i])
        );

        delay #(.WIDTH(16), .CLOCKS(LIGHT)) nearest_delay (.clk, .enable(1'b1), .in(in_texels[2+i]), .out(nearest[i]));

        for (genvar k = 0; k < 3; k++) begin : channels
            localparam int unsigned BITS = k == 1 ? 6 : 5;
            localparam int unsigned LOW  = k == 0 ? 11 : k == 1 ? 5 : 0;

            logic [7:0] wide_share, narrow_share;

            texture_share #(.CHANNEL(BITS)) share_wide (.clk, .light(upper ? lights[2+i][k] : lights[i][k]), .share(wide_share));
            texture_share #(.CHANNEL(BITS)) share_narrow (.clk, .light(lights[2+i][k]), .share(narrow_share));

            texture_light #(.BITS(8), .CHANNEL(BITS)) light_wide (
                .clk, .texel(averages[i][k]), .share(wide_share), .colour(wide[i][LOW +: BITS])
            );
            texture_light #(.BITS(BITS), .CHANNEL(BITS)) light_narrow (
                .clk, .texel(nearest[i][LOW +: BITS]), .share(narrow_share), .colour(narrow[i][LOW +: BITS])
            );
        end
    end

    assign out_colours = {in_bilinear ? wide : narrow, wide};
endmodule

`default_nettype wire

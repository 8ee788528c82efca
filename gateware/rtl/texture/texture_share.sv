// Makes the factor of texture_light of the light of a channel (docs/formats/texture.md, "On a triangle").
//
// The light is u0.8, and full light is 248, or 252 in a channel of 6 bits. It stands for a share of 256, light + nearest(light·2^-CHANNEL),
// which is 256 for full light. `share` is this number minus 1, so that it has 8 bits. Of the smallest lights it differs by 1, where the
// product with any texel is rounded to 0. Light above full light gives a share that may be too small. Latency 1 clock.

`default_nettype none

module texture_share #(
    // Bits of the channel, 5 or 6.
    parameter int unsigned CHANNEL = 5
) (
    input  wire        clk,
    input  wire  [7:0] light,
    output logic [7:0] share
);
    // nearest(light·2^-CHANNEL) − 1 by the six highest bits of the light, which suffice.
    function automatic logic [255:0] corrections();
        for (int i = 0; i < 64; i++) corrections[4*i +: 4] = 4'(((4 * i + (1 << (8 - CHANNEL))) >> CHANNEL) - 1);
    endfunction

    localparam logic [255:0] CORRECTIONS = corrections();

    logic [3:0] correction;
    logic       is_dark, unused_carry;

    // The share must not be −1, so 1 is added again in the dark.
    assign correction = CORRECTIONS[{light[7:2], 2'd0} +: 4];
    assign is_dark    = CHANNEL == 5 ? light[7:2] == '0 : light[7:1] == '0;

    always_ff @(posedge clk) {share, unused_carry} <= {light, 1'b1} + {{4{correction[3]}}, correction, is_dark};

    wire _unused = &{1'b0, unused_carry};
endmodule

`default_nettype wire

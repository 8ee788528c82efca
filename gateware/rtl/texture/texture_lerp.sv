// Computes the weighted average of a pixel's four neighbours: three channels side by side in four DSP48.
//
//   clock  0             1            2          3             4            5          6
//          first, last ─▶ difference ─▶ product ─▶ above ──────▶ difference ─▶ product ─▶ red and green
//          first, last ─▶ difference ─▶ product ─▶ below ──────▶ difference ─▶ product ─▶ blue
//          across                                               down
//
// `above` is 16·first + (last − first)·across for the two upper neighbours, `below` is the same for the two lower neighbours, and the
// average is 16·above + (below − above)·down. A difference holds the channels side by side, with free bits between them for their products.
// The sum of each channel is not negative, so no channel borrows from the next channel, although a difference may be negative. `above` and
// `below` already include half a unit for the rounding, in bits that are 0 in 16·first. Without `bilinear`, which is constant while pixels
// are inside, the average is `nearest`.
//
// Output: eight bits of each channel, its integer part and fraction bits, rounded to nearest. Latency 6 clocks, throughput one pixel per
// clock; the pipeline cannot be stopped.

`default_nettype none

module texture_lerp (
    input  wire              clk,
    input  wire              bilinear,
    input  wire  [15:0]      nearest,    // RGB565, as the neighbours
    input  wire  [3:0][15:0] neighbours, // (u, v), (u+1, v), (u, v+1), (u+1, v+1)
    input  wire  [1:0][3:0]  weights,    // across, down; u0.4
    output logic [2:0][7:0]  texel       // red in the lowest bits
);
    // Blue, red and green, from the lowest bits, with four 0 bits above blue and above red.
    function automatic logic [23:0] packed_colour(input logic [15:0] colour);
        packed_colour = {colour[10:5], 4'd0, colour[15:11], 4'd0, colour[4:0]};
    endfunction

    // 16 times a colour, plus 1/16 of half a unit for the rounding: 2^(bits − 1)/16 for a channel of 5 or 6 bits.
    function automatic logic [27:0] scaled(input logic [15:0] colour);
        scaled = {colour[10:5], 4'd2, colour[15:11], 4'd1, colour[4:0], 4'd1};
    endfunction

    // The averages of the two upper neighbours and of the two lower neighbours.
    logic        [1:0][27:0] sums;

    for (genvar i = 0; i < 2; i++) begin : rows
        logic signed [24:0] difference;
        logic signed [4:0]  weight;
        logic signed [29:0] product;
        logic        [15:0] first_1;
        logic        [27:0] first_2, sum;

        assign sums[i] = sum;

        always_ff @(posedge clk) begin
            difference <= $signed({1'b0, packed_colour(neighbours[2*i+1])}) - $signed({1'b0, packed_colour(neighbours[2*i])});
            weight     <= bilinear ? {1'b0, weights[0]} : '0;
            first_1    <= i == 0 && !bilinear ? nearest : neighbours[2*i];

            product    <= difference * weight;
            first_2    <= scaled(first_1);

            sum        <= product[27:0] + first_2;
        end

        wire _unused = &{1'b0, product[29:28]};
    end

    // The average of both rows. Green is in the bits above red.
    logic        [3:0]       down;
    logic signed [4:0]       weight;
    logic signed [23:0]      difference;
    logic signed [9:0]       blue_difference;
    logic signed [28:0]      product;
    logic signed [14:0]      blue_product;
    logic        [27:0]      above_1, above_2;
    logic        [26:0]      average;
    logic        [12:0]      blue_average;

    delay #(.WIDTH(4), .CLOCKS(3)) down_delay (.clk, .enable(1'b1), .in(weights[1]), .out(down));

    always_ff @(posedge clk) begin
        difference      <= $signed({1'b0, sums[1][27:18], 4'd0, sums[1][17:9]}) - $signed({1'b0, sums[0][27:18], 4'd0, sums[0][17:9]});
        blue_difference <= $signed({1'b0, sums[1][8:0]}) - $signed({1'b0, sums[0][8:0]});
        weight          <= bilinear ? {1'b0, down} : '0;
        above_1         <= sums[0];

        product         <= difference * weight;
        blue_product    <= blue_difference * weight;
        above_2         <= above_1;

        average         <= product[26:0] + {above_2[27:18], 4'd0, above_2[17:9], 4'd0};
        blue_average    <= blue_product[12:0] + {above_2[8:0], 4'd0};
    end

    assign texel = {blue_average[12:5], average[26:19], average[12:5]};

    wire _unused = &{1'b0, product[28:27], blue_product[14:13], average[18:13], average[4:0], blue_average[4:0]};
endmodule

`default_nettype wire

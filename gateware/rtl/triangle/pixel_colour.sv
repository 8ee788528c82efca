// Computes the colour of a pixel from its accumulators of depth and light: divides the light of each channel by the depth, with a table of
// reciprocals (docs/formats/triangle.md, "Smooth shading").
//
//   clock   0          1           2               3                      4, 5, 6        7, 8
//           depth ─▶ zeros by 4 ─▶ zeros, index ─▶ table: inverse y ──┐
//           light ────────────────────────────────────────────────────┴▶ light·y + half ─▶ eight bits, by the zeros
//
// A channel has the format of the input of colour_pkg::rounded, and is at most full light. `zeros` is the number of leading zeros of the
// depth, at most 11. The table takes half a RAMB36. Latency 8 clocks, throughput one pixel per clock; the pipeline cannot be stopped.

`default_nettype none

module pixel_colour (
    input  wire              clk,
    input  wire              dither, // whether a channel is rounded to its fraction, or else truncated
    input  wire  [31:0]      depth, // with half a depth code added
    input  wire  [2:0][31:0] light, // red in the lowest bits
    output logic [2:0][7:0]  colour
);
    // Entry i of the table is nearest(2^17/(1 + (i + 1/2)/1024)), which is nearest(2^28/(2049 + 2·i)).
    (* ram_style = "block" *) logic [16:0] inverses [0:1023];

    initial begin
        for (int i = 0; i < 1024; i++) inverses[i] = 17'(((1 << 29) + 2049 + 2 * i) / (2 * (2049 + 2 * i)));
    end

    logic [1:0]  fours, ones, fours_1;
    logic [13:0] by_4;
    logic [9:0]  index;
    logic [3:0]  zeros, zeros_4, zeros_6;
    logic [16:0] inverse;
    logic [41:0] half;

    assign fours = depth[31:28] != '0 ? 2'd0 : depth[27:24] != '0 ? 2'd1 : 2'd2;
    assign ones  = by_4[13] ? 2'd0 : by_4[12] ? 2'd1 : by_4[11] ? 2'd2 : 2'd3;

    always_ff @(posedge clk) begin
        fours_1 <= fours;
        case (fours)
            2'd0:    by_4 <= depth[31:18];
            2'd1:    by_4 <= depth[27:14];
            default: by_4 <= depth[23:10];
        endcase
        zeros <= {fours_1, ones};
        case (ones)
            2'd0: index <= by_4[12:3];
            2'd1: index <= by_4[11:2];
            2'd2: index <= by_4[10:1];
            2'd3: index <= by_4[9:0];
        endcase
        half <= 42'(dither) << (6'd31 - 6'(zeros_4));
    end

    always_ff @(posedge clk) inverse <= inverses[index];

    delay #(.WIDTH(4), .CLOCKS(2)) zeros_delay (.clk, .enable(1'b1), .in(zeros), .out(zeros_4));
    delay #(.WIDTH(4), .CLOCKS(2)) zeros_delay_4 (.clk, .enable(1'b1), .in(zeros_4), .out(zeros_6));

    for (genvar k = 0; k < 3; k++) begin : channels
        localparam int unsigned BITS = k == 1 ? 6 : 5;
        logic        [23:0]     light_3;
        logic signed [41:0]     product;
        logic        [10:0]     window;
        logic        [7:0]      channel;
        logic                   dark, dark_6;

        delay #(.WIDTH(24), .CLOCKS(3)) light_delay (.clk, .enable(1'b1), .in(light[k][31:8]), .out(light_3));

        multiply_add #(.BITS(42)) dsp (
            .clk, .enable(1'b1), .a({1'b0, light_3}), .b({1'b0, inverse}), .c(half), .p(product)
        );

        // High if the light is negative, which rounding may cause if the exact light is 0. The channel is then 0.
        assign dark = light_3[23:18] == '1;

        delay #(.WIDTH(1), .CLOCKS(3)) dark_delay (.clk, .enable(1'b1), .in(dark), .out(dark_6));

        always_comb begin
            case (zeros_6[3:2])
                2'd0:    window = product[39:29];
                2'd1:    window = product[35:25];
                default: window = product[31:21];
            endcase
        end

        always_ff @(posedge clk) begin
            case (zeros_6[1:0])
                2'd0: channel <= window[10:3];
                2'd1: channel <= window[9:2];
                2'd2: channel <= window[8:1];
                2'd3: channel <= window[7:0];
            endcase
            if (dark_6) channel <= '0;

            // Full light may be rounded to slightly above the largest step.
            colour[k] <= channel[7 -: BITS] == '1 ? {{BITS{1'b1}}, {(8 - BITS){1'b0}}} : channel;
        end

        wire _unused = &{1'b0, product[41:40], product[20:0], light[k][7:0]};
    end

    wire _unused = &{1'b0, depth[9:0]};
endmodule

`default_nettype wire

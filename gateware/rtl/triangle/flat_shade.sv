// Flat shading: intensity = clamp(nearest(∓N·l·2^8), 0, 1), with N the normal of the triangle, l the row of the light (the camera's
// viewing direction n for a light at the camera), and − for a front face. The result is colour·intensity, rounded to nearest.
//
// One multiplier makes five products: three for N·l, one for blue and green side by side, and one for red. The module `setup`
// drives `count`, the number of the clock in a beat (the time of a triangle in a stage of `setup`, 11 clocks or more). The
// inputs hold during a beat; the colour is valid in clock 10 of the beat.

`default_nettype none

module flat_shade (
    input  wire              clk,
    input  wire              enable,
    input  wire  [3:0]       count,
    input  wire  [2:0][24:0] row_light,
    input  wire              front,
    input  wire  [2:0][15:0] normal,
    input  wire  [15:0]      colour,
    output logic [15:0]      lit
);
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [43:0] c, p;
    logic signed [16:0] component, towards;
    logic        [8:0]  intensity;
    logic        [10:0] green_blue;

    always_comb begin
        unique case (count[1:0])
            2'd0:    component = 17'($signed(normal[0]));
            2'd1:    component = 17'($signed(normal[1]));
            default: component = 17'($signed(normal[2]));
        endcase
        towards = (component ^ {17{front}}) + 17'(front);

        unique case (count)
            4'd0:    a = row_light[0];
            4'd1:    a = row_light[1];
            4'd2:    a = row_light[2];
            4'd6:    a = {6'b0, colour[10:5], 8'b0, colour[4:0]};
            default: a = {20'b0, colour[15:11]};
        endcase
        b = count[2] ? {9'b0, intensity} : 18'(towards);

        unique case (count)
            4'd2:       c = 44'd1 << 28;
            4'd3, 4'd4: c = p;
            default:    c = 44'd1 << 20 | 44'd1 << 7;
        endcase
    end

    // The intensity is 0 where the sum is negative, 1 where the sum is at least 1, otherwise the fraction of the sum.
    always_ff @(posedge clk) begin
        if (count == 4'd5) intensity <= p[43] ? '0 : p[42:37] != '0 ? 9'h100 : {1'b0, p[36:29]};
        if (count == 4'd9) green_blue <= {p[26:21], p[12:8]};
    end

    assign lit = {p[12:8], green_blue};

    multiply_add #(.BITS(44)) dsp (.clk, .enable, .a, .b, .c, .p);

    wire _unused = &{1'b0, p[28:27], p[20:13], p[7:0]};
endmodule

`default_nettype wire

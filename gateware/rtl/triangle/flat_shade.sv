// Flat shading (docs/formats/triangle.md, "Pixels" and "Light on meshes"). The intensity is clamp(nearest(∓N·l·2^8), 0, 1), where N is the
// normal of the triangle and l the row of the light, with − for a front face. The share of each channel is min(1, ambient +
// nearest(light·intensity)). The lit colour is colour·share, rounded to nearest.
//
// One multiplier computes nine products: three for N·l, one for each share, and one for each channel of the colour. The module
// `setup` drives `count`, the number of the clock in a beat (the time of a triangle in a stage of `setup`, 11 clocks or more). The inputs
// must hold during a beat. The colour arrives one beat after the normal, and the lit colour is valid from clock 10 of that beat on. For two
// consecutive triangles:
//
//   count      0 … 2     3 … 5              7 … 9
//   factors    N·l       colour·share       light·intensity
//              second    first              second

`default_nettype none

module flat_shade #(
    parameter bit TEXTURE = 1'b0
) (
    input  wire              clk,
    input  wire              enable,
    input  wire  [3:0]       count,
    input  wire  [2:0][24:0] row_light,
    input  wire  [2:0][8:0]  light_colour, // u1.8, red is the lowest
    input  wire  [2:0][8:0]  ambient,
    input  wire              front,
    input  wire  [2:0][15:0] normal,
    input  wire  [15:0]      colour,       // of the previous triangle
    output logic [15:0]      lit,
    // With TEXTURE: whether the previous triangle has a texture. Its light then replaces the lit colour: u0.8 of each channel, red is the
    // lowest (docs/formats/texture.md, "On a triangle").
    input  wire              textured,
    output logic [2:0][7:0]  light
);
    logic signed [24:0] a, chosen_a;
    logic signed [17:0] b, chosen_b;
    logic signed [43:0] addend, c, p;
    logic signed [16:0] component, towards;
    // A queue of shares, red first; in clocks 7 to 9 its head is the intensity.
    logic        [8:0]  head, second, third, intensity, share;

    always_comb begin
        unique case (count[1:0])
            2'd0:    component = 17'($signed(normal[0]));
            2'd1:    component = 17'($signed(normal[1]));
            default: component = 17'($signed(normal[2]));
        endcase
        towards = (component ^ {17{front}}) + 17'(front);

        unique case (count)
            4'd0:    chosen_a = row_light[0];
            4'd1:    chosen_a = row_light[1];
            4'd2:    chosen_a = row_light[2];
            4'd3:    chosen_a = {20'b0, colour[15:11]};
            4'd4:    chosen_a = {19'b0, colour[10:5]};
            4'd5:    chosen_a = {20'b0, colour[4:0]};
            4'd7:    chosen_a = {16'b0, light_colour[0]};
            4'd8:    chosen_a = {16'b0, light_colour[1]};
            default: chosen_a = {16'b0, light_colour[2]};
        endcase
        chosen_b = count < 4'd3 ? 18'(towards) : {9'b0, head};

        // The addend is selected three clocks after the factors of its product.
        unique case (count)
            4'd3:             addend = 44'd1 << 28;
            4'd6, 4'd8:       addend = TEXTURE && textured ? 44'd1 << 4 : 44'd1 << 7;
            4'd7:             addend = TEXTURE && textured ? 44'd1 << 5 : 44'd1 << 7;
            4'd10:            addend = {27'b0, ambient[0], 8'h80};
            4'd0:             addend = {27'b0, ambient[1], 8'h80};
            default:          addend = {27'b0, ambient[2], 8'h80};
        endcase
        c = count == 4'd4 || count == 4'd5 ? p : addend;

        // The intensity is 0 if the sum is negative, 1 if the sum is at least 1, otherwise the fraction of the sum.
        intensity = p[43] ? '0 : p[42:37] != '0 ? 9'h100 : {1'b0, p[36:29]};
        share     = p[17:16] != '0 ? 9'h100 : {1'b0, p[15:8]};
    end

    always_ff @(posedge clk) begin
        // Extra registers before the registers of the multiplier, so that the multiplier can be placed far from the sources of its factors.
        if (enable) {a, b} <= {chosen_a, chosen_b};

        if (count == 4'd6) begin
            head <= intensity;
        end else if (count <= 4'd4) begin
            {head, second, third} <= {second, third, share};
        end
        if (count == 4'd7) lit[15:11] <= p[12:8];
        if (count == 4'd8) lit[10:5]  <= p[13:8];
        if (count == 4'd9) lit[4:0]   <= p[12:8];
    end

    if (TEXTURE) begin : of_texture
        always_ff @(posedge clk) begin
            if (count == 4'd7) light[0] <= p[12:5];
            if (count == 4'd8) light[1] <= p[13:6];
            if (count == 4'd9) light[2] <= p[12:5];
        end
    end else begin : of_colours
        assign light = '0;

        wire _unused = &{1'b0, textured};
    end

    multiply_add #(.BITS(44)) dsp (.clk, .enable, .a, .b, .c, .p);

    wire _unused = &{1'b0, p[28:18], p[7:0]};
endmodule

`default_nettype wire

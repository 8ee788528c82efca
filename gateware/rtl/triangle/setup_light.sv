// Stage 1 of the triangle setup for smooth shading and textures: computes P = nearest((w + 1/2)·L) of each vertex and channel
// (docs/formats/triangle.md, "Smooth shading"), where w is the depth of the vertex, and L is the light of the vertex or its share σ of a
// texture coordinate (docs/formats/texture.md, "On a triangle"). The results are the inputs of a plane: P at vertex 0 (`value`), and P at
// the other vertices minus P at vertex 0 (`p10`, `p20`).
//
// A round computes the three products of a channel, vertex after vertex, for the triangle in stage 1. The results wait in a queue until the
// same round of the next beat. The module `setup` drives `count`, the number of the clock in a round (11 clocks or more), `round`, and
// `next`, which is high one clock before the last clock of a round. The inputs must hold during a beat.
//
//   count        0 … 2      3 … 5      6 …        10
//   factors      vertex 0   vertex 1   vertex 2
//   result                  4: P of 0  7: p10     p20

`default_nettype none

module setup_light #(
    parameter bit TEXTURE = 1'b0
) (
    input  wire         clk,
    input  wire  [3:0]  count,
    input  wire  [1:0]  round,
    input  wire         next,
    input  wire  [23:0] w0,
    input  wire  [24:0] w10,
    input  wire  [24:0] w20,
    input  wire         front,
    input  wire         swap,   // vertices 1 and 2 of the mesh are exchanged
    input  wire  [2:0][triangle_pkg::LIGHT_BITS-1:0] lights, // triangle_pkg::light_t each, numbered as in the mesh
    // With TEXTURE: `is_coordinate` is high if the channel is a texture coordinate. Its share, u0.17, arrives one clock after
    // `place`. `linear` is high in orthographic projection.
    input  wire         is_coordinate,
    input  wire         linear,
    input  wire  [16:0] share,
    output logic [1:0]  place,   // number of the vertex in the mesh
    // Results for the triangle in stage 2, in the channel of the round.
    output logic [23:0] value,
    output logic [24:0] p10,
    output logic [24:0] p20
);
    // In orthographic projection this constant replaces w.
    localparam logic [24:0] WEIGHT = 25'd8388576;

    logic        [1:0]    vertex;
    logic        [24:0]   w;
    logic        [17:0]   half;
    logic        [15:0]   lit;
    logic        [16:0]   factor;
    logic signed [43:0]   p;
    triangle_pkg::light_t light;

    always_comb begin
        vertex = count < 4'd3 ? 2'd0 : count < 4'd6 ? 2'd1 : 2'd2;
        place  = vertex[0] && swap ? 2'd2 : vertex[1] && swap ? 2'd1 : vertex;
        unique case (place)
            2'd0:    light = lights[0];
            2'd1:    light = lights[1];
            default: light = lights[2];
        endcase
        // L of the vertex in this channel, u0.16; 0 if the light belongs to the other side of the triangle.
        unique case (round)
            2'd0:    lit = light.red;
            2'd1:    lit = light.green;
            default: lit = light.blue;
        endcase
        if (light.back == front) lit = '0;
        factor = TEXTURE && is_coordinate ? share : {lit, 1'b0};
    end

    // The product is w·L + L/2 + 1/2. Half a depth code is 2^5 units of w; half a unit of P is 2^16 units of the product.
    always_ff @(posedge clk) begin
        w    <= TEXTURE && is_coordinate && linear ? WEIGHT : {1'b0, w0} + (vertex[0] ? w10 : vertex[1] ? w20 : '0);
        half <= {1'b0, factor} + 18'd2048;
    end

    multiply_add #(.BITS(44)) dsp (.clk, .enable(1'b1), .a(w), .b({1'b0, factor}), .c({21'b0, half, 5'b0}), .p);

    logic [23:0] first;
    logic [24:0] p10_1, difference;
    logic [73:0] queue_1, queue_2;

    assign difference = {1'b0, p[40:17]} - {1'b0, first};

    always_ff @(posedge clk) begin
        if (count == 4'd4) first <= p[40:17];
        if (count == 4'd7) p10_1 <= difference;
    end

    wide_register #(.WIDTH(3 * 74)) queue (
        .clk, .next, .in({queue_1, queue_2, first, difference, p10_1}), .out({value, p20, p10, queue_1, queue_2})
    );

    wire _unused = &{1'b0, p[43:41], p[16:0], is_coordinate, linear, share};
endmodule

`default_nettype wire

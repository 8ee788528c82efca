// The vertex stage: computes the position on the screen and the depth of mesh vertices, in order. docs/formats/triangle.md, "Vertex stage",
// defines the computation (steps 1 to 8) and the letters f, m, y, X, Y, X' and Y'. If `orthographic` is high, the vertex stage computes
// "Orthographic projection" of the same document instead, in the same number of clocks.
//
// Throughput one vertex per 6 clocks; latency 39 clocks, plus up to 5 clocks until the vertex's slot in the schedule. Four multipliers work
// in a fixed schedule of 6 clocks, which repeats for each vertex: `half` is 0, 0, 0, 1, 1, 1 and `element` is 0, 1, 2, 0, 1, 2 in clocks 1
// to 6 of a vertex. Clock 0 is the vertex's entry. A vertex is only accepted if the FIFO at the end has a free entry for it, so the
// schedule never stalls.
//
//   clock  1         7            9                  25             37
//     in ─▶ transform ─▶ lead ──────▶ m ─▶ reciprocal ──▶ y ─▶ snap ───▶ FIFO ─▶ out
//                  └──▶ X, Y ─▶ normalise ──────────▶ X', Y' ─┘
//
// The frame's constants must hold from the entry of its first vertex until its last vertex has left. For a vertex behind the near plane all
// fields except `behind` are 0. For a vertex beyond the guard band x and y are saturated to s12.8.

`default_nettype none

module vertex_stage #(
    // See vertex_snap.
    parameter bit AVERAGE = 1'b0
) (
    input  wire                clk,
    input  wire                rst,
    // Frame constants.
    input  wire                orthographic,
    input  wire  [4:0]         scale_shift, // f of docs/formats/camera.md, or f + 1 − ke in orthographic projection
    input  wire  [2:0][24:0]   row_u,       // x component in the lowest bits
    input  wire  [2:0][24:0]   row_v,
    input  wire  [2:0][24:0]   row_n,
    input  wire  signed [43:0] tx,
    input  wire  signed [43:0] ty,
    input  wire  signed [43:0] tz,
    input  wire  [38:0]        near_z,
    input  wire  [10:0]         centre_x,
    input  wire  [10:0]         centre_y,
    input  wire  [16:0]        depth_mantissa,
    input  wire  signed [3:0]  depth_exponent,
    // Positions, s2.14 each.
    input  wire                in_valid,
    output logic               in_ready,
    input  wire  [2:0][15:0]   in_position,
    output logic               out_valid,
    input  wire                out_ready,
    output triangle_pkg::projected_t out_vertex
);
    localparam int unsigned PLACES = 16;

    logic                    half, turn;
    logic [1:0]              element;
    logic [$clog2(PLACES):0] held;     // vertices inside the stage
    logic [6:0]              ages;     // bit k: high if a vertex is in its clocks 6·k + 1 to 6·k + 6
    logic [2:0][15:0]        position;

    assign turn     = half && element == 2'd2;
    assign in_ready = turn && !held[$clog2(PLACES)];

    always_ff @(posedge clk) begin
        element <= element == 2'd2 ? 2'd0 : element + 2'd1;
        half    <= half ^ (element == 2'd2);
        held    <= held + 5'(in_valid && in_ready) - 5'(out_valid && out_ready);
        if (turn) begin
            ages     <= {ages[5:0], in_valid && in_ready};
            position <= in_position;
        end

        if (rst) begin
            element <= 2'd0;
            half    <= 1'b0;
            held    <= '0;
            ages    <= '0;
        end
    end

    logic signed [38:0] planar;
    logic        [3:0]  zeros;
    logic               behind;
    logic        [23:0] mantissa, inverse;
    logic signed [24:0] x, y;
    triangle_pkg::projected_t vertex;

    vertex_transform transform (
        .clk(clk), .half(half), .element(element), .orthographic(orthographic), .depth_exponent(depth_exponent),
        .row_u(row_u), .row_v(row_v), .row_n(row_n), .tx(tx), .ty(ty), .tz(tz), .near_z(near_z), .position(position),
        .planar(planar), .zeros(zeros), .behind(behind), .mantissa(mantissa));

    vertex_normalise normalise (
        .clk(clk), .half(half), .element(element), .scale_shift(scale_shift), .planar(planar), .zeros(zeros),
        .x(x), .y(y));

    vertex_reciprocal reciprocal (
        .clk(clk), .half(half), .element(element), .orthographic(orthographic), .m(mantissa), .y(inverse));

    vertex_snap #(.AVERAGE(AVERAGE)) snap (
        .clk(clk), .half(half), .element(element), .orthographic(orthographic), .centre_x(centre_x), .centre_y(centre_y),
        .depth_mantissa(depth_mantissa), .depth_exponent(depth_exponent), .zeros(zeros), .behind(behind), .x(x), .y(y),
        .inverse(inverse), .vertex(vertex));

    // The FIFO is never full, because an entry is reserved for each vertex inside the stage.
    logic room, unused;
    assign unused = room;

    fifo #(.WIDTH($bits(vertex)), .DEPTH(PLACES)) finished (
        .clk(clk), .rst(rst), .in_valid(ages[6] && !half && element == 2'd0), .in_ready(room), .in_data(vertex),
        .out_valid(out_valid), .out_ready(out_ready), .out_data(out_vertex));
endmodule

`default_nettype wire

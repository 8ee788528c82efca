// Selects the path of a triangle after the vertex stage (`Renderer::path` of glint-model): the triangle is sent to the setup, or its number
// is sent to the firmware's clipper as an exception, or the triangle is dropped.
//
//   all vertices behind, or none behind and all beyond the same side of the picture   dropped, with a pulse of `unseen`
//   otherwise, a vertex behind or beyond the guard band                            exception: its number is sent out
//   otherwise                                                                      regular: goes to the setup
//
// Latency 2 clocks. Throughput: one triangle per 3 clocks, in which `vertex_cache` collects the vertices of the next triangle. The module
// holds one triangle, so `in_ready` comes directly from registers. `width` and `height` must hold while a triangle is inside. Triangles are
// numbered in the order of their arrival, from 0 after `restart`.

`default_nettype none

module classify #(
    parameter int unsigned SIDE_BITS = 64
) (
    input  wire                      clk,
    input  wire                      rst,
    input  wire                      restart,
    input  wire  [10:0]              width,
    input  wire  [9:0]               height,
    output logic                     idle,
    // High for one clock for each triangle that is dropped.
    output logic                     unseen,
    output logic [31:0]              count,
    input  wire                      in_valid,
    output logic                     in_ready,
    input  wire  [2:0][67:0]         in_vertices,      // projected_t each
    input  wire  [SIDE_BITS-1:0]     in_side,
    output logic                     regular_valid,
    input  wire                      regular_ready,
    output logic [2:0][65:0]         regular_vertices, // screen_vertex_t each
    output logic [SIDE_BITS-1:0]     regular_side,
    output logic                     exception_valid,
    input  wire                      exception_ready,
    output logic [31:0]              exception_number
);
    // Returns the sides of the picture beyond which a vertex lies: left, right, top, bottom. x and y are the integer parts of the vertex's
    // position.
    function automatic logic [3:0] off_sides(input logic [12:0] x, input logic [12:0] y);
        off_sides = {x[12], !x[12] && x[11:0] >= 12'(width), y[12], !y[12] && y[11:0] >= 12'(height)};
    endfunction

    logic            known, leaves;
    logic [2:0][3:0] off;
    logic [2:0]      behind, beyond;
    logic            is_unseen, is_exceptional;

    // The first clock examines each vertex, and the second clock classifies the triangle; the result is valid while `known` is high.
    assign idle           = in_ready;
    assign is_unseen      = behind == '1 || behind == '0 && (off[0] & off[1] & off[2]) != '0;
    assign is_exceptional = behind != '0 || beyond != '0;

    logic [2:0][65:0] places;
    logic [2:0][3:0]  in_off;
    logic [2:0]       in_behind, in_beyond;

    for (genvar i = 0; i < 3; i++) begin : vertices
        triangle_pkg::projected_t vertex;

        assign vertex       = in_vertices[i];
        assign places[i]    = vertex.place;
        assign in_behind[i] = vertex.behind;
        assign in_beyond[i] = vertex.beyond;
        assign in_off[i]    = off_sides(vertex.place.x[20:8], vertex.place.y[20:8]);
    end

    held_register #(.WIDTH(SIDE_BITS + 3 * 66 + 12 + 3 + 3)) inputs (
        .clk, .rst, .free(in_ready), .in_valid, .in({in_side, places, in_off, in_beyond, in_behind}), .leaves,
        .out({regular_side, regular_vertices, off, beyond, behind})
    );

    logic to_regular, to_exception;

    assign regular_valid    = known && to_regular;
    assign exception_valid  = known && to_exception;
    assign exception_number = count;
    assign unseen           = known && !to_regular && !to_exception;
    assign leaves           = known && (to_regular ? regular_ready : !to_exception || exception_ready);

    always_ff @(posedge clk) begin
        to_regular   <= !is_unseen && !is_exceptional;
        to_exception <= !is_unseen && is_exceptional;
        known        <= !in_ready && !leaves;
        if (leaves) count <= count + 1'b1;

        if (restart) count <= '0;
        if (rst) known <= 1'b0;
    end
endmodule

`default_nettype wire

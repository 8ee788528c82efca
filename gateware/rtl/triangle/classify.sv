// Decides where a triangle goes after the vertex stage (`Renderer::path` of glint-model): to the setup, to the clipper as
// an exception, or nowhere.
//
//   all vertices behind, or none behind and all off the same side of the picture   unseen: leaves no trace but `unseen`
//   else one behind, or one beyond the guard band                                  exception: its number goes out
//   else                                                                           regular
//
// Latency 2 clocks, throughput a triangle a clock. `width` and `height` hold while triangles are inside. Triangles are
// numbered in the order they come, from 0 after `restart`.

`default_nettype none

module classify
    import triangle_pkg::*;
#(
    parameter int unsigned SIDE_BITS = 64
) (
    input  wire                      clk,
    input  wire                      rst,
    input  wire                      restart,
    input  wire  [10:0]              width,
    input  wire  [9:0]               height,
    output logic                     idle,
    // One clock for each triangle that is in no other place.
    output logic                     unseen,
    output logic [31:0]              count,
    input  wire                      in_valid,
    output logic                     in_ready,
    input  wire  projected_t [2:0]   in_vertices,
    input  wire  [SIDE_BITS-1:0]     in_side,
    output logic                     regular_valid,
    input  wire                      regular_ready,
    output screen_vertex_t [2:0]     regular_vertices,
    output logic [SIDE_BITS-1:0]     regular_side,
    output logic                     exception_valid,
    input  wire                      exception_ready,
    output logic [31:0]              exception_number
);
    // Sides of the picture that a vertex is off.
    typedef struct packed {
        logic left, right, above, below;
    } sides_t;

    // Of the whole pixels of a place.
    function automatic sides_t off_sides(input logic [12:0] x, input logic [12:0] y);
        off_sides.left  = x[12];
        off_sides.right = !x[12] && x[11:0] >= 12'(width);
        off_sides.above = y[12];
        off_sides.below = !y[12] && y[11:0] >= 12'(height);
    endfunction

    logic                 held, known, moves;
    projected_t [2:0]     vertices;
    logic [SIDE_BITS-1:0] side;
    sides_t [2:0]         off;
    logic                 all_behind, any_behind, any_exceptional;

    assign idle = !held && !known;

    // First what is known of each vertex, then what follows of all.
    logic next_free, is_unseen;

    assign next_free  = !known || moves;
    assign in_ready   = !held || next_free;
    assign any_behind = vertices[0].behind || vertices[1].behind || vertices[2].behind;
    assign all_behind = vertices[0].behind && vertices[1].behind && vertices[2].behind;
    assign is_unseen  = all_behind || !any_behind && (off[0] & off[1] & off[2]) != '0;
    assign any_exceptional = any_behind || vertices[0].beyond || vertices[1].beyond || vertices[2].beyond;

    logic to_regular, to_exception;

    assign regular_valid   = known && to_regular;
    assign exception_valid = known && to_exception;
    assign moves           = to_regular ? regular_ready : !to_exception || exception_ready;

    always_ff @(posedge clk) begin
        if (in_ready) begin
            held     <= in_valid;
            vertices <= in_vertices;
            side     <= in_side;
            for (int i = 0; i < 3; i++) off[i] <= off_sides(in_vertices[i].place.x[20:8], in_vertices[i].place.y[20:8]);
        end

        unseen <= 1'b0;
        if (next_free) begin
            known        <= held;
            to_regular   <= !is_unseen && !any_exceptional;
            to_exception <= !is_unseen && any_exceptional;
            unseen       <= held && is_unseen;
            for (int i = 0; i < 3; i++) regular_vertices[i] <= vertices[i].place;
            regular_side     <= side;
            exception_number <= count;
            if (held) count <= count + 1'b1;
        end

        if (restart) count <= '0;
        if (rst) begin
            held   <= 1'b0;
            known  <= 1'b0;
            unseen <= 1'b0;
        end
    end
endmodule

`default_nettype wire

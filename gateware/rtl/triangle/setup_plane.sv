// Stages 3 and 4 of the triangle setup: computes the gradients of a plane, and its accumulator at the start pixel, from the
// normal (Nx, Ny) of the plane. A plane is a value that is linear on the screen: the depth, or one channel of light.
//
// The module `setup` drives `count`, the number of the clock in a beat (the time of a triangle in a stage of `setup`, or of a
// channel of its light, 11 clocks or more), and `next`, which is high one clock before the last clock of a beat. The normal is valid
// at the end of a beat. The reciprocal must hold during the next beat, and the inputs for vertex 0 during the beat after that. All outputs
// are valid at the end of the latter beat.

`default_nettype none

module setup_plane (
    input  wire         clk,
    input  wire         next,
    input  wire  [3:0]  count,
    input  wire  [45:0] nx,
    input  wire  [45:0] ny,
    // Stage 3.
    input  wire  [23:0] y,
    input  wire  [5:0]  lead,
    // Inputs of stage 4: the centre of the start pixel relative to vertex 0, and the plane's value at vertex 0, u18.6.
    input  wire  [20:0] px,
    input  wire  [20:0] py,
    input  wire  [23:0] value,
    output logic [31:0] step_x,
    output logic [31:0] step_y,
    output logic [31:0] start
);
    logic [45:0] nx_3, ny_3;
    logic [40:0] twice_gx, twice_gy, twice_gx_4, twice_gy_4;
    logic [39:0] gx, gy;
    logic [3:0]  count_4;

    assign step_x = gx[31:0];
    assign step_y = gy[31:0];

    wide_register #(.WIDTH(2 * 46 + 2 * 41)) stages (
        .clk, .next, .in({nx, ny, twice_gx, twice_gy}), .out({nx_3, ny_3, twice_gx_4, twice_gy_4})
    );

    // Stage 4 begins one clock after the beginning of its beat, because the gradients are rounded in this clock.
    always_ff @(posedge clk) begin
        gx <= twice_gx_4[40:1] + 40'(twice_gx_4[0]);
        gy <= twice_gy_4[40:1] + 40'(twice_gy_4[0]);
        count_4 <= count;
    end

    setup_gradient gradient (.clk, .count, .nx(nx_3), .ny(ny_3), .y, .lead, .twice_gx, .twice_gy);
    setup_start at_start (.clk, .next_is_odd(count[0]), .count(count_4), .gx, .gy, .px, .py, .value, .start);
endmodule

`default_nettype wire

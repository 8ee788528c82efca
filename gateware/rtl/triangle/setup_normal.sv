// Computes the normal of a plane, a value w that is linear on the screen: Nx = w10·y20 + w20·y01 and Ny = w20·x10 + w10·x02,
// s46. w10 is w1 − w0, y01 is y0 − y1, and so on.
//
// Each component needs four products: first two products with the four high bits of a coordinate difference, then two products with its 17
// low bits. The module `setup` drives `count`, the number of the clock in a beat (the time of a triangle in a stage of `setup`, 11 clocks
// or more). The inputs must hold during a beat; Nx is valid from clock 7 on, Ny in clock 10.

`default_nettype none

module setup_normal (
    input  wire         clk,
    input  wire         enable,
    input  wire  [3:0]  count,
    input  wire  [24:0] w10,
    input  wire  [24:0] w20,
    input  wire  [20:0] x10,
    input  wire  [20:0] y01,
    input  wire  [20:0] x02,
    input  wire  [20:0] y20,
    output logic [45:0] nx,
    output logic [45:0] ny
);
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [45:0] c, p;
    logic        [20:0] factor;

    // The factors follow from count = 4·k + 2·low + term: k is 0 for Nx and 1 for Ny, low is 1 for the low bits, term is 0 or 1
    // for the first or second product of the formula. The addend `c` is selected two clocks after the factors of its product.
    always_comb begin
        a      = $signed(count[2] ^ count[0] ? w20 : w10);
        factor = count[2] ? (count[0] ? x02 : x10) : (count[0] ? y01 : y20);
        b      = count[1] ? {1'b0, factor[16:0]} : 18'($signed(factor[20:17]));
        c      = count[0] ? p : count[1] ? '0 : {p[28:0], 17'b0};
    end

    always_ff @(posedge clk) begin
        if (count == 4'd6) nx <= p;
    end

    assign ny = p;

    multiply_add #(.BITS(46)) dsp (.clk, .enable, .a, .b, .c, .p);
endmodule

`default_nettype wire

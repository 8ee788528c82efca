// Computes E − bias for edges 0 and 2 of a triangle, with 8 fraction bits. E is the edge function at the start pixel.
//
// Both edges pass through vertex 0, and (px, py) is the centre of the start pixel relative to vertex 0. An edge needs four products: first
// two products with the 17 low bits of its steps, then two products with the high bits. The module `setup` drives `count`, the number of
// the clock in a beat (the time of a triangle in a stage of `setup`, 11 clocks or more). The inputs must hold during a beat; E0 is valid
// from clock 7 on, E2 in clock 10.

`default_nettype none

module setup_edges (
    input  wire         clk,
    input  wire         enable,
    input  wire  [3:0]  count,
    input  wire  [20:0] px,
    input  wire  [20:0] py,
    input  wire  [20:0] x10,
    input  wire  [20:0] y01,
    input  wire  [20:0] x02,
    input  wire  [20:0] y20,
    input  wire         bias0,
    input  wire         bias2,
    output logic [41:0] e0,
    output logic [41:0] e2
);
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [43:0] c, p;
    logic        [20:0] step;
    logic        [16:0] low;

    // The factors follow from count = 4·k + 2·high + term: k is 0 for edge 0 and 1 for edge 2, high is 1 for the high bits of a
    // step, term is 0 for the product with py and 1 for the product with px. The addend `c` is selected two clocks after the factors of its
    // product.
    always_comb begin
        a    = 25'($signed(count[0] ? px : py));
        step = count[2] ? (count[0] ? y20 : x02) : (count[0] ? y01 : x10);
        b    = count[1] ? 18'($signed(step[20:17])) : {1'b0, step[16:0]};
        c    = count[0] ? p : count[1] ? {44{count[2] ? bias2 : bias0}} : p >>> 17;
    end

    always_ff @(posedge clk) begin
        if (count[1:0] == 2'd0) low <= p[16:0];
        if (count == 4'd6)      e0  <= {p[24:0], low};
    end

    assign e2 = {p[24:0], low};

    multiply_add #(.BITS(44)) dsp (.clk, .enable, .a, .b, .c, .p);

    wire _unused = &p[43:25];
endmodule

`default_nettype wire

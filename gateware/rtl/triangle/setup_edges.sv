// Computes edge functions 0 and 2 of a triangle at the start pixel, minus their biases, with 8 fraction bits: E − bias.
//
// Both edges pass through vertex 0, and (px, py) is the centre of the start pixel relative to vertex 0. An edge takes four
// products, first those of the 17 low bits of its steps. Driven by the `count` of the setup's beat: the inputs hold during a
// beat; E0 is valid from clock 7 on, E2 in clock 10.

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

    // Selects operands by clock = 4·k + 2·high + term, with k = 0 for edge 0 and 1 for edge 2. The sum
    // follows two clocks later.
    always_comb begin
        a    = 25'($signed(count[0] ? px : py));
        step = count[2] ? (count[0] ? y20 : x02) : (count[0] ? y01 : x10);
        b    = count[1] ? 18'($signed(step[20:17])) : {1'b0, step[16:0]};
        unique case (count[1:0])
            2'd2:    c = {44{count[2] ? bias2 : bias0}};
            2'd0:    c = p >>> 17;
            default: c = p;
        endcase
    end

    always_ff @(posedge clk) begin
        if (enable && count[1:0] == 2'd0) low <= p[16:0];
        if (enable && count == 4'd6)      e0  <= {p[24:0], low};
    end

    assign e2 = {p[24:0], low};

    multiply_add #(.BITS(44)) dsp (.clk, .enable, .a, .b, .c, .p);

    wire _unused = &p[43:25];
endmodule

`default_nettype wire

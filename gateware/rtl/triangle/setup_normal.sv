// Computes the normal of a plane: Nx = w10·y20 + w20·y01 and Ny = w20·x10 + w10·x02, s46.
//
// Each component takes four products, first those of the four high bits. Driven by the `count` of the setup's beat: the inputs
// hold during a beat; Nx is valid from clock 7 on, Ny in clock 10.

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

    // Selects operands by clock = 4·y + 2·low + term, with y = 1 for Ny. The sum follows two clocks later.
    always_comb begin
        a      = $signed(count[2] ^ count[0] ? w20 : w10);
        factor = count[2] ? (count[0] ? x02 : x10) : (count[0] ? y01 : y20);
        b      = count[1] ? {1'b0, factor[16:0]} : 18'($signed(factor[20:17]));
        unique case (count[1:0])
            2'd2:    c = '0;
            2'd0:    c = {p[28:0], 17'b0};
            default: c = p;
        endcase
    end

    always_ff @(posedge clk) begin
        if (enable && count == 4'd6) nx <= p;
    end

    assign ny = p;

    multiply_add #(.BITS(46)) dsp (.clk, .enable, .a, .b, .c, .p);
endmodule

`default_nettype wire

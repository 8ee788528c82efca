// Computes the gradients of a plane (the depth, or one channel of light) before their rounding, from its normal (Nx, Ny) and
// the reciprocal y of the area: floor(Nx·y·2^−(lead + 7)) modulo 2^41, and the same for Ny.
//
// Each gradient needs three products, in which the normal is split into parts of 17, 17 and 12 bits from the low end. A shift in three
// parts follows: by multiples of 16, of 4 and of 1. The module `setup` drives `count`, the number of the clock in a beat (the time of a
// triangle in a stage of `setup`, 11 clocks or more). The inputs must hold during a beat. The result for Nx is valid from clock 8 on, the
// result for Ny in clock 10, even while that clock is repeated.

`default_nettype none

module setup_gradient (
    input  wire         clk,
    input  wire  [3:0]  count,
    input  wire  [45:0] nx,
    input  wire  [45:0] ny,
    input  wire  [23:0] y,
    input  wire  [5:0]  lead,
    output logic [40:0] twice_gx,
    output logic [40:0] twice_gy
);
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [43:0] c, p;
    logic        [16:0] low, middle;
    logic        [69:0] product;

    always_comb begin
        a = {1'b0, y};
        unique case (count)
            4'd0:    b = {1'b0, nx[16:0]};
            4'd1:    b = {1'b0, nx[33:17]};
            4'd2:    b = 18'($signed(nx[45:34]));
            4'd3:    b = {1'b0, ny[16:0]};
            4'd4:    b = {1'b0, ny[33:17]};
            default: b = 18'($signed(ny[45:34]));
        endcase
        c = count == 4'd2 || count == 4'd5 ? '0 : p >>> 17;
    end

    logic signed [55:0] by_16;
    logic signed [43:0] by_4;

    assign product  = {p[35:0], middle, low};
    assign twice_gy = 41'(by_4 >>> lead[1:0]);

    always_ff @(posedge clk) begin
        // The sums of the three parts are valid in successive clocks, so the low bits of the result are in the sums of the last two clocks.
        middle <= p[16:0];
        low    <= middle;
        by_16  <= 56'($signed(product[69:7]) >>> {lead[5:4], 4'b0});
        if (count != 4'd10) by_4     <= 44'(by_16 >>> {lead[3:2], 2'b0});
        if (count == 4'd7)  twice_gx <= twice_gy;
    end

    multiply_add #(.BITS(44)) dsp (.clk, .enable(1'b1), .a, .b, .c, .p);

    wire _unused = &{1'b0, p[43:36], product[6:0]};
endmodule

`default_nettype wire

// Computes the accumulator of a plane (the depth, or one channel of light) at the start pixel: value·2^8 + floor((Gx·px +
// Gy·py)/2^8) modulo 2^32. `value` is the plane's value at vertex 0, Gx and Gy are its gradients, and (px, py) is the start
// relative to vertex 0.
//
// Each gradient needs three products, for which it is split into parts of 17, 17 and 6 bits from the low end; bits 8 to 39 of the products'
// sum are exact. The module `setup` drives `count`, the number of the clock in a beat (the time of a triangle in a stage of `setup`, 11
// clocks or more), and `next_is_odd`, the lowest bit of `count` in the next clock. The inputs must hold during a beat, px and py also in
// the previous clock; the result is valid from clock 9 on.

`default_nettype none

module setup_start (
    input  wire         clk,
    input  wire         next_is_odd,
    input  wire  [3:0]  count,
    input  wire  [39:0] gx,
    input  wire  [39:0] gy,
    input  wire  [20:0] px,
    input  wire  [20:0] py,
    input  wire  [23:0] value,
    output logic [31:0] start
);
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [43:0] c, p;
    logic        [39:0] gradient;
    logic        [8:0]  low;
    logic        [16:0] middle, high;

    // The factors follow from count = 2·piece + term, where `term` is 0 for Gx and 1 for Gy. The addend `c` is selected two clocks after
    // the factors of its product.
    always_comb begin
        gradient = count[0] ? gy : gx;
        unique case (count[2:1])
            2'd0:    b = {1'b0, gradient[16:0]};
            2'd1:    b = {1'b0, gradient[33:17]};
            default: b = {12'b0, gradient[39:34]};
        endcase
        c = count[0] ? p : count == 4'd2 ? {4'b0, value, 16'b0} : p >>> 17;
    end

    always_ff @(posedge clk) begin
        // This factor is selected one clock ahead, so that the register at the multiplier has no multiplexer before it.
        a <= 25'($signed(next_is_odd ? py : px));

        // The sums are valid in clocks 4, 6 and 8. The last sum holds afterwards, even while clock 10 is repeated.
        if (!count[0] && count != 4'd10) begin
            high   <= p[16:0];
            middle <= high;
            low    <= middle[16:8];
        end
    end

    assign start = {high[5:0], middle, low};

    multiply_add #(.BITS(44)) dsp (.clk, .enable(1'b1), .a, .b, .c, .p);
endmodule

`default_nettype wire

// The depth gradients of the triangle setup: Gx = nearest(Nx·y·2^−(lead + 8)) and Gy alike, modulo 2^40.
//
// Three products each, of 17, 17 and 12 bits of N from the low end; then a shift in two clocks. Driven by the `count` of the
// setup's beat: inputs hold during a beat, Gx is there from clock 8 and Gy in clock 10.

`default_nettype none

module setup_gradient (
    input  wire         clk,
    input  wire         enable,
    input  wire  [3:0]  count,
    input  wire  [45:0] nx,
    input  wire  [45:0] ny,
    input  wire  [23:0] y,
    input  wire  [5:0]  lead,
    output logic [39:0] gx,
    output logic [39:0] gy
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

    // The bit below the result is kept for the rounding: nearest adds it.
    logic signed [47:0] coarse;
    logic        [40:0] fine;
    logic        [39:0] nearest;

    assign product = {p[35:0], middle, low};
    assign nearest = fine[40:1] + 40'(fine[0]);

    always_ff @(posedge clk) begin
        if (enable) begin
            if (count == 4'd3 || count == 4'd6) low    <= p[16:0];
            if (count == 4'd4 || count == 4'd7) middle <= p[16:0];
            coarse <= 48'($signed(product[69:7]) >>> {lead[5:3], 3'b0});
            fine   <= 41'(coarse >>> lead[2:0]);
            if (count == 4'd7) gx <= nearest;
        end
    end

    assign gy = nearest;

    multiply_add #(.BITS(44)) dsp (.clk, .enable, .a, .b, .c, .p);

    wire _unused = &{1'b0, p[43:36], product[6:0]};
endmodule

`default_nettype wire

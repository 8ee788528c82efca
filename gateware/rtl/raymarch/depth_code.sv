// Converts a depth to a depth code: K/depth, rounded to nearest and clamped to the range from 1 to
// 2^18 - 1 (docs/formats/raymarch.md, "Ends").
//
//   depth ─▶ normalise ─▶ m ─▶ seed ─▶ two Newton steps, four products ─▶ 1/m ─▶ times K, shift, round ─▶ code
//
// The depth is a u19.21 other than 0; K = mantissa·2^exponent. Latency 23 clocks, throughput one depth per clock. The reciprocal is
// computed as in the module `reciprocal`, but with a separate multiplier for each product.

`default_nettype none

module depth_code (
    input  wire               clk,
    input  wire  [16:0]       mantissa,
    input  wire  signed [5:0] exponent,
    input  wire  [39:0]       depth,
    output logic [17:0]       code
);
    // Seed i of the Newton steps is nearest(2^10/(1 + (i + 1/2)/256)), which is nearest(2^19/(513 + 2·i)).
    (* ram_style = "block" *)
    logic [9:0] seeds [0:255];

    initial begin
        for (int i = 0; i < 256; i++) seeds[i] = 10'(((1 << 20) + 513 + 2 * i) / (2 * (513 + 2 * i)));
    end

    // The suffix of a name is the signal's clock: 3 for the mantissa m of the depth, 4 for its seed y0. Later clocks only use ~m.
    logic [23:0] m_3, not_m_4, not_m_10;
    logic [5:0]  lead_3;
    logic [9:0]  y0_4, y0_6, y0_7, y0_9;

    normalise leading (.clk, .in(depth), .m(m_3), .lead(lead_3));

    always_ff @(posedge clk) begin
        not_m_4 <= ~m_3;
        y0_4    <= seeds[m_3[22:15]];
    end

    delay #(.WIDTH(24), .CLOCKS(6)) m_waits (.clk, .enable(1'b1), .in(not_m_4), .out(not_m_10));
    delay #(.WIDTH(10), .CLOCKS(2)) y0_for_sum (.clk, .enable(1'b1), .in(y0_4), .out(y0_6));
    delay #(.WIDTH(10), .CLOCKS(1)) y0_for_step (.clk, .enable(1'b1), .in(y0_6), .out(y0_7));
    delay #(.WIDTH(10), .CLOCKS(2)) y0_for_y1 (.clk, .enable(1'b1), .in(y0_7), .out(y0_9));

    // The suffix of a name is the signal's clock: 7 for e0 = -m·y0, computed as ~m·y0 + y0; 10 for y1 = y0 + y0·e0; 13 for e1 = -m·y1; 16
    // for y1·e1; 17 for the reciprocal y.
    logic signed [36:0] e0_7, sum_10, e1_13, step_16;
    logic [16:0]        y1_10, y1_12, y1_13, y1_16;
    logic [24:0]        sum;
    logic [23:0]        y_17;

    multiply_add #(.BITS(37)) residue_0 (.clk, .enable(1'b1), .a({1'b1, not_m_4}), .b({8'b0, y0_4}), .c({27'b0, y0_6}), .p(e0_7));
    multiply_add #(.BITS(37)) newton_0 (
        .clk, .enable(1'b1), .a(25'($signed(e0_7[25:8]))), .b({8'b0, y0_7}), .c({2'b0, y0_9, 25'b0}), .p(sum_10)
    );
    assign y1_10 = sum_10[35] ? '1 : sum_10[34:18];
    multiply_add #(.BITS(37)) residue_1 (.clk, .enable(1'b1), .a({1'b1, not_m_10}), .b({1'b0, y1_10}), .c({20'b0, y1_12}), .p(e1_13));
    multiply_add #(.BITS(37)) newton_1 (
        .clk, .enable(1'b1), .a(25'($signed(e1_13[25:8]))), .b({1'b0, y1_13}), .c(37'd1 << 24), .p(step_16)
    );

    delay #(.WIDTH(17), .CLOCKS(2)) y1_for_sum (.clk, .enable(1'b1), .in(y1_10), .out(y1_12));
    delay #(.WIDTH(17), .CLOCKS(1)) y1_for_step (.clk, .enable(1'b1), .in(y1_12), .out(y1_13));
    delay #(.WIDTH(17), .CLOCKS(3)) y1_for_y (.clk, .enable(1'b1), .in(y1_13), .out(y1_16));

    assign sum = {1'b0, y1_16, 7'b0} + 25'($signed(step_16[36:25]));

    // In clock 20 the product mantissa·y is valid. The code is this product divided by 2^(22 + shift). With a negative shift the quotient
    // would exceed the largest code, so the code is saturated.
    logic signed [42:0] product_20;
    logic [5:0]         lead_19;
    logic signed [7:0]  shift_20;
    logic [19:0]        by_eights, shifted;
    logic [2:0]         ones;
    logic               saturates_21, saturates_22;
    logic [19:0]        rounded;

    delay #(.WIDTH(6), .CLOCKS(16)) lead_waits (.clk, .enable(1'b1), .in(lead_3), .out(lead_19));
    multiply_add #(.BITS(43)) scaled (.clk, .enable(1'b1), .a({1'b0, y_17}), .b({1'b0, mantissa}), .c('0), .p(product_20));

    assign rounded = 20'(shifted[19:1]) + 20'(shifted[0]);

    always_ff @(posedge clk) begin
        y_17     <= sum[24] ? '1 : sum[23:0];
        shift_20 <= 8'(lead_19) - 8'sd19 - 8'(exponent);

        unique case (shift_20[4:3])
            2'd0: by_eights <= product_20[40:21];
            2'd1: by_eights <= product_20[40:21] >> 8;
            2'd2: by_eights <= product_20[40:21] >> 16;
            2'd3: by_eights <= '0;
        endcase
        if (shift_20[5]) by_eights <= '0;
        ones         <= shift_20[2:0];
        saturates_21 <= shift_20[7];

        shifted      <= by_eights >> ones;
        saturates_22 <= saturates_21;

        code <= saturates_22 || rounded[19:18] != '0 ? '1 : rounded[17:0] == '0 ? 18'd1 : rounded[17:0];
    end

    wire _unused = &{1'b0, e0_7[36:26], e0_7[7:0], sum_10[36], sum_10[17:0], e1_13[36:26], e1_13[7:0], step_16[24:0],
                     product_20[42:41], product_20[20:0], shift_20[6]};
endmodule

`default_nettype wire

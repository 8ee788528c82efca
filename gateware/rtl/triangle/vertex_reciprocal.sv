// Step 5 of the vertex stage: computes y = recip(m), about 2^47/m, or in orthographic projection 2^24 − m. Throughput one result per 6
// clocks. Up to three vertices share one multiplier. docs/formats/triangle.md, "The reciprocal", defines y0, y1, e0' and e1'.
//
// Clock numbers count from the vertex's entry into `vertex_stage`; products follow three clocks after their factors.
//
//   9    m arrives               11, 14    −m·y0 and y0·e0'
//   25   y is valid, until 30    18, 21    −m·y1 and y1·e1'

`default_nettype none

module vertex_reciprocal (
    input  wire         clk,
    input  wire         half,
    input  wire  [1:0]  element,
    input  wire         orthographic,
    input  wire  [23:0] m,
    output logic [23:0] y
);
    // Seed i of the Newton steps is nearest(2^10/(1 + (i + 1/2)/256)), which is nearest(2^19/(513 + 2·i)).
    logic [9:0] seeds [0:255];

    initial begin
        for (int i = 0; i < 256; i++) seeds[i] = 10'(((1 << 20) + 513 + 2 * i) / (2 * (513 + 2 * i)));
    end

    // −m is valid from clock 10 on, `minus_m_later` from 16 on and `minus_m_last` from 22 on; y0 from 11 on; y1 from 18 on and
    // `y1_later` from 24 on. The seed comes from a block RAM, whose output is late in the clock, so it is registered as y0.
    logic signed [24:0] minus_m, minus_m_later;
    logic        [23:0] minus_m_last;
    logic        [9:0]  seed, y0;
    logic        [16:0] y1, y1_later;
    logic signed [24:0] a;
    logic signed [17:0] b, e;
    logic signed [36:0] c, p;
    logic        [24:0] sum;

    // The residues are e0 = 2^33 − m·y0 and e1 = 2^40 − m·y1. Only their bits 8 to 25 are used, in which 2^33 and 2^40 are 0, so the
    // products −m·y0 and −m·y1 suffice.
    assign e = p[25:8];

    logic unused;
    assign unused = &p[7:0];

    always_comb begin
        case ({half, element[0]})
            2'b11: a = minus_m;
            2'b01: a = {15'b0, y0};
            2'b10: a = minus_m_later;
            2'b00: a = {8'b0, y1};
        endcase
        b = e;
        if (half) b = element[0] ? {8'b0, y0} : {1'b0, y1};
        case ({half, element})
            3'b100:  c = {2'b0, y0, 25'b0};
            3'b101:  c = 37'd1 << 24;
            default: c = '0;
        endcase
    end

    multiply_add #(.BITS(37)) multiply (.clk(clk), .enable(1'b1), .a(a), .b(b), .c(c), .p(p));

    assign sum = {1'b0, y1_later, 7'b0} + 25'($signed(p[36:25]));

    always_ff @(posedge clk) begin
        if (!half && element == 2'd2) begin
            minus_m       <= -{1'b0, m};
            minus_m_later <= minus_m;
            minus_m_last  <= minus_m_later[23:0];
            seed          <= seeds[m[22:15]];
        end
        y0 <= seed;
        if (half && element == 2'd1) begin
            y1       <= p[35] ? '1 : p[34:18];
            y1_later <= y1;
        end
        if (half && element == 2'd2) y <= orthographic ? minus_m_last : sum[24] ? '1 : sum[23:0];
    end
endmodule

`default_nettype wire

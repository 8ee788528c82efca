// Computes the reciprocal y = 2^47/m of a mantissa m in [2^23, 2^24), from a table and two Newton steps
// (docs/formats/triangle.md, "The reciprocal").
//
// The result `out_y` appears 15 clocks after m, with `out_valid` high for one clock, and holds until the next result. The pipeline never
// stalls. Throughput: `in_ready` admits one m per 10 clocks. One DSP48 computes the four products:
//
//   clock  0      1       2        5             8           11            14         15
//          m ─▶ seed ─▶ y0 ─▶ e0 = −m·y0 ─▶ y1 = y0 + y0·e0 ─▶ e1 = −m·y1 ─▶ y1·e1 ─▶ y = y1 + y1·e1
//
// −m·y is computed as ~m·y + y, so that there is no adder before the multiplier. The residues are e0 = 2^33 − m·y0 and
// e1 = 2^40 − m·y1; only bits 8 to 25 of the residues are used, in which 2^33 and 2^40 are 0.

`default_nettype none

module reciprocal (
    input  wire         clk,
    input  wire         rst,
    input  wire         in_valid,
    output logic        in_ready,
    input  wire  [23:0] in_m,
    output logic        out_valid,
    output logic [23:0] out_y
);
    // Seed i of the Newton steps is nearest(2^10/(1 + (i + 1/2)/256)), which is nearest(2^19/(513 + 2·i)).
    logic [9:0] seeds [256];

    initial begin
        for (int i = 0; i < 256; i++) seeds[i] = 10'(((1 << 20) + 513 + 2 * i) / (2 * (513 + 2 * i)));
    end

    // Bit k of `since` is high when a mantissa m entered k + 1 clocks ago. The seed comes from a block RAM, whose output is late in the
    // clock, so it is registered as y0.
    logic [14:0] since;
    logic [23:0] m;
    logic [9:0]  seed, y0;
    logic [16:0] y1, y1_held;

    logic signed [24:0] a;
    logic signed [17:0] b, e;
    logic signed [36:0] c, p;
    logic        [24:0] sum;

    logic unused;
    assign unused = &p[7:0];

    assign in_ready  = since[8:0] == '0;
    assign out_valid = since[14];
    assign e         = p[25:8];
    assign y1        = p[35] ? '1 : p[34:18];
    assign sum       = {1'b0, y1_held, 7'b0} + 25'($signed(p[36:25]));

    always_comb begin
        a = since[1] || since[7] ? {1'b1, ~m} : 25'(e);
        b = since[1] || since[4] ? {8'b0, y0} : {1'b0, since[7] ? y1 : y1_held};
        c = since[3] ? {27'b0, y0}
          : since[6] ? {2'b0, y0, 25'b0}
          : since[9] ? {20'b0, y1_held}
          : 37'd1 << 24;
    end

    always_ff @(posedge clk) begin
        since <= {since[13:0], in_valid && in_ready};
        if (in_ready) begin
            m    <= in_m;
            seed <= seeds[in_m[22:15]];
        end
        y0 <= seed;
        if (since[7])  y1_held <= y1;
        if (since[13]) out_y   <= sum[24] ? '1 : sum[23:0];
        if (rst) since <= '0;
    end

    multiply_add #(.BITS(37)) dsp (.clk, .enable(1'b1), .a, .b, .c, .p);
endmodule

`default_nettype wire

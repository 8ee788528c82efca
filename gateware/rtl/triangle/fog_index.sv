// Computes the index in the table of fog shares from a depth code: 128·log2(code) − offset, limited to the table
// (docs/formats/triangle.md, "Fog").
//
//   code ─▶ shift by 16 or 8 ─▶ by 4 ─▶ by 2 and 1 ─▶ exponent, mantissa − offset ─▶ + correction ─▶ limit ─▶ index
//
// The leading bit of the code is the exponent, and the seven bits below it are the mantissa, to which a table adds the difference between a
// logarithm and a straight line. Without `enable` the index is the last one, whose share is 0. Latency 5 clocks, throughput one code per
// clock.

`default_nettype none

module fog_index (
    input  wire         clk,
    input  wire         enable,
    input  wire  [12:0] offset, // s13
    input  wire  [17:0] code,   // above 0
    output logic [10:0] index
);
    // Entry m is nearest(128·log2(1 + (m + 1/2)/128)) − m.
    logic [3:0] corrections [0:127];

    initial begin
        for (int m = 0; m < 128; m++)
            corrections[m] = 4'($rtoi($ln(1.0 + ($itor(m) + 0.5) / 128.0) * 128.0 / $ln(2.0) + 0.5) - m);
    end

    // The code shifted left, and the number of positions; the suffix is the clock.
    logic [17:3]        code_1;
    logic [17:7]        code_2;
    logic [6:0]         mantissa_3;
    logic [1:0]         left;
    logic [2:1]         eights_1, eights_2;
    logic               fours_2;
    logic [4:0]         exponent_3;
    logic [3:0]         more_4;
    logic signed [13:0] base_4, sum;

    always_comb begin
        left = code_2[17] ? 2'd0 : code_2[16] ? 2'd1 : code_2[15] ? 2'd2 : 2'd3;
        sum  = base_4 + 14'(more_4);
    end

    always_ff @(posedge clk) begin
        if (code[17:10] != '0)     {eights_1, code_1} <= {2'd0, code[17:3]};
        else if (code[9:2] != '0)  {eights_1, code_1} <= {2'd1, code[9:0], 5'd0};
        else                       {eights_1, code_1} <= {2'd2, code[1:0], 13'd0};

        eights_2 <= eights_1;
        fours_2  <= code_1[17:14] == '0;
        code_2   <= code_1[17:14] == '0 ? code_1[13:3] : code_1[17:7];

        unique case (left)
            2'd0: mantissa_3 <= code_2[16:10];
            2'd1: mantissa_3 <= code_2[15:9];
            2'd2: mantissa_3 <= code_2[14:8];
            2'd3: mantissa_3 <= code_2[13:7];
        endcase
        exponent_3 <= 5'd17 - {eights_2, fours_2, left};

        base_4 <= $signed({2'b0, exponent_3, mantissa_3}) - 14'($signed(offset));
        more_4 <= corrections[mantissa_3];

        index  <= !enable || !sum[13] && sum[12:11] != '0 ? '1 : sum[13] ? '0 : sum[10:0];
    end
endmodule

`default_nettype wire

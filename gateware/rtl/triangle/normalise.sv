// Normalises an unsigned 40-bit number that is not 0: `in` is about m·2^(lead − 23), where lead = floor(log2 in), and m = floor(in·2^(23 −
// lead)) is in [2^23, 2^24).
//
// Latency 3 clocks for m and lead, throughput one number per clock. The shift has three parts: by multiples of 16, of 4 and of 1.

`default_nettype none

module normalise (
    input  wire         clk,
    input  wire  [39:0] in,
    output logic [23:0] m,
    output logic [5:0]  lead
);
    logic [39:0] by_16;
    logic [26:0] by_4;
    logic [1:0]  sixteens, fours, ones;
    logic [1:0]  sixteens_1, sixteens_2, fours_2;

    always_comb begin
        sixteens = in[39:24] != '0 ? 2'd0 : in[23:8] != '0 ? 2'd1 : 2'd2;
        fours    = by_16[39:36] != '0 ? 2'd0 : by_16[35:32] != '0 ? 2'd1 : by_16[31:28] != '0 ? 2'd2 : 2'd3;
        ones     = by_4[26] ? 2'd0 : by_4[25] ? 2'd1 : by_4[24] ? 2'd2 : 2'd3;
    end

    always_ff @(posedge clk) begin
        unique case (sixteens)
            2'd0:    by_16 <= in;
            2'd1:    by_16 <= {in[23:0], 16'b0};
            default: by_16 <= {in[7:0], 32'b0};
        endcase
        sixteens_1 <= sixteens;
        unique case (fours)
            2'd0:    by_4 <= by_16[39:13];
            2'd1:    by_4 <= by_16[35:9];
            2'd2:    by_4 <= by_16[31:5];
            default: by_4 <= by_16[27:1];
        endcase
        sixteens_2 <= sixteens_1;
        fours_2    <= fours;
        unique case (ones)
            2'd0:    m <= by_4[26:3];
            2'd1:    m <= by_4[25:2];
            2'd2:    m <= by_4[24:1];
            default: m <= by_4[23:0];
        endcase
        lead <= 6'd39 - {sixteens_2, fours_2, ones};
    end

    wire _unused = by_16[0];
endmodule

`default_nettype wire

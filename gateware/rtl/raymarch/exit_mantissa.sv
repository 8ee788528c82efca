// Computes the reciprocal of a number, as a mantissa and an exponent of 2 (docs/raymarch-exits.md, "Formats").
//
//   whole ─▶ shift until its first bit is 1 ─▶ table of 2^10 entries ─▶ interpolation ─▶ mantissa from 3/4 to below 3/2, exponent
//
// `whole` is u0.28, at least 2^-28. A caller with a magnitude of 27 bits appends a 1 bit, because the magnitude stands for the middle of an
// interval. The 25 bits from the highest 1 of `whole` on are used. The mantissa has 22 fraction bits, rounded to nearest. An entry of the
// table contains the value at the end of its interval and the decrease over the interval. Values are reduced by half of the largest
// interpolation error, so that errors have both signs. Latency 10 clocks with `enable`, throughput one per clock, no handshake.

`default_nettype none

module exit_mantissa (
    input  wire         clk,
    input  wire         enable,
    input  wire  [27:0] whole,
    output logic [22:0] mantissa,
    output logic [4:0]  exponent
);
    // The suffix of a name is the number of clocks after the input. The shift is done in steps of 8 (`eights`), of 2 (`twos`) and of 1
    // bit; the numbers of these steps side by side are the bits of the total shift, `lead`.
    logic [27:0] whole_1, whole_2;
    logic [24:0] whole_3;
    logic [1:0]  eights_0, twos_1;
    logic [4:0]  lead_3, lead_9;
    logic [1:0]  eights_1;
    logic [3:0]  lead_2;

    always_comb begin
        if (whole[27:20] != '0)      eights_0 = 2'd0;
        else if (whole[19:12] != '0) eights_0 = 2'd1;
        else                         eights_0 = {1'b1, whole[11:4] == '0};
        if (whole_1[27:26] != '0)      twos_1 = 2'd0;
        else if (whole_1[25:24] != '0) twos_1 = 2'd1;
        else                           twos_1 = {1'b1, whole_1[23:22] == '0};
    end

    always_ff @(posedge clk) if (enable) begin
        whole_1  <= whole << {eights_0, 3'd0};
        eights_1 <= eights_0;
        whole_2  <= whole_1 << {twos_1, 1'b0};
        lead_2   <= {eights_1, twos_1};
        whole_3  <= whole_2[27] ? whole_2[27:3] : whole_2[26:2];
        lead_3   <= {lead_2, !whole_2[27]};
    end

    // The value at the end of interval i is 2^34/(1025 + i), with 24 bits. Its highest bit is always 1, and its second bit is 1 for i up to
    // 340. Both are therefore not stored, so that an entry fits the width of the block RAM.
    localparam int unsigned LAST_HIGH = 340;

    (* ram_style = "block" *) logic [35:0] entries [0:1023];

    for (genvar i = 0; i < 1024; i++) begin : rows
        // 2^34 divided by the ends of the interval, rounded to nearest. Yosys computes a parameter in a tenth of the time of a function.
        localparam bit [24:0] FROM = 25'((64'd17179869184 + 64'((1024 + i) / 2)) / 64'(1024 + i));
        localparam bit [24:0] TO   = 25'((64'd17179869184 + 64'((1025 + i) / 2)) / 64'(1025 + i));
        // Half of the largest interpolation error in the interval: 2/(1 + i/2^10)^3 units of the table, rounded to nearest.
        localparam bit [24:0] EXCESS = i <= 103 ? 25'd2 : 25'(i <= 601);

        initial entries[i] = {22'(TO - EXCESS), 14'(FROM - TO)};
    end

    // A second port reads the value two clocks later, when the sum needs it.
    logic [35:0] fall_4, fall_5, start_6, start_7;
    logic [9:0]  index_4, index_5;
    logic        high_6, high_7;
    logic [14:0] left_4, left_5;

    always_ff @(posedge clk) if (enable) begin
        fall_4  <= entries[whole_3[23:14]];
        fall_5  <= fall_4;
        // The distance from the input to the end of the interval.
        left_4  <= 15'd16384 - {1'b0, whole_3[13:0]};
        left_5  <= left_4;

        index_4 <= whole_3[23:14];
        index_5 <= index_4;
        start_6 <= entries[index_5];
        high_6  <= index_5 <= 10'(LAST_HIGH);
        start_7 <= start_6;
        high_7  <= high_6;
    end

    // The sum is rounded up: the decrease up to the number is rounded down.
    logic signed [39:0] sum_8;
    logic [24:0]        value_8;
    logic [24:0]        half_9;
    logic               low_8, low_9;

    multiply_add #(.BITS(40)) interpolation (
        .clk, .enable, .a({11'd0, fall_5[13:0]}), .b({3'd0, left_5}), .c({3'd1, high_7, start_7[35:14], 14'h3FFF}), .p(sum_8)
    );
    assign value_8 = sum_8[38:14];
    assign low_8   = !value_8[24] && value_8[23:22] != 2'b11;

    delay #(.WIDTH(5), .CLOCKS(6)) lead_waits (.clk, .enable, .in(lead_3), .out(lead_9));

    // A value below 3/4 is doubled, and the exponent changes by 1.
    always_ff @(posedge clk) if (enable) begin
        low_9    <= low_8;
        half_9   <= (low_8 ? value_8 : {1'b0, value_8[24:1]}) + 25'd1;
        mantissa <= half_9[23] && half_9[22] ? 23'h5FFFFF : half_9[23:1];
        exponent <= lead_9 + 5'(!low_9);
    end

    wire _unused = &{1'b0, sum_8[39], sum_8[13:0], half_9[24], half_9[0], whole_3[24], fall_5[35:14], start_7[13:0], whole_2[1:0]};
endmodule

`default_nettype wire

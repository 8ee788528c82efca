// Computes the reciprocal of the magnitude of a direction's component (docs/raymarch-exits.md, "Formats").
//
//   magnitude ─▶ shift until its first bit is 1 ─▶ table of 2^10 entries ─▶ interpolation ─▶ mantissa from 3/4 to 3/2
//   ─▶ shift by the exponent modulo 8 ─▶ {scale, factor}
//
// `magnitude` is u0.24 and stands for the middle of its interval, so it is never 0. Rounded to nearest. An entry of the table has the
// value at the end of its interval and the decrease over the interval. Latency 12 clocks, throughput one per clock, no handshake.

`default_nettype none

module exit_reciprocal (
    input  wire                                clk,
    input  wire  [23:0]                        magnitude,
    output logic [exit_pkg::INVERSE_BITS-1:0]  inverse
);
    // The suffix of a name is the number of clocks after the magnitude.
    logic [24:0] whole_0, whole_1, whole_2, whole_3;
    logic [4:0]  lead_1, lead_2, lead_3, lead_9;

    assign whole_0 = {magnitude, 1'b1};

    always_ff @(posedge clk) begin
        if (whole_0[24:17] != '0)     {lead_1, whole_1} <= {5'd0, whole_0};
        else if (whole_0[16:9] != '0) {lead_1, whole_1} <= {5'd8, whole_0[16:0], 8'd0};
        else if (whole_0[8:1] != '0)  {lead_1, whole_1} <= {5'd16, whole_0[8:0], 16'd0};
        else                          {lead_1, whole_1} <= {5'd24, 1'b1, 24'd0};

        if (whole_1[24:23] != '0)      {lead_2, whole_2} <= {lead_1, whole_1};
        else if (whole_1[22:21] != '0) {lead_2, whole_2} <= {lead_1 + 5'd2, whole_1[22:0], 2'd0};
        else if (whole_1[20:19] != '0) {lead_2, whole_2} <= {lead_1 + 5'd4, whole_1[20:0], 4'd0};
        else                           {lead_2, whole_2} <= {lead_1 + 5'd6, whole_1[18:0], 6'd0};

        {lead_3, whole_3} <= whole_2[24] ? {lead_2, whole_2} : {lead_2 + 5'd1, whole_2[23:0], 1'b0};
    end

    // The value at the end of interval i is 2^34/(1025 + i), with 24 bits. Its first bit is 1; its second bit, 1 up to i = 340, follows from
    // the index, so that an entry has the width of the block RAM.
    localparam int unsigned LAST_HIGH = 340;

    (* ram_style = "block" *) logic [35:0] entries [0:1023];

    // Returns 2^34 / divisor, rounded to nearest.
    function automatic logic [24:0] quotient(input int unsigned divisor);
        quotient = 25'((64'd17179869184 + 64'(divisor / 2)) / 64'(divisor));
    endfunction

    initial
        for (int i = 0; i < 1024; i++)
            entries[i] = {22'(quotient(1025 + i)), 14'(quotient(1024 + i) - quotient(1025 + i))};

    logic [35:0] entry_4, entry_5;
    logic        high_4, high_5;
    logic [14:0] left_4, left_5;
    logic [23:0] value_7;

    always_ff @(posedge clk) begin
        entry_4 <= entries[whole_3[23:14]];
        high_4  <= whole_3[23:14] <= 10'(LAST_HIGH);
        // The part of the interval after the number.
        left_4  <= 15'd16384 - {1'b0, whole_3[13:0]};
        entry_5 <= entry_4;
        high_5  <= high_4;
        left_5  <= left_4;
    end

    // The sum is rounded up: the decrease up to the number is rounded down.
    logic signed [39:0] sum_8;
    logic [24:0]        value_8;
    logic [24:0]        half_9;
    logic               low_8, low_9;

    delay #(.WIDTH(24), .CLOCKS(2)) value_waits (.clk, .enable(1'b1), .in({1'b1, high_5, entry_5[35:14]}), .out(value_7));
    multiply_add #(.BITS(40)) interpolation (
        .clk, .enable(1'b1), .a({11'd0, entry_5[13:0]}), .b({3'd0, left_5}), .c({2'd0, value_7, 14'h3FFF}), .p(sum_8)
    );
    assign value_8 = sum_8[38:14];
    assign low_8   = !value_8[24] && value_8[23:22] != 2'b11;

    delay #(.WIDTH(5), .CLOCKS(6)) lead_waits (.clk, .enable(1'b1), .in(lead_3), .out(lead_9));

    // A value below 3/4 is doubled. The mantissa has 22 fraction bits and is below 3/2.
    logic [22:0] mantissa_10;
    logic [4:0]  exponent_10;
    logic [28:0] coarse_11;
    logic [1:0]  scale_11;
    logic        odd_11;

    always_ff @(posedge clk) begin
        low_9       <= low_8;
        half_9      <= (low_8 ? value_8 : {1'b0, value_8[24:1]}) + 25'd1;
        mantissa_10 <= half_9[23] && half_9[22] ? 23'h5FFFFF : half_9[23:1];
        exponent_10 <= lead_9 + 5'(!low_9);

        coarse_11          <= {6'd0, mantissa_10} << {exponent_10[2:1], 1'b0};
        {scale_11, odd_11} <= {exponent_10[4:3], exponent_10[0]};
        inverse            <= {scale_11, odd_11 ? {coarse_11, 1'b0} : {1'b0, coarse_11}};
    end

    wire _unused = &{1'b0, sum_8[39], sum_8[13:0], half_9[24], half_9[0], whole_3[24]};
endmodule

`default_nettype wire

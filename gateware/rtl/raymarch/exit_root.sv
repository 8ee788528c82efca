// Computes a lower bound of the square root of a number, with a relative error of at most 2^-18 (docs/raymarch-exits.md).
//
//   square ─▶ shift by an even number of bits until one of the two highest is 1 ─▶ root_table, interpolated ─▶ shift back ─▶ root
//
// `square` is an integer; 0 is replaced by 1. `root` is the square root of square·2^14, rounded down. Latency 9 clocks, throughput
// one per clock, no handshake.

`default_nettype none

module exit_root (
    input  wire         clk,
    input  wire  [31:0] square,
    output logic [22:0] root
);
    // The suffix of a name is the number of clocks after the square. The shift is done in two steps: by four pairs of bits at a time,
    // then by single pairs.
    logic [31:0] coarse_1;
    logic [25:0] fine_2;
    logic [1:0]  eights_0, eights_1, twos_1, ones_8;
    logic [3:0]  places_2, places_7;

    assign eights_0 = square[31:24] != '0 ? 2'd0 : square[23:16] != '0 ? 2'd1 : square[15:8] != '0 ? 2'd2 : 2'd3;
    assign twos_1   = coarse_1[31:30] != '0 ? 2'd0 : coarse_1[29:28] != '0 ? 2'd1 : coarse_1[27:26] != '0 ? 2'd2 : 2'd3;

    always_ff @(posedge clk) begin
        eights_1 <= eights_0;
        coarse_1 <= square << {eights_0, 3'd0};
        places_2 <= {eights_1, twos_1};
        unique case (twos_1)
            2'd0: fine_2 <= coarse_1[31:6];
            2'd1: fine_2 <= coarse_1[29:4];
            2'd2: fine_2 <= coarse_1[27:2];
            2'd3: fine_2 <= coarse_1[25:0];
        endcase
    end
    delay #(.WIDTH(4), .CLOCKS(5)) places_wait (.clk, .enable(1'b1), .in(places_2), .out(places_7));

    // A linear interpolation between two entries of the table, shifted back.
    logic [17:0]        base_4, base_6;
    logic [9:0]         slope_4;
    logic [16:0]        rest_4;
    logic signed [36:0] root_7;
    logic [22:0]        root_8;

    root_table roots (.clk, .index(fine_2[25:17]), .root(base_4), .slope(slope_4));
    delay #(.WIDTH(17), .CLOCKS(2)) rest_waits (.clk, .enable(1'b1), .in(fine_2[16:0]), .out(rest_4));
    delay #(.WIDTH(18), .CLOCKS(2)) base_waits (.clk, .enable(1'b1), .in(base_4), .out(base_6));
    multiply_add #(.BITS(37)) between (
        .clk, .enable(1'b1), .a({15'b0, slope_4}), .b({1'b0, rest_4}), .c({1'b0, 1'b1, base_6, 17'b0}), .p(root_7)
    );

    always_ff @(posedge clk) begin
        root_8 <= {root_7[35:17], 4'd0} >> {places_7[3:2], 2'd0};
        ones_8 <= places_7[1:0];
        root   <= root_8 >> ones_8;
    end

    wire _unused = &{1'b0, root_7[36], root_7[16:0]};
endmodule

`default_nettype wire

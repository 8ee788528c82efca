// Computes the parameter T at which a ray has covered a distance along an axis: the distance divided by the magnitude of the direction's
// component (docs/raymarch-exits.md, "Formats").
//
//   distance, rest ─▶ distance + distance·rest ─▶ shift by the exponent in three clocks ─▶ saturate ─▶ T
//
// `distance` is u12.12 with a 0 before it, at least 0. T is rounded down. Saturates.
// Latency 7 clocks, throughput one per clock, no handshake.

`default_nettype none

module exit_quotient (
    input  wire                                clk,
    input  wire  [exit_pkg::CORNER_BITS-1:0]   distance,
    input  wire  [exit_pkg::INVERSE_BITS-1:0]  inverse,
    output logic [exit_pkg::T_BITS-1:0]        t
);
    localparam int unsigned PRODUCT_BITS = 48;
    // `rest` is split into a signed part and its low bits.
    localparam int unsigned LOW_BITS     = 5;

    logic [exit_pkg::CORNER_BITS-1:0]               distance_1, distance_2;
    logic signed [exit_pkg::REST_BITS-LOW_BITS-1:0] high_1;
    logic signed [PRODUCT_BITS-1:0]                 low_3;
    logic signed [PRODUCT_BITS-LOW_BITS-1:0]        high_4;
    logic [LOW_BITS-1:0]                            low_4;
    logic [PRODUCT_BITS-1:0]                        product_4;
    logic [4:0]                                     exponent_4;
    logic [2:0]                                     exponent_5;
    logic                                           exponent_6;

    always_ff @(posedge clk) begin
        distance_1 <= distance;
        distance_2 <= distance_1;
        high_1     <= inverse[exit_pkg::REST_BITS-1:LOW_BITS];
        low_4      <= low_3[LOW_BITS-1:0];
    end

    multiply_add #(.BITS(PRODUCT_BITS)) low_part (
        .clk, .enable(1'b1), .a(distance), .b({13'd0, inverse[LOW_BITS-1:0]}), .c({1'b0, distance_2, 22'd0}), .p(low_3)
    );
    multiply_add #(.BITS(PRODUCT_BITS - LOW_BITS)) high_part (
        .clk, .enable(1'b1), .a(distance_1), .b(18'(high_1)), .c(low_3[PRODUCT_BITS-1:LOW_BITS]), .p(high_4)
    );
    delay #(.WIDTH(5), .CLOCKS(4)) exponent_waits (.clk, .enable(1'b1), .in(inverse[exit_pkg::INVERSE_BITS-1:exit_pkg::REST_BITS]), .out(exponent_4));

    assign product_4 = {high_4, low_4};

    // T is the product times 2^exponent, without its 20 lowest bits. The three clocks shift by multiples of 8, of 2, and by one bit.
    logic [PRODUCT_BITS+23:0]  shifted;
    logic [PRODUCT_BITS-1:13]  coarse_5;
    logic [PRODUCT_BITS+5:13]  middle;
    logic [PRODUCT_BITS-1:19]  middle_6;
    logic                      over_5, over_6;

    assign shifted = {24'd0, product_4} << {exponent_4[4:3], 3'd0};
    assign middle  = {6'd0, coarse_5} << {exponent_5[2:1], 1'b0};

    always_ff @(posedge clk) begin
        coarse_5   <= shifted[PRODUCT_BITS-1:13];
        over_5     <= shifted[PRODUCT_BITS+23:PRODUCT_BITS] != '0;
        exponent_5 <= exponent_4[2:0];
        middle_6   <= middle[PRODUCT_BITS-1:19];
        over_6     <= over_5 || middle[PRODUCT_BITS+5:PRODUCT_BITS] != '0;
        exponent_6 <= exponent_5[0];
        t          <= (exponent_6 ? middle_6[PRODUCT_BITS-2:19] : middle_6[PRODUCT_BITS-1:20])
                      | {exit_pkg::T_BITS{over_6 || exponent_6 && middle_6[PRODUCT_BITS-1]}};
    end

    wire _unused = &{1'b0, shifted[12:0], middle[18:13]};
endmodule

`default_nettype wire

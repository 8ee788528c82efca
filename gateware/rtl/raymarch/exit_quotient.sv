// Computes the parameter T at which a ray has covered a distance along an axis: the distance divided by the magnitude of the direction's
// component (docs/raymarch-exits.md, "Formats").
//
//   distance, factor ─▶ distance·factor ─▶ one of three shifts, by the scale ─▶ saturate ─▶ T
//
// `distance` is u12.12 with a 0 before it, at least 0. T is rounded down. Saturates.
// Latency 6 clocks, throughput one per clock, no handshake.

`default_nettype none

module exit_quotient (
    input  wire                                clk,
    input  wire  [exit_pkg::CORNER_BITS-1:0]   distance,
    input  wire  [exit_pkg::INVERSE_BITS-1:0]  inverse,
    output logic [exit_pkg::T_BITS-1:0]        t
);
    localparam int unsigned HALF_BITS    = exit_pkg::FACTOR_BITS / 2;
    localparam int unsigned PRODUCT_BITS = exit_pkg::CORNER_BITS - 1 + exit_pkg::FACTOR_BITS;

    // The suffix of a name is the number of clocks after the distance.
    logic [exit_pkg::CORNER_BITS-1:0] distance_1;
    logic [HALF_BITS-1:0]             high_1;
    logic signed [42:0]               low_3, high_4;
    logic [HALF_BITS-1:0]             low_4;
    logic [PRODUCT_BITS-1:0]          product_5;
    logic [1:0]                       scale_4, scale_5;
    logic                             over_5;

    multiply_add #(.BITS(43)) low_part (
        .clk, .enable(1'b1), .a(distance), .b({1'b0, inverse[HALF_BITS-1:0]}), .c('0), .p(low_3)
    );
    multiply_add #(.BITS(43)) high_part (
        .clk, .enable(1'b1), .a(distance_1), .b({1'b0, high_1}), .c({17'd0, low_3[42:17]}), .p(high_4)
    );
    delay #(.WIDTH(2), .CLOCKS(4)) scale_waits (
        .clk, .enable(1'b1), .in(inverse[exit_pkg::INVERSE_BITS-1:exit_pkg::FACTOR_BITS]), .out(scale_4)
    );

    // T is the product times 2^(12·scale), without its 20 lowest bits.
    always_ff @(posedge clk) begin
        distance_1 <= distance;
        high_1     <= inverse[exit_pkg::FACTOR_BITS-1:HALF_BITS];
        low_4      <= low_3[HALF_BITS-1:0];
        product_5  <= {high_4[PRODUCT_BITS-HALF_BITS-1:0], low_4};
        scale_5    <= scale_4;
        over_5     <= high_4[40:31] != '0 || scale_4 != '0 && high_4[30:19] != '0 || scale_4[1] && high_4[18:7] != '0;

        unique case (scale_5)
            2'd0:    t <= product_5[47:20] | {exit_pkg::T_BITS{over_5}};
            2'd1:    t <= product_5[35:8] | {exit_pkg::T_BITS{over_5}};
            default: t <= {product_5[23:0], 4'd0} | {exit_pkg::T_BITS{over_5}};
        endcase
    end

    wire _unused = &{1'b0, high_4[42:41], product_5[57:48]};
endmodule

`default_nettype wire

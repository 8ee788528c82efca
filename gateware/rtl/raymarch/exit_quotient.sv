// Computes the parameter T at which a ray has covered a distance along an axis: the distance divided by the magnitude of the direction's
// component (docs/raymarch-exits.md, "Formats").
//
//   distance, factor ─▶ distance·factor ─▶ shift by the scale ─▶ T
//
// `distance` is u12.12 with a 0 as its highest bit. T is rounded down. Latency 5 clocks, throughput one per clock, no handshake.

`default_nettype none

module exit_quotient (
    input  wire                                clk,
    input  wire  [exit_pkg::PLANE_BITS-1:0]    distance,
    input  wire  [exit_pkg::INVERSE_BITS-1:0]  inverse,
    output logic [exit_pkg::EXIT_BITS-1:0]     t
);
    // The factor is split into a high part and its low bits.
    localparam int unsigned LOW_BITS     = 17;
    localparam int unsigned HIGH_BITS    = exit_pkg::FACTOR_BITS - LOW_BITS;
    localparam int unsigned PRODUCT_BITS = exit_pkg::PLANE_BITS - 1 + exit_pkg::FACTOR_BITS;

    logic [exit_pkg::PLANE_BITS-1:0] distance_1;
    logic [HIGH_BITS-1:0]            high_1;
    logic signed [42:0]              low_3, high_4;
    logic [LOW_BITS-1:0]             low_4;
    logic [exit_pkg::SCALE_BITS-1:0] scale_4;
    logic [PRODUCT_BITS-1:0]         product_4;

    always_ff @(posedge clk) begin
        distance_1 <= distance;
        high_1     <= inverse[exit_pkg::FACTOR_BITS-1:LOW_BITS];
        low_4      <= low_3[LOW_BITS-1:0];
    end

    multiply_add #(.BITS(43)) low_part (
        .clk, .enable(1'b1), .a(distance), .b({1'b0, inverse[LOW_BITS-1:0]}), .c('0), .p(low_3)
    );
    multiply_add #(.BITS(43)) high_part (
        .clk, .enable(1'b1), .a(distance_1), .b(18'(high_1)), .c(43'(low_3[42:LOW_BITS])), .p(high_4)
    );
    delay #(.WIDTH(exit_pkg::SCALE_BITS), .CLOCKS(4)) scale_waits (
        .clk, .enable(1'b1), .in(inverse[exit_pkg::INVERSE_BITS-1:exit_pkg::FACTOR_BITS]), .out(scale_4)
    );

    assign product_4 = {high_4[PRODUCT_BITS-LOW_BITS-1:0], low_4};

    // T is the product times 2^(8·scale), without its 20 lowest bits.
    always_ff @(posedge clk) begin
        t[exit_pkg::T_BITS] <= product_4[53:48] != '0 || scale_4 != '0 && product_4[47:40] != '0
                               || scale_4[1] && product_4[39:32] != '0 || scale_4 == '1 && product_4[31:24] != '0;
        t[exit_pkg::T_BITS-1:0] <= scale_4 == 2'd3 ? {product_4[23:0], 4'd0}
                                   : scale_4 == 2'd2 ? product_4[31:4]
                                   : scale_4 == 2'd1 ? product_4[39:12] : product_4[47:20];
    end

    wire _unused = &{1'b0, high_4[42:PRODUCT_BITS-LOW_BITS]};
endmodule

`default_nettype wire

// Distance to a Menger sponge of half side 40.5, in the maximum norm, without a multiplier (docs/formats.md, "Fields").
//
//   point ─▶ menger_level 27 ─▶ 9 ─▶ 3 ─▶ 1 ... ─▶ |x| ─▶ largest ─▶ - half ─▶ distance, surface
//
// Latency 3 * LEVELS + 3 clocks, throughput one point a clock, no handshake. `levels` has a bit for each level in use, the
// first level in bit 0; `half` is half the side of the smallest solid cubes. Both must hold.

`default_nettype none

module field_menger #(
    parameter int unsigned LEVELS = 4
) (
    input  wire                clk,
    input  wire  [LEVELS-1:0]  levels,
    input  wire  [21:0]        half,
    input  wire  [2:0][21:0]   point,
    output logic signed [21:0] distance,
    output logic [2:0]         surface
);
    logic [LEVELS:0][2:0][21:0] points;
    logic [LEVELS:0][2:0][2:0]  grows;

    assign points[0] = point;
    assign grows[0]  = {3'd5, 3'd3, 3'd1};

    for (genvar i = 0; i < LEVELS; i++) begin : folds
        // Side of the cubes of each level: 27, 9, 3, 1, 1/3, 1/9, to the nearest even multiple of 2^-12.
        localparam int S = i == 0 ? 27 << 12 : i == 1 ? 9 << 12 : i == 2 ? 3 << 12 : i == 3 ? 1 << 12 : i == 4 ? 1366 : 456;
        menger_level #(.BITS(22), .S(S)) level (
            .clk, .enable(levels[i]), .in(points[i]), .in_grows(grows[i]), .out(points[i+1]), .out_grows(grows[i+1])
        );
    end

    logic [2:0][20:0] size_1, size_2;
    logic [2:0][2:0]  grows_1, grows_2;
    logic             z_over_x, z_over_y, x_over_y, big_is_z, big_is_x;
    logic [20:0]      big;

    assign big_is_z = z_over_x && z_over_y;
    assign big_is_x = !big_is_z && x_over_y;
    assign big      = big_is_z ? size_2[2] : big_is_x ? size_2[0] : size_2[1];

    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++) begin
            size_1[i]  <= points[LEVELS][i][20:0] ^ {21{points[LEVELS][i][21]}};
            grows_1[i] <= grows[LEVELS][i] ^ {2'b0, points[LEVELS][i][21]};
        end
        size_2   <= size_1;
        grows_2  <= grows_1;
        z_over_x <= size_1[2] > size_1[0];
        z_over_y <= size_1[2] > size_1[1];
        x_over_y <= size_1[0] > size_1[1];
        distance <= $signed({1'b0, big}) - $signed(half);
        surface  <= big_is_z ? grows_2[2] : big_is_x ? grows_2[0] : grows_2[1];
    end
endmodule

`default_nettype wire

// Distance to a Menger sponge of half side 40.5, in the maximum norm, without a multiplier (docs/formats.md, "Fields").
//
//             high bits ─▶ menger_level 27 ─▶ 9 ─▶ 3 ─▶ 1 ──────┐
//   point ─┬─▶ order of the low bits ─────────▲                 ├─▶ ... ─▶ |x| ─▶ largest ─▶ - half ─▶ distance, surface
//          └─▶ low bits ─▶ wait ─▶ mirrored, in their places ───┘
//
// The sides of the first four levels are integers. There the low LOW bits of a coordinate are only mirrored and change places,
// so they wait outside of the levels, which need nothing of them but the order of each pair. Further levels get all bits.
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
    // LOW: number of bits that are 0 in half the side of the cubes of each of the first SPLIT levels.
    localparam int unsigned LOW   = 11;
    localparam int unsigned SPLIT = LEVELS < 4 ? LEVELS : 4;
    // Whether the low bits wait until the distance is computed, and the bits of a coordinate's size before that.
    localparam bit          APART     = LEVELS == SPLIT;
    localparam logic [20:0] HIGH_BITS = APART ? '1 << LOW : '1;

    // Coordinates between the levels, without their low bits in the first levels.
    logic [LEVELS:0][2:0][21:0]   points;
    logic [LEVELS-1:0][2:0][21:0] entering;
    logic [LEVELS:0][2:0][2:0]    grows;
    logic [LEVELS:0][raymarch_pkg::ORDER_BITS-1:0] orders;

    always_comb for (int i = 0; i < 3; i++) points[0][i] = 22'(point[i][21:LOW]) << LOW;
    assign grows[0] = {3'd5, 3'd3, 3'd1};

    function automatic raymarch_pkg::pair_t pair(input logic [LOW-1:0] a, input logic [LOW-1:0] b);
        pair = {a > b, a == b, a > ~b, a == ~b};
    endfunction

    assign orders[0] = {
        pair(point[2][LOW-1:0], point[0][LOW-1:0]), pair(point[2][LOW-1:0], point[1][LOW-1:0]), pair(point[0][LOW-1:0], point[1][LOW-1:0])
    };

    // The low bits of the three coordinates in the clock in which they are needed again.
    logic [2:0][LOW-1:0] low;

    delay #(.WIDTH(3 * LOW), .CLOCKS(3 * SPLIT + (APART ? 2 : 0))) low_waits (
        .clk, .enable(1'b1), .in({point[2][LOW-1:0], point[1][LOW-1:0], point[0][LOW-1:0]}), .out(low)
    );

    // The low bits of a coordinate that grows in a given direction of the world, {axis, positive}.
    function automatic logic [LOW-1:0] low_part(input logic [2:0][LOW-1:0] parts, input logic [2:0] grow);
        low_part = (grow[2] ? parts[2] : grow[1] ? parts[1] : parts[0]) ^ {LOW{!grow[0]}};
    endfunction

    for (genvar i = 0; i < LEVELS; i++) begin : folds
        // Side of the cubes of each level: 27, 9, 3, 1, 1/3, 1/9, to the nearest even multiple of 2^-12.
        localparam int S = i == 0 ? 27 << 12 : i == 1 ? 9 << 12 : i == 2 ? 3 << 12 : i == 3 ? 1 << 12 : i == 4 ? 1366 : 456;
        if (i == SPLIT) begin : together
            always_comb for (int j = 0; j < 3; j++) entering[i][j] = points[i][j] | 22'(low_part(low, grows[i][j]));
        end else begin : apart
            assign entering[i] = points[i];
        end

        menger_level #(.BITS(22), .LOW(i < SPLIT ? LOW : 0), .S(S)) level (
            .clk, .enable(levels[i]), .in(entering[i]), .in_grows(grows[i]), .in_order(i < SPLIT ? orders[i] : raymarch_pkg::ALL_EQUAL),
            .out(points[i+1]), .out_grows(grows[i+1]), .out_order(orders[i+1])
        );
    end

    logic [2:0][20:0]     size_1, size_2;
    logic [2:0][2:0]      grows_1, grows_2;
    raymarch_pkg::order_t order_1;
    logic                 z_over_x, z_over_y, x_over_y, big_is_z, big_is_x;
    logic [2:0]           surface_2;
    logic [20:0]          big;

    assign big_is_z = z_over_x && z_over_y;
    assign big_is_x = !big_is_z && x_over_y;
    assign surface_2 = big_is_z ? grows_2[2] : big_is_x ? grows_2[0] : grows_2[1];
    assign big       = (big_is_z ? size_2[2] : big_is_x ? size_2[0] : size_2[1]) | (APART ? 21'(low_part(low, surface_2)) : '0);

    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++) begin
            size_1[i]  <= points[LEVELS][i][20:0] ^ (HIGH_BITS & {21{points[LEVELS][i][21]}});
            grows_1[i] <= grows[LEVELS][i] ^ {2'b0, points[LEVELS][i][21]};
        end
        order_1  <= orders[LEVELS];
        size_2   <= size_1;
        grows_2  <= grows_1;
        z_over_x <= {size_1[2], raymarch_pkg::low_above(order_1.z_x, grows_1[2][0], grows_1[0][0])} > {size_1[0], 1'b0};
        z_over_y <= {size_1[2], raymarch_pkg::low_above(order_1.z_y, grows_1[2][0], grows_1[1][0])} > {size_1[1], 1'b0};
        x_over_y <= {size_1[0], raymarch_pkg::low_above(order_1.x_y, grows_1[0][0], grows_1[1][0])} > {size_1[1], 1'b0};
        distance <= $signed({1'b0, big}) - $signed(half);
        surface  <= surface_2;
    end
endmodule

`default_nettype wire

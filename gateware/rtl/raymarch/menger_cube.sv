// Distance, in the maximum norm, to the cube that represents all cubes of a Menger sponge after the folds of its levels.
//
//   point ─▶ |x| ─▶ largest ─▶ - half ─▶ distance, surface
//
// If LOW is not 0, the LOW lowest bits of the coordinates are not in `point`, as in menger_level. `order` is the result of comparing these
// bits, and `low` holds the bits, 2 clocks later. Latency 3 clocks, throughput one point per clock, no handshake. `half` must hold.

`default_nettype none

module menger_cube #(
    // 0 or raymarch_pkg::LOW_BITS.
    parameter int unsigned LOW = 0
) (
    input  wire                      clk,
    input  wire  [21:0]              half,
    input  wire  [2:0][21:0]         point,
    input  wire  [2:0][2:0]          grows,
    input  wire raymarch_pkg::order_t order,
    input  wire  [2:0][raymarch_pkg::LOW_BITS-1:0] low,
    output logic signed [21:0]       distance,
    output logic [2:0]               surface
);
    localparam logic [20:0] HIGH = '1 << LOW;

    logic [2:0][20:0]     size_1, size_2;
    logic [2:0][2:0]      grows_1, grows_2;
    raymarch_pkg::order_t order_1;
    logic                 z_over_x, z_over_y, x_over_y, big_is_z, big_is_x;
    logic [2:0]           surface_2;
    logic [20:0]          big;

    assign big_is_z  = z_over_x && z_over_y;
    assign big_is_x  = !big_is_z && x_over_y;
    assign surface_2 = big_is_z ? grows_2[2] : big_is_x ? grows_2[0] : grows_2[1];
    assign big       = (big_is_z ? size_2[2] : big_is_x ? size_2[0] : size_2[1])
                     | (LOW != 0 ? 21'(raymarch_pkg::low_part(low, surface_2)) : '0);

    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++) begin
            size_1[i]  <= point[i][20:0] ^ (HIGH & {21{point[i][21]}});
            grows_1[i] <= grows[i] ^ {2'b0, point[i][21]};
        end
        order_1  <= order;
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

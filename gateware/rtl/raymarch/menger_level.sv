// One level of the Menger sponge: mirrors space onto itself, so that one cube represents the 20 solid cubes of the level's 3x3x3
// (docs/formats/raymarch.md, "Fields"); its 7 holes move outside of this cube. S is the side length of the cube.
//
//         ┌───┬───┬───┐
//         │   │   │   │     1  S - |x| of each coordinate: above S/2 in the middle third
//         ├───┼───┼───┤     2  the largest of them
//         │   │   │   │     3  its coordinate is mirrored at S/2: a point in a hole (two coordinates in the
//         ├───┼───┼───┤        middle third) moves outside of |x| <= S/2, the next level's cube
//         │   │   │   │
//         └───┴───┴───┘ 3S wide
//
// An integer coordinate k represents k + 1/2, so that -x is ~k. For each coordinate, `grows` is the world direction in which the coordinate
// increases, {axis, positive}. Latency 3 clocks, throughput one point per clock, no handshake. While `enable` is low, points are not
// changed. `enable` must hold while points are in the module.
//
// The lowest bits of S/2 are 0, so a level changes the lowest bits of a coordinate only by mirroring and exchanging coordinates. The LOW
// lowest bits bypass this module: they are ignored in `in` and 0 in `out`. For each pair of coordinates, `in_order` is the result of
// comparing these bits before all mirroring; a coordinate has been mirrored if it is not positive in `in_grows`. With LOW = 0, all pairs in
// `in_order` are equal.

`default_nettype none

module menger_level #(
    parameter int unsigned BITS = 22,
    parameter int unsigned LOW  = 11,
    // Side length S of the cube after the folds, an even number.
    parameter int          S    = 27 << 12
) (
    input  wire                         clk,
    input  wire                         enable,
    input  wire  signed [2:0][BITS-1:0] in,
    input  wire         [2:0][2:0]      in_grows,
    input  wire raymarch_pkg::order_t   in_order,
    output logic signed [2:0][BITS-1:0] out,
    output logic        [2:0][2:0]      out_grows,
    output raymarch_pkg::order_t        out_order
);
    localparam int unsigned HIGH = BITS - LOW;
    localparam int          SIDE = S >> LOW;

    logic signed [HIGH-1:0] x_1, y_1, z_1, x_2, y_2, z_2, big, mirrored;
    logic [2:0][2:0]        grows_1, grows_2;
    raymarch_pkg::order_t   order_1, order_2;
    logic                   z_over_x, z_over_y, x_over_y;
    logic [2:0]             low_2;
    logic                   big_is_x, big_is_z, mirror;
    logic [2:0]             big_grows;

    function automatic logic signed [HIGH-1:0] folded(input logic [HIGH-1:0] k, input logic on);
        folded = (k ^ {HIGH{on && !k[HIGH-1]}}) + (on ? HIGH'(SIDE) : '0);
    endfunction

    // Returns whether {a, low bits of a} exceeds {b, low bits of b}; `low_above` is the comparison of the low bits.
    function automatic logic above(input logic signed [HIGH-1:0] a, input logic signed [HIGH-1:0] b, input logic low_above);
        above = $signed({a, low_above}) > $signed({b, 1'b0});
    endfunction

    always_ff @(posedge clk) begin
        x_1 <= folded(in[0][BITS-1:LOW], enable);
        y_1 <= folded(in[1][BITS-1:LOW], enable);
        z_1 <= folded(in[2][BITS-1:LOW], enable);
        for (int i = 0; i < 3; i++) grows_1[i] <= in_grows[i] ^ {2'b0, enable && !in[i][BITS-1]};
        order_1 <= in_order;

        x_2      <= x_1;
        y_2      <= y_1;
        z_2      <= z_1;
        grows_2  <= grows_1;
        order_2  <= order_1;
        z_over_x <= above(z_1, x_1, raymarch_pkg::low_above(order_1.z_x, grows_1[2][0], grows_1[0][0]));
        z_over_y <= above(z_1, y_1, raymarch_pkg::low_above(order_1.z_y, grows_1[2][0], grows_1[1][0]));
        x_over_y <= above(x_1, y_1, raymarch_pkg::low_above(order_1.x_y, grows_1[0][0], grows_1[1][0]));
        low_2    <= {z_1 < HIGH'(SIDE / 2), y_1 < HIGH'(SIDE / 2), x_1 < HIGH'(SIDE / 2)};
    end

    always_comb begin
        big_is_z  = enable && z_over_x && z_over_y;
        big_is_x  = enable && !(z_over_x && z_over_y) && x_over_y;
        big       = big_is_z ? z_2 : big_is_x ? x_2 : y_2;
        big_grows = big_is_z ? grows_2[2] : big_is_x ? grows_2[0] : grows_2[1];
        mirror    = enable && (big_is_z ? low_2[2] : big_is_x ? low_2[0] : low_2[1]);
        // `mirror` is only high if `enable` is high, so -SIDE is added if `enable` is high and `mirror` is low.
        mirrored  = (HIGH'(-SIDE) & {HIGH{enable ^ mirror}}) + (big ^ {HIGH{mirror}});
    end

    always_ff @(posedge clk) begin
        out[0]       <= BITS'(big_is_x ? y_2 : x_2) << LOW;
        out[1]       <= BITS'(mirrored) << LOW;
        out[2]       <= BITS'(big_is_z ? y_2 : z_2) << LOW;
        out_grows[0] <= big_is_x ? grows_2[1] : grows_2[0];
        out_grows[1] <= big_grows ^ {2'b0, mirror};
        out_grows[2] <= big_is_z ? grows_2[1] : grows_2[2];

        out_order <= order_2;
        if (big_is_x) begin
            out_order.z_x <= order_2.z_y;
            out_order.z_y <= order_2.z_x;
            out_order.x_y <= raymarch_pkg::swapped(order_2.x_y);
        end
        if (big_is_z) begin
            out_order.z_x <= raymarch_pkg::swapped(order_2.x_y);
            out_order.z_y <= raymarch_pkg::swapped(order_2.z_y);
            out_order.x_y <= raymarch_pkg::swapped(order_2.z_x);
        end
    end

    wire _unused = &{1'b0, in};
endmodule

`default_nettype wire

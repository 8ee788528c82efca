// Distance to a Menger sponge of half side 40.5, in the maximum norm, without a multiplier (docs/formats/raymarch.md, "Fields").
//
//             high bits ─▶ menger_level 27 ─▶ 9 ─▶ 3 ─▶ 1 ──────┐
//   point ─┬─▶ order of the low bits ─────────▲                 ├─▶ ... ─▶ |x| ─▶ largest ─▶ - half ─▶ distance, surface
//          └─▶ low bits ─▶ wait ─▶ mirrored, in their places ───┘
//
// The sides of the first four levels are integers. These levels do not change the low LOW bits of the coordinates except by mirroring and
// exchanging coordinates. The low bits therefore bypass these levels, which only need the order of the low bits in each pair of
// coordinates. Further levels get all bits.
//
// With BOX the last stage is field_box, and the module also computes the distance to a box, which is a sponge with no level in use.
//
// Latency 3 * LEVELS + 3 clocks, throughput one point per clock, no handshake. `levels` has a bit for each level in use, the
// first level in bit 0; `half` is half the side, along each axis, of the smallest solid cubes of a sponge, or of a box. The parameters must
// hold.

`default_nettype none

module field_menger #(
    parameter int unsigned LEVELS = 4,
    parameter bit          BOX    = 1'b0
) (
    input  wire                clk,
    input  wire  [LEVELS-1:0]  levels,
    input  wire  [2:0][21:0]   half,
    input  wire  [2:0][21:0]   point,
    output logic signed [21:0] distance,
    output logic [2:0]         surface
);
    // In the first SPLIT levels, the low LOW bits of half the cubes' side are 0.
    localparam int unsigned LOW   = raymarch_pkg::LOW_BITS;
    localparam int unsigned SPLIT = LEVELS < 4 ? LEVELS : 4;
    // Whether the low bits bypass all levels, up to menger_cube.
    localparam bit          APART = LEVELS == SPLIT && !BOX;

    // Coordinates between the levels. Between the first SPLIT levels they do not include the low bits.
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

    // The low bits of the three coordinates, delayed until all bits are used together.
    logic [2:0][LOW-1:0] low;

    delay #(.WIDTH(3 * LOW), .CLOCKS(3 * SPLIT + (APART ? 2 : 0))) low_waits (
        .clk, .enable(1'b1), .in({point[2][LOW-1:0], point[1][LOW-1:0], point[0][LOW-1:0]}), .out(low)
    );

    for (genvar i = 0; i < LEVELS; i++) begin : folds
        // Side of the cubes of each level: 27, 9, 3, 1, 1/3, 1/9, to the nearest even multiple of 2^-12.
        localparam int S = i == 0 ? 27 << 12 : i == 1 ? 9 << 12 : i == 2 ? 3 << 12 : i == 3 ? 1 << 12 : i == 4 ? 1366 : 456;
        if (i == SPLIT) begin : together
            always_comb for (int j = 0; j < 3; j++) entering[i][j] = points[i][j] | 22'(raymarch_pkg::low_part(low, grows[i][j]));
        end else begin : apart
            assign entering[i] = points[i];
        end

        menger_level #(.BITS(22), .LOW(i < SPLIT ? LOW : 0), .S(S)) level (
            .clk, .enable(levels[i]), .in(entering[i]), .in_grows(grows[i]), .in_order(i < SPLIT ? orders[i] : raymarch_pkg::ALL_EQUAL),
            .out(points[i+1]), .out_grows(grows[i+1]), .out_order(orders[i+1])
        );
    end

    if (BOX) begin : with_boxes
        // The point after all levels, with its low bits.
        logic [65:0] folded;
        logic [8:0]  grows_late;
        logic [2:0]  local_surface, growing;

        for (genvar i = 0; i < 3; i++) begin : axes
            assign folded[22*i +: 22] = points[LEVELS][i] | (LEVELS == SPLIT ? 22'(raymarch_pkg::low_part(low, grows[LEVELS][i])) : '0);
        end

        field_box box (.clk, .half, .point(folded), .distance, .surface(local_surface));
        delay #(.WIDTH(9), .CLOCKS(3)) grows_wait (.clk, .enable(1'b1), .in(grows[LEVELS]), .out(grows_late));

        // `local_surface` is the surface in the folded space, which is converted to a surface in the world.
        assign growing = local_surface[2] ? grows_late[8:6] : local_surface[1] ? grows_late[5:3] : grows_late[2:0];
        assign surface = growing ^ {2'b0, !local_surface[0]};
        wire _unused = &{1'b0, orders[LEVELS]};
    end else begin : sponges_alone
        menger_cube #(.LOW(APART ? LOW : 0)) cube (
            .clk, .half(half[0]), .point(points[LEVELS]), .grows(grows[LEVELS]), .order(orders[LEVELS]), .low(APART ? low : '0),
            .distance, .surface
        );
        wire _unused = &{1'b0, half};
    end
endmodule

`default_nettype wire

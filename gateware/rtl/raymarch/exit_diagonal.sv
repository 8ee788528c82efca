// Tests whether a point is above the fourth slab of an octahedron (docs/raymarch-exits.md, "Octahedra").
//
//   point ─▶ sum of the three coordinates, with their signs ─▶ - border ─▶ beyond
//
// `point` has a coordinate along each of three diagonals, measured from the lower border of the slab, and mirrored where `down` is high. A
// coordinate is between 0 and the thickness of the slabs, or slightly below 0 due to rounding; the integer k stands for k + 1/2. The
// coordinate along the fourth diagonal is the sum of the three; it is mirrored if `down_sum` is high. `half` is half the thickness of every
// slab.
//
// Latency 4 clocks from `point` and `down`, 3 clocks from `down_sum_1`; throughput one point per clock, no handshake. `half` must hold.

`default_nettype none

module exit_diagonal (
    input  wire                                    clk,
    input  wire  [exit_pkg::HALF_BITS-1:0]         half,
    input  wire  [2:0][exit_pkg::POINT_BITS-1:0]   point,
    input  wire  [2:0]                             down,
    input  wire                                    down_sum_1,
    output logic                                   beyond
);
    // Width of a slab's thickness, and of the signed sum of three coordinates.
    localparam int unsigned SIDE_BITS = exit_pkg::HALF_BITS + 1;
    localparam int unsigned SUM_BITS  = SIDE_BITS + 3;

    logic signed [SUM_BITS-1:0]  x_0, y_0, z_0, z_1, side, sum_1, sum_2, border_2, least_3;
    logic                        unused_2, unused_3, minus_2, flips_2, flips_3;
    logic [1:0]                  downs_1;
    logic [2:0]                  sides_1;

    // Complementing the integer of a coordinate mirrors the coordinate, because the integer k stands for k + 1/2. The three halves
    // add up to 3/2, so the integer of the sum is the sum of the integers plus 1.
    assign x_0 = {{2{point[0][SIDE_BITS]}}, point[0][SIDE_BITS:0]} ^ {SUM_BITS{down[0]}};
    assign y_0 = {{2{point[1][SIDE_BITS]}}, point[1][SIDE_BITS:0]} ^ {SUM_BITS{down[1]}};
    assign z_0 = {{2{point[2][SIDE_BITS]}}, point[2][SIDE_BITS:0]} ^ {SUM_BITS{down[2]}};

    assign side = {{SUM_BITS - SIDE_BITS{1'b0}}, half, 1'b0};

    // The upper border of the fourth slab is at 2 thicknesses, and one thickness lower for each mirrored axis.
    assign sides_1 = {1'b0, downs_1} + {2'd0, down_sum_1};

    always_ff @(posedge clk) begin
        sum_1   <= x_0 + y_0;
        z_1     <= z_0;
        downs_1 <= 2'(down[0]) + 2'(down[1]) + 2'(down[2]);

        {sum_2, unused_2} <= {sum_1, 1'b1} + {z_1, 1'b1};
        minus_2           <= sides_1 < 3'd2;
        flips_2           <= down_sum_1;
        unique case (sides_1)
            3'd0:    border_2 <= ~(side << 1);
            3'd1:    border_2 <= ~side;
            3'd3:    border_2 <= side;
            3'd4:    border_2 <= side << 1;
            default: border_2 <= '0;
        endcase

        {least_3, unused_3} <= {sum_2, minus_2} + {border_2, minus_2};
        flips_3             <= flips_2;
        beyond              <= least_3[SUM_BITS-1] == flips_3;
    end

    wire _unused = &{1'b0, point[0][exit_pkg::POINT_BITS-1:SIDE_BITS+1], point[1][exit_pkg::POINT_BITS-1:SIDE_BITS+1],
                     point[2][exit_pkg::POINT_BITS-1:SIDE_BITS+1], unused_2, unused_3, least_3[SUM_BITS-2:0]};
endmodule

`default_nettype wire

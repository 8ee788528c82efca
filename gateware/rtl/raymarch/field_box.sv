// Distance to a box, in the maximum norm (docs/formats/raymarch.md, "Fields").
//
//   point ─▶ |x| - half of each coordinate ─▶ largest ─▶ distance, surface
//
// Latency 3 clocks, throughput one point per clock, no handshake. `half` is half the length of the box along each axis, and must hold.

`default_nettype none

module field_box (
    input  wire                clk,
    input  wire  [2:0][21:0]   half,
    input  wire  [2:0][21:0]   point,
    output logic signed [21:0] distance,
    output logic [2:0]         surface
);
    logic signed [22:0] x_1, y_1, z_1, x_2, y_2, z_2, big;
    logic [2:0]         negative_1, negative_2;
    logic               z_over_x, z_over_y, x_over_y, big_is_z, big_is_x;

    // Returns side − |k| − 1, which is the complement of |k| − side, the distance from the coordinate k to the box's face. Yosys puts the
    // absolute value into the LUTs of this sum, but uses separate LUTs for the absolute value of a minuend.
    function automatic logic signed [22:0] depth_within(input logic [21:0] k, input logic [21:0] side);
        depth_within = $signed({1'b0, side}) + $signed(~{2'b0, k[20:0] ^ {21{k[21]}}});
    endfunction

    assign big_is_z = z_over_x && z_over_y;
    assign big_is_x = !big_is_z && x_over_y;
    assign big      = big_is_z ? z_2 : big_is_x ? x_2 : y_2;

    always_ff @(posedge clk) begin
        x_1 <= depth_within(point[0], half[0]);
        y_1 <= depth_within(point[1], half[1]);
        z_1 <= depth_within(point[2], half[2]);
        negative_1 <= {point[2][21], point[1][21], point[0][21]};

        {x_2, y_2, z_2} <= {x_1, y_1, z_1};
        negative_2 <= negative_1;
        z_over_x   <= z_1 < x_1;
        z_over_y   <= z_1 < y_1;
        x_over_y   <= x_1 < y_1;

        distance <= ~big[21:0];
        if (big_is_z)      surface <= {2'd2, !negative_2[2]};
        else if (big_is_x) surface <= {2'd0, !negative_2[0]};
        else               surface <= {2'd1, !negative_2[1]};
    end

    wire _unused = big[22];
endmodule

`default_nettype wire

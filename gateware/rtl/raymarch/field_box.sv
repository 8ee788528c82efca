// Distance to a box, in the maximum norm: a single box or boxes repeated every 64 units, from outside or inside (docs/formats/raymarch.md,
// "Fields").
//
//   point ─▶ |x| - half of each coordinate ─▶ largest ─▶ distance, surface
//
// Latency 3 clocks, throughput one point per clock, no handshake. `half` is half the length of the box along each axis. Bit i of `has` is 1
// if the box is bounded along axis i. While `room` is high, the solid is the space outside of the box. The parameters must hold.

`default_nettype none

module field_box (
    input  wire                clk,
    input  wire  [2:0][21:0]   half,
    input  wire  [2:0]         has,
    input  wire                room,
    input  wire                repeated,
    input  wire  [2:0][21:0]   point,
    output logic signed [21:0] distance,
    output logic [2:0]         surface
);
    logic [2:0][21:0] place;

    always_comb begin
        for (int i = 0; i < 3; i++) begin
            place[i] = point[i];
            // The period of 64 units is 2^18 in units of the coordinates. The point is moved to the equivalent position in the cell about
            // the origin.
            if (repeated) place[i][21:18] = {4{point[i][17]}};
        end
    end

    logic signed [22:0] x_1, y_1, z_1, x_2, y_2, z_2, big;
    logic [2:0]         negative_1, negative_2;
    logic               z_over_x, z_over_y, x_over_y, big_is_z, big_is_x;

    // Returns side − |k| − 1, which is the complement of |k| − side, the distance from the coordinate k to the box's face. If the box is
    // not bounded along the axis (`there` is low), the result is the largest value. Yosys puts the absolute value into the LUTs of this
    // sum, but uses separate LUTs for the absolute value of a minuend.
    function automatic logic signed [22:0] depth_within(input logic [21:0] k, input logic [21:0] side, input logic has_side);
        depth_within = has_side ? $signed({1'b0, side}) + $signed(~{2'b0, k[20:0] ^ {21{k[21]}}}) : {1'b0, {22{1'b1}}};
    endfunction

    assign big_is_z = z_over_x && z_over_y;
    assign big_is_x = !big_is_z && x_over_y;
    assign big      = big_is_z ? z_2 : big_is_x ? x_2 : y_2;

    always_ff @(posedge clk) begin
        x_1 <= depth_within(place[0], half[0], has[0]);
        y_1 <= depth_within(place[1], half[1], has[1]);
        z_1 <= depth_within(place[2], half[2], has[2]);
        negative_1 <= {place[2][21], place[1][21], place[0][21]};

        {x_2, y_2, z_2} <= {x_1, y_1, z_1};
        negative_2 <= negative_1;
        z_over_x   <= z_1 < x_1;
        z_over_y   <= z_1 < y_1;
        x_over_y   <= x_1 < y_1;

        distance <= big[21:0] ^ {22{!room}};
        if (big_is_z)      surface <= {2'd2, !negative_2[2] ^ room};
        else if (big_is_x) surface <= {2'd0, !negative_2[0] ^ room};
        else               surface <= {2'd1, !negative_2[1] ^ room};
    end

    wire _unused = big[22];
endmodule

`default_nettype wire

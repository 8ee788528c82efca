// Distance to an octahedron about the origin, |x| + |y| + |z| <= size, in the maximum norm.
//
//   point ─▶ |x|, |y|, |z| ─▶ |x| + |y|, |z| - size ─▶ sum ─▶ * 5 ─▶ * 17 ─▶ / 256 ─▶ distance
//
// If every coordinate of a point changes by at most r, |x| + |y| + |z| changes by at most 3r. The distance is therefore at least a third of
// |x| + |y| + |z| - size. The module computes 85/256 of this value, rounded down, which is a lower bound of the third and needs no
// multiplier. `surface` is {z, y, x}, with a 1 for each positive component of the face's normal.
//
// Latency 5 clocks, throughput one point per clock, no handshake. `size` must hold.

`default_nettype none

module field_octahedron (
    input  wire                clk,
    input  wire  [21:0]        size,
    input  wire  [2:0][21:0]   point,
    output logic signed [21:0] distance,
    output logic [2:0]         surface
);
    logic [2:0][20:0]   size_1;
    logic [2:0]         positive_1;
    logic [21:0]        x_y_2;
    logic signed [22:0] z_2;
    logic signed [23:0] sum_3;
    logic signed [26:0] by_5_4;
    logic signed [30:0] by_85_5;

    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++) begin
            size_1[i]     <= point[i][20:0] ^ {21{point[i][21]}};
            positive_1[i] <= !point[i][21];
        end
        x_y_2   <= {1'b0, size_1[0]} + {1'b0, size_1[1]};
        z_2     <= $signed({2'b0, size_1[2]}) - $signed({1'b0, size});
        sum_3   <= $signed({2'b0, x_y_2}) + 24'(z_2);
        by_5_4  <= 27'(sum_3) + $signed({sum_3[23], sum_3, 2'b0});
        by_85_5 <= 31'(by_5_4) + $signed({by_5_4, 4'b0});
    end

    assign distance = by_85_5[29:8];

    delay #(.WIDTH(3), .CLOCKS(4)) signs (.clk, .enable(1'b1), .in(positive_1), .out(surface));

    wire _unused = &{1'b0, by_85_5[30], by_85_5[7:0]};
endmodule

`default_nettype wire

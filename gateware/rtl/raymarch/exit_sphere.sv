// Tests whether a ray in the box around a sphere of a lattice meets the sphere (docs/raymarch-exits.md, "Spheres of a lattice").
//
//   point ─▶ q ─┬─▶ |q|² - r² ─▶ ·|D|² ─┐
//               └─▶ q·D ─▶ square ──────┴─▶ - ─▶ square of the root
//
// The point is relative to the lower corner of the box in cell 0, along the mirrored axes of the ray; q is the point relative to the centre
// of the box in its cell. `over_1` is high for an axis along which the point, within its cell, is above the box: rounding has then placed
// the point before the next box, and its coordinate is replaced by that of the border of the box. `half` is the radius. `speed` (the
// magnitudes of D's components) and `length` are fields of exit_pkg::ray_t.
//
// `meets` is high if the ray meets the sphere: the point is in the sphere (`starts`), or the equation has solutions in the ray's direction.
// `along` and `rest` are fields of exit_pkg::equation_t.
//
// The suffix of a name is the number of clocks after the point; the three axes are processed in successive clocks. Latency 8 clocks to
// `along`, 11 clocks to `rest` and `starts`, 12 clocks to `meets`; throughput one point per clock, no handshake. `half` must hold.

`default_nettype none

module exit_sphere (
    input  wire                                    clk,
    input  wire  [exit_pkg::HALF_BITS-1:0]         half,
    input  wire  [2:0][exit_pkg::POINT_BITS-1:0]   point,
    input  wire  [2:0]                             over_1,
    input  wire  [exit_pkg::SPEED_BITS-1:0]        speed_x_2,
    input  wire  [exit_pkg::SPEED_BITS-1:0]        speed_y_3,
    input  wire  [exit_pkg::SPEED_BITS-1:0]        speed_z_4,
    input  wire exit_pkg::length_t                 length_7,
    output logic [exit_pkg::ALONG_BITS-1:0]        along,
    output logic [exit_pkg::REST_BITS-1:0]         rest,
    output logic                                   starts,
    output logic                                   meets
);
    // Half the period has 17 bits.
    logic [2:0][17:0]   place_1, inside_1, q_2;
    logic signed [17:0] offset_2, y_3, z_3, z_4;
    logic signed [18:0] left_2, left_3, left_4;

    // The first square minus r² is computed as (x + r)·(x - r), the product of the distances from both borders of the box. The factor x + r
    // fits 18 bits after half a period is subtracted from it; the addend compensates for this.
    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++) begin
            place_1[i] <= point[i][17:0];
            q_2[i]     <= inside_1[i] - {1'b0, half[16:0]};
        end
        offset_2         <= {!inside_1[0][17], inside_1[0][16:0]};
        left_2           <= {1'b0, inside_1[0]} - {1'b0, half[16:0], 1'b0};
        {left_4, left_3} <= {left_3, left_2};
        {z_4, z_3, y_3}  <= {z_3, q_2[2], q_2[1]};
    end

    always_comb for (int i = 0; i < 3; i++) inside_1[i] = over_1[i] ? '0 : place_1[i];

    logic signed [35:0] beyond_5, beyond_6, beyond_7;
    logic signed [43:0] along_5, along_6, along_7;
    logic signed [21:0] along_8;
    logic signed [42:0] product_10, square_11;
    logic               falls_11;

    multiply_add #(.BITS(36)) beyond_x (
        .clk, .enable(1'b1), .a(25'(left_2)), .b(offset_2), .c({left_4, 17'd0}), .p(beyond_5)
    );
    multiply_add #(.BITS(36)) beyond_y (.clk, .enable(1'b1), .a(25'(y_3)), .b(y_3), .c(beyond_5), .p(beyond_6));
    multiply_add #(.BITS(36)) beyond_z (.clk, .enable(1'b1), .a(25'(z_4)), .b(z_4), .c(beyond_6), .p(beyond_7));
    multiply_add #(.BITS(44)) along_x (.clk, .enable(1'b1), .a({1'b0, speed_x_2, 1'b1}), .b(q_2[0]), .c('0), .p(along_5));
    multiply_add #(.BITS(44)) along_y (.clk, .enable(1'b1), .a({1'b0, speed_y_3, 1'b1}), .b(y_3), .c(along_5), .p(along_6));
    multiply_add #(.BITS(44)) along_z (.clk, .enable(1'b1), .a({1'b0, speed_z_4, 1'b1}), .b(z_4), .c(along_6), .p(along_7));

    // q·D with the doubled direction.
    always_ff @(posedge clk)
        unique case (length_7.doublings)
            2'd0: along_8 <= along_7[43:22];
            2'd1: along_8 <= along_7[42:21];
            2'd2: along_8 <= along_7[41:20];
            2'd3: along_8 <= along_7[40:19];
        endcase

    // The negated number whose root is to be computed, with 26 fraction bits.
    multiply_add #(.BITS(43)) part (
        .clk, .enable(1'b1), .a({1'b0, beyond_7[34:11]}), .b({1'b0, length_7.square}), .c('0), .p(product_10)
    );
    square_add #(.NEGATIVE(1'b1)) difference (.clk, .x({along_8, 2'd0}), .c({2'd0, product_10[42:2]}), .p(square_11));

    delay #(.WIDTH(1), .CLOCKS(4)) start_waits (.clk, .enable(1'b1), .in(beyond_7[35]), .out(starts));
    delay #(.WIDTH(1), .CLOCKS(3)) sign_waits (.clk, .enable(1'b1), .in(along_8[21]), .out(falls_11));

    always_ff @(posedge clk) meets <= starts || falls_11 && square_11[42];

    assign along = along_8[20:0];
    assign rest  = square_11[37:6];

    wire _unused = &{1'b0, half[20:17], point[0][27:18], point[1][27:18], point[2][27:18], beyond_7[10:0], along_7[18:0],
                     product_10[1:0], square_11[41:38], square_11[5:0]};
endmodule

`default_nettype wire

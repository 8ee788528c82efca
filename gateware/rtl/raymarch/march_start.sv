// Starts the rays of a field by distances, without division or square root (docs/formats/raymarch.md, "Rays").
//
//   D ─▶ largest component ─▶ its inverse ─▶ direction = D·inverse
//              │                                  │
//              └─▶ near·largest component         └─▶ inverses of the components
//                               └─▶ start: the largest of the near plane and of the entries into the box;
//                                   an entry is outside·inverse, with a second product for the remaining distance
//
// D is the direction of a ray before normalisation. `outside` is the distance of the eye from the box about the field, along each axis.
//
// With ROUND, and while `round` is high, rays are scaled by their Euclidean length: the sum of three squares replaces the
// largest component of D, and a table of 1/sqrt replaces the table of reciprocals.
//
// Latency 23 clocks, 26 with ROUND; throughput one ray per clock, no handshake: `in_valid` travels with the ray. The constants must hold.

`default_nettype none

module march_start #(
    parameter bit ROUND  = 1'b0,
    parameter bit STEREO = 1'b1
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       round,
    input  wire  [22:0]               near_limit,
    // For both eyes: the position, and the distance outside of the box about the field along each axis.
    input  wire  [1:0][2:0][24:0]     origins,
    input  wire  [1:0][2:0][23:0]     outside,
    // Pixels.
    input  wire                       in_valid,
    input  wire raymarch_pkg::place_t in_place,
    input  wire  [2:0][24:0]          in_direction,
    // Rays.
    output logic                      out_valid,
    output raymarch_pkg::ray_t        out_ray
);
    // SUM: number of clocks that the sum of squares takes in addition to those for the largest component of D. LAST: latency in clocks.
    localparam int unsigned SUM  = ROUND ? 3 : 0;
    localparam int unsigned LAST = SUM + 23;

    logic [LAST:1] valid;

    always_ff @(posedge clk) begin
        valid <= {valid[LAST-1:1], in_valid};
        if (rst) valid <= '0;
    end

    // The suffix of a name is the signal's clock: 0 for D; 1 for the first ten bits of the magnitude of each component; 2 for the largest of
    // these magnitudes; 4 for the reciprocal of this magnitude.
    raymarch_pkg::place_t place_0;
    logic [9:0]  part_x, part_y, part_z, largest_2, length_10;
    logic [16:0] largest_inverse_4, inverse_4;
    logic [2:0][24:0] d_0, d_4;

    if (ROUND) begin : wait_for_sum
        delay #(.WIDTH(75), .CLOCKS(SUM)) d_waits (.clk, .enable(1'b1), .in(in_direction), .out(d_0));
        delay #(.WIDTH(raymarch_pkg::PLACE_BITS), .CLOCKS(SUM)) place_waits_too (.clk, .enable(1'b1), .in(in_place), .out(place_0));
    end else begin : at_once
        assign d_0     = in_direction;
        assign place_0 = in_place;
    end

    always_ff @(posedge clk) begin
        part_x <= d_0[0][23:14] ^ {10{d_0[0][24]}};
        part_y <= d_0[1][23:14] ^ {10{d_0[1][24]}};
        part_z <= d_0[2][23:14] ^ {10{d_0[2][24]}};
        if (part_z > part_x && part_z > part_y) largest_2 <= part_z;
        else if (part_x > part_y)               largest_2 <= part_x;
        else                                    largest_2 <= part_y;
    end

    wide_delay #(.WIDTH(75), .CLOCKS(4)) wait_for_inverse (.clk, .in(d_0), .out(d_4));

    // `part` is the factor by which the near plane's depth is multiplied: the largest component of D, or while `round` is high the length
    // of D. The length is the product of the squared length, which is the index into the table of 1/sqrt, and the entry of the table.
    logic [10:0] part_10, part_18;

    if (ROUND) begin : by_squares
        logic [16:0]        x_now, y_now, z_now, y_late, z_late, round_inverse_4, inverse_7;
        logic signed [36:0] x_square, x_y_square, square_2, product_10;
        logic [9:0]         squared_2, length_3, length_7, length_9;

        assign x_now = in_direction[0][23:7] ^ {17{in_direction[0][24]}};
        assign y_now = in_direction[1][23:7] ^ {17{in_direction[1][24]}};
        assign z_now = in_direction[2][23:7] ^ {17{in_direction[2][24]}};

        delay #(.WIDTH(17), .CLOCKS(1)) y_waits (.clk, .enable(1'b1), .in(y_now), .out(y_late));
        delay #(.WIDTH(17), .CLOCKS(2)) z_waits (.clk, .enable(1'b1), .in(z_now), .out(z_late));

        // The addend compensates for the truncated bits, so that the sum is at least |D|^2, with 34 fraction bits.
        multiply_add #(.BITS(37)) x_squared (
            .clk, .enable(1'b1), .a({8'b0, x_now}), .b({1'b0, x_now}), .c(37'd1 << 19), .p(x_square)
        );
        multiply_add #(.BITS(37)) y_squared (
            .clk, .enable(1'b1), .a({8'b0, y_late}), .b({1'b0, y_late}), .c(x_square), .p(x_y_square)
        );
        multiply_add #(.BITS(37)) z_squared (
            .clk, .enable(1'b1), .a({8'b0, z_late}), .b({1'b0, z_late}), .c(x_y_square), .p(square_2)
        );

        round_inverse length_by_square (.clk, .index(squared_2), .inverse(round_inverse_4));

        assign squared_2 = square_2[33:24];
        always_ff @(posedge clk) length_3 <= round ? squared_2 : largest_2;

        assign inverse_4 = round ? round_inverse_4 : largest_inverse_4;

        // The product inverse·square is a lower bound of the length |D|.
        delay #(.WIDTH(10), .CLOCKS(4)) length_waits (.clk, .enable(1'b1), .in(length_3), .out(length_7));
        delay #(.WIDTH(10), .CLOCKS(2)) length_goes_on (.clk, .enable(1'b1), .in(length_7), .out(length_9));
        delay #(.WIDTH(10), .CLOCKS(1)) length_is_there (.clk, .enable(1'b1), .in(length_9), .out(length_10));
        delay #(.WIDTH(17), .CLOCKS(3)) inverse_waits (.clk, .enable(1'b1), .in(inverse_4), .out(inverse_7));
        multiply_add #(.BITS(37)) length_again (
            .clk, .enable(1'b1), .a({8'b0, inverse_7}), .b({8'b0, length_7} + 18'd1), .c('0), .p(product_10)
        );

        assign part_10 = round ? product_10[19:9] : {1'b0, length_10} + 11'd1;

        wire _unused = &{1'b0, square_2[36:34], square_2[23:0], product_10[36:20], product_10[8:0]};
    end else begin : by_largest
        assign inverse_4 = largest_inverse_4;
        assign part_10   = {1'b0, length_10} + 11'd1;
        delay #(.WIDTH(10), .CLOCKS(8)) length_waits (.clk, .enable(1'b1), .in(largest_2), .out(length_10));

        wire _unused = round;
    end

    // The suffix of a name is the signal's clock: 7 for the direction, 9 for the reciprocals of its components.
    logic [2:0][17:0] direction_7;
    logic [2:0][9:0]  index_7;
    logic [2:0][16:0] inverse_9;

    inverse_table length_and_x (
        .clk, .index_a(largest_2), .inverse_a(largest_inverse_4), .index_b(index_7[0]), .inverse_b(inverse_9[0])
    );
    inverse_table y_and_z (
        .clk, .index_a(index_7[1]), .inverse_a(inverse_9[1]), .index_b(index_7[2]), .inverse_b(inverse_9[2])
    );

    logic             eye_9;
    logic [22:0]      near_21;
    logic [33:0]      near_product;
    logic [2:0][22:0] entry_21;

    delay #(.WIDTH(1), .CLOCKS(9)) eye_waits (.clk, .enable(1'b1), .in(STEREO && place_0.eye), .out(eye_9));
    delay #(.WIDTH(11), .CLOCKS(8)) part_stays (.clk, .enable(1'b1), .in(part_10), .out(part_18));

    // For each axis: the distance of the eye from the box, and the first estimate of t at the entry into the box. The suffix of a name is
    // the signal's clock.
    logic [2:0][23:0] outside_9, outside_16;
    logic [2:0][22:0] t_13, t_19;

    wide_delay #(.WIDTH(72), .CLOCKS(7)) outside_waits (.clk, .in(outside_9), .out(outside_16));
    wide_delay #(.WIDTH(69), .CLOCKS(6)) t_waits (.clk, .in(t_13), .out(t_19));

    // Clocks 10 to 21 compute, for each axis, the ray parameter t at which the ray enters the box about the field.
    for (genvar i = 0; i < 3; i++) begin : axes
        logic signed [42:0] scaled;
        logic               backwards_9, negative_9;

        multiply_add #(.BITS(43)) scale (
            .clk, .enable(1'b1), .a(d_4[i]), .b({1'b0, inverse_4}), .c(43'd1 << 15), .p(scaled)
        );
        assign direction_7[i] = scaled[33:16];
        assign index_7[i]     = direction_7[i][16:7] ^ {10{direction_7[i][17]}};

        delay #(.WIDTH(1), .CLOCKS(2)) sign (.clk, .enable(1'b1), .in(direction_7[i][17]), .out(backwards_9));
        assign negative_9 = eye_9 ? origins[1][i][24] : origins[0][i][24];

        // The suffix of a name is the signal's clock: 12 for outside·inverse; 13 for this product, saturated, which is the first estimate
        // of t; 16 for t·(|d| + 1), the distance covered up to this t; 17 for the remaining distance to the box; 20 for the remaining
        // distance times the reciprocal, plus the first estimate; 21 for this sum, saturated, which is t at the entry into the box.
        logic [16:0]        part_7, part_13, inverse_17;
        logic [24:0]        left_17;
        logic signed [41:0] product_12, gone_16;
        logic signed [42:0] sum_20;
        logic [22:0]        t_15;
        logic               comes_20;

        assign outside_9[i] = eye_9 ? outside[1][i] : outside[0][i];
        assign part_7    = direction_7[i][16:0] ^ {17{direction_7[i][17]}};

        delay #(.WIDTH(1), .CLOCKS(11)) coming (.clk, .enable(1'b1), .in(negative_9 != backwards_9), .out(comes_20));
        delay #(.WIDTH(17), .CLOCKS(6)) part_waits (.clk, .enable(1'b1), .in(part_7), .out(part_13));
        delay #(.WIDTH(17), .CLOCKS(8)) inverse_waits (.clk, .enable(1'b1), .in(inverse_9[i]), .out(inverse_17));
        delay #(.WIDTH(23), .CLOCKS(2)) t_goes (.clk, .enable(1'b1), .in(t_13[i]), .out(t_15));

        multiply_add #(.BITS(42)) entry (
            .clk, .enable(1'b1), .a({1'b0, outside_9[i]}), .b({1'b0, inverse_9[i]}), .c('0), .p(product_12)
        );
        multiply_add #(.BITS(42)) covered (
            .clk, .enable(1'b1), .a({2'b0, t_13[i]}), .b({1'b0, part_13}), .c({19'b0, t_15}), .p(gone_16)
        );
        // If the remaining distance is negative, the point at the first estimate is inside of the box, and 0 is added.
        multiply_add #(.BITS(43)) rest (
            .clk, .enable(1'b1), .a({1'b0, left_17[23:0]}), .b({1'b0, inverse_17 & {17{!left_17[24]}}}), .c({11'b0, t_19[i], 9'b0}),
            .p(sum_20)
        );
        always_ff @(posedge clk) begin
            t_13[i] <= product_12[31:9] | {23{product_12[41:32] != '0}};
            left_17 <= {1'b0, outside_16[i]} + {1'b1, ~gone_16[40:17]};
            entry_21[i] <= !comes_20 ? '0 : sum_20[31:9] | {23{sum_20[41:32] != '0}};
        end

        wire _unused = &{1'b0, scaled[42:34], scaled[15:0], product_12[8:0], gone_16[41], gone_16[16:0], sum_20[42], sum_20[8:0]};
    end

    // In clock 21 the values of t for the near plane and for the entries into the box are valid.
    multiply_add #(.BITS(34)) at_near (
        .clk, .enable(1'b1), .a({2'b0, near_limit}), .b({7'b0, part_18}), .c('0), .p(near_product)
    );
    assign near_21 = near_product[32:10];

    // Clocks 22 and 23 select the start of the ray, the largest of the four values of t in clock 21: one for the near plane, and one for
    // the entry into the box along each of the three axes.
    logic [22:0] farther_22, later_22, start_23;

    always_ff @(posedge clk) begin
        farther_22 <= entry_21[0] > entry_21[1] ? entry_21[0] : entry_21[1];
        later_22   <= entry_21[2] > near_21 ? entry_21[2] : near_21;
        start_23   <= farther_22 > later_22 ? farther_22 : later_22;
    end

    raymarch_pkg::place_t place_23;
    logic [9:0]        length_23;
    logic [2:0][17:0]  direction_23;

    delay #(.WIDTH(raymarch_pkg::PLACE_BITS), .CLOCKS(23)) place_goes (.clk, .enable(1'b1), .in(place_0), .out(place_23));
    delay #(.WIDTH(10), .CLOCKS(13)) length_goes (.clk, .enable(1'b1), .in(length_10), .out(length_23));
    wide_delay #(.WIDTH(54), .CLOCKS(16)) direction_goes (.clk, .in(direction_7), .out(direction_23));

    assign out_valid = valid[LAST];
    assign out_ray   = {place_23, length_23, start_23, direction_23};

    // Only the signs of the origins are used here.
    wire _unused = &{1'b0, origins, near_product[33], near_product[9:0]};
endmodule

`default_nettype wire

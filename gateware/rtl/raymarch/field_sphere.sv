// Distance from a point to one of up to eight spheres, in the Euclidean norm, rounded down (docs/formats/raymarch.md, "Round fields").
//
//   point - centre ─▶ |x|, |y|, |z| ─▶ shift ─▶ three squares, one sum ─▶ root ─▶ shift back ─▶ - radius ─▶ distance
//                                        │                                            ▲
//                                        └──────────── shift ─────────────────────────┘
//
// After the shift the largest coordinate has 17 bits. The root is a linear interpolation between two entries of a table. The computed
// length never exceeds the exact length; it is too small by at most 3·2^-12 plus 2^-15 of the length. Distances of 2^9 and more saturate at
// 2^9 - 2^-12.
//
// Latency 18 clocks, throughput one point per clock, no handshake. `number` must arrive one clock before its point. One sphere per clock
// can be written, while the pipeline is empty.

`default_nettype none

module field_sphere (
    input  wire                     clk,
    input  wire                     sphere_write,
    input  wire  [2:0]              sphere_number,
    input  wire raymarch_registers_pkg::sphere_t sphere,
    input  wire  [2:0]              number,
    input  wire  [2:0][21:0]        point,
    output logic signed [21:0]      distance
);
    (* ram_style = "distributed" *) logic [65:0] centres [0:7];
    (* ram_style = "distributed" *) logic [20:0] radii [0:7];

    logic [2:0][21:0] centre_0;
    logic [2:0]       number_16;
    logic [20:0]      radius_17;

    delay #(.WIDTH(3), .CLOCKS(17)) number_waits (.clk, .enable(1'b1), .in(number), .out(number_16));

    always_ff @(posedge clk) begin
        if (sphere_write) begin
            for (int i = 0; i < 3; i++) centres[sphere_number][22*i +: 22] <= sphere.centre[i][21:0];
            radii[sphere_number]   <= sphere.radius;
        end
        centre_0  <= centres[number];
        radius_17 <= radii[number_16];
    end

    // The suffix of a name is the signal's clock: 1 for the point relative to the centre; 2 for the magnitudes of the coordinates and their
    // bitwise OR; 3 and 4 for the magnitudes, shifted left until the highest bit of the OR is one of the top two bits.
    logic [2:0][22:0] apart_1;
    logic [2:0][21:0] size_2, by_8, shifted_8;
    logic [2:0][17:0] by_2;
    logic [21:0]      any_2, any_8;
    logic [7:0]       any_3;
    logic [1:0]       eights, eights_3, twos;
    logic             full_4;
    logic [4:0]       places_4, places_10;

    function automatic logic [22:0] minus(input logic [21:0] k, input logic [21:0] c);
        minus = {k[21], k} - {c[21], c};
    endfunction

    function automatic logic [21:0] magnitude(input logic [22:0] k);
        magnitude = k[21:0] ^ {22{k[22]}};
    endfunction

    function automatic logic [21:0] by_eights(input logic [21:0] k, input logic [1:0] how_many);
        by_eights = how_many == 2'd0 ? k : how_many == 2'd1 ? {k[13:0], 8'b0} : {k[5:0], 16'b0};
    endfunction

    function automatic logic [17:0] by_twos(input logic [21:0] k, input logic [1:0] how_many);
        unique case (how_many)
            2'd0: by_twos = k[21:4];
            2'd1: by_twos = k[19:2];
            2'd2: by_twos = k[17:0];
            2'd3: by_twos = {k[15:0], 2'b0};
        endcase
    endfunction

    always_comb begin
        eights = any_2[21:14] != '0 ? 2'd0 : any_2[13:6] != '0 ? 2'd1 : 2'd2;
        any_8  = by_eights(any_2, eights);
        twos   = any_3[7:6] != '0 ? 2'd0 : any_3[5:4] != '0 ? 2'd1 : any_3[3:2] != '0 ? 2'd2 : 2'd3;
        for (int i = 0; i < 3; i++) shifted_8[i] = by_eights(size_2[i], eights);
    end

    always_ff @(posedge clk) begin
        for (int i = 0; i < 3; i++) begin
            apart_1[i] <= minus(point[i], centre_0[i]);
            size_2[i]  <= magnitude(apart_1[i]);
            by_8[i]    <= shifted_8[i];
            by_2[i]    <= by_twos(by_8[i], twos);
        end
        any_2    <= magnitude(apart_1[0]) | magnitude(apart_1[1]) | magnitude(apart_1[2]);
        any_3    <= any_8[21:14];
        eights_3 <= eights;
        full_4   <= twos == 2'd0 ? any_3[7] : twos == 2'd1 ? any_3[5] : twos == 2'd2 ? any_3[3] : any_3[1];
        places_4 <= {eights_3, twos, 1'b0};
    end

    // In clock 9 the sum of the squares is valid; it is 2^32 to 3·2^34.
    logic [2:0][16:0]   part_4;
    logic [16:0]        part_y_5, part_z_6;
    logic signed [36:0] x_7, x_y_8, square_9;
    logic [33:0]        square_10;
    logic               doubled_9, doubled_10;

    always_comb
        for (int i = 0; i < 3; i++) part_4[i] = full_4 ? by_2[i][17:1] : by_2[i][16:0];

    delay #(.WIDTH(17), .CLOCKS(1)) y_waits (.clk, .enable(1'b1), .in(part_4[1]), .out(part_y_5));
    delay #(.WIDTH(17), .CLOCKS(2)) z_waits (.clk, .enable(1'b1), .in(part_4[2]), .out(part_z_6));

    multiply_add #(.BITS(37)) x_square (
        .clk, .enable(1'b1), .a({8'b0, part_4[0]}), .b({1'b0, part_4[0]}), .c('0), .p(x_7)
    );
    multiply_add #(.BITS(37)) y_square (
        .clk, .enable(1'b1), .a({8'b0, part_y_5}), .b({1'b0, part_y_5}), .c(x_7), .p(x_y_8)
    );
    multiply_add #(.BITS(37)) z_square (
        .clk, .enable(1'b1), .a({8'b0, part_z_6}), .b({1'b0, part_z_6}), .c(x_y_8), .p(square_9)
    );

    // The suffix of a name is the signal's clock: 10 for the sum, divided by 4 if it is too large for the table; 12 for the entry of the
    // table; 15 for the root, which is 2^18 to 2^19.
    logic [17:0]        base_12, base_14;
    logic [9:0]         slope_12;
    logic [16:0]        rest_12;
    logic signed [36:0] root_15;

    assign doubled_9 = square_9[35:34] != '0;

    root_table roots (.clk, .index(square_10[33:25]), .root(base_12), .slope(slope_12));
    delay #(.WIDTH(17), .CLOCKS(2)) rest_waits (.clk, .enable(1'b1), .in(square_10[24:8]), .out(rest_12));
    delay #(.WIDTH(18), .CLOCKS(2)) base_waits (.clk, .enable(1'b1), .in(base_12), .out(base_14));
    multiply_add #(.BITS(37)) between (
        .clk, .enable(1'b1), .a({15'b0, slope_12}), .b({1'b0, rest_12}), .c({1'b0, 1'b1, base_14, 17'b0}), .p(root_15)
    );

    // The suffix of a name is the signal's clock: 16 and 17 for the length, shifted back; 18 for the distance.
    logic [4:0]         back_11, back_15;
    logic [2:0]         back_16;
    logic [22:0]        length_16, length_17;
    logic signed [23:0] over;

    delay #(.WIDTH(5), .CLOCKS(6)) places_wait (.clk, .enable(1'b1), .in(places_4 | 5'(!full_4)), .out(places_10));
    delay #(.WIDTH(5), .CLOCKS(4)) back_waits (.clk, .enable(1'b1), .in(back_11), .out(back_15));

    assign over = $signed({1'b0, length_17}) - $signed({3'b0, radius_17});

    always_ff @(posedge clk) begin
        square_10  <= doubled_9 ? square_9[35:2] : square_9[33:0];
        doubled_10 <= doubled_9;
        back_11    <= places_10 + 5'(!doubled_10);
        length_16  <= {root_15[35:17], 4'b0} >> {back_15[4:3], 3'b0};
        back_16    <= back_15[2:0];
        length_17  <= length_16 >> back_16;
        distance   <= !over[23] && over[22:21] != '0 ? {1'b0, {21{1'b1}}} : over[21:0];
    end

    wire _unused = &{1'b0, sphere.material, sphere.shift, sphere.inverse, any_8[13:0], any_3[0], by_8, square_9[36], square_10[7:0], root_15[36], root_15[16:0]};
endmodule

`default_nettype wire

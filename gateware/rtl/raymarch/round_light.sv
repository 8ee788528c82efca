// Computes the light on spheres: a colour for each ray that ends on a sphere or fillet (docs/formats/raymarch.md, "Round fields").
//
//   end ─▶ o + T·D ─▶ - centre ─▶ · light ─▶ / radius ─▶ times light's colour, sum ─▶ times the material ─▶ end, colour
//                                   └─────────────── once for each pass ────────────┘
//
// All ends of rays pass in order; the colour for ends on other surfaces is undefined. An end on a sphere or fillet takes one clock for each
// pass, any other end takes one clock. The passes are
// - with NORMALS, and if `lights.normals` is high, one for each axis: their sum is the material's colour;
// - one for each light, if there are any;
// - with HIGHLIGHT, and if `lights.highlight` is high, one for the highlight, with a power of the cosine in place of the cosine.
//
// With CONE, and if `lights.cone` is high, light is only computed for the lateral surface of a solid cone. The centre is then the apex of the
// cone, `lights` contains directions that are adapted to the normals of the cone (`across` and `along` instead of those of the axes), and
// the reciprocal of the distance below the apex replaces the reciprocal of the radius.
//
// With BLEND, the colour is interpolated by `share` between the colour of the face, from `palette`, and the colour of the sphere. Latency
// 24 clocks, 12 more with HIGHLIGHT, 4 more with CONE and 4 more with BLEND, plus one clock for each pass after the first. The ends at the
// output do not include the direction. Streams are valid/ready. Writes and changes of parameters are only allowed while the pipeline is
// empty.

`default_nettype none

module round_light #(
    parameter bit BLEND     = 1'b0,
    parameter bit STEREO    = 1'b1,
    // Whether colours may depend on the normal, and whether there may be a highlight.
    parameter bit NORMALS   = 1'b1,
    parameter bit HIGHLIGHT = 1'b0,
    // Whether there may be a solid cone.
    parameter bit CONE      = 1'b0
) (
    input  wire                      clk,
    input  wire                      rst,
    // Frame. The first sphere may be `repeated` every 64 units along each axis.
    input  wire  [1:0][2:0][24:0]    origins,
    input  wire                      stereo,
    input  wire                      repeated,
    input  wire raymarch_registers_pkg::lights_t lights,
    input  wire  [5:0][23:0]         palette,
    input  wire                      sphere_write,
    input  wire  [2:0]               sphere_number,
    input  wire raymarch_registers_pkg::sphere_t sphere,
    // Ends.
    input  wire                      in_valid,
    output logic                     in_ready,
    input  wire raymarch_pkg::end_t     in_end,
    // Ends with their colours.
    output logic                     out_valid,
    input  wire                      out_ready,
    output raymarch_pkg::end_t          out_end,
    output logic [23:0]              out_colour
);
    // Additional clocks for the reciprocal of a cone and for the highlight. Suffixes of names from 15 on do not count these clocks.
    localparam int unsigned CONE_WAIT  = CONE ? 4 : 0;
    localparam int unsigned SHINE_WAIT = HIGHLIGHT ? 12 : 0;
    localparam int unsigned WAIT       = CONE_WAIT + SHINE_WAIT;
    localparam int unsigned LAST = WAIT + (BLEND ? 26 : 22);
    // Ends without the direction.
    localparam int unsigned ROUND_BITS = raymarch_pkg::EXIT_END_BITS + 1;

    (* ram_style = "distributed" *) logic [68:0] centres [0:7];
    (* ram_style = "distributed" *) logic [4:0]  shifts [0:7];
    (* ram_style = "distributed" *) logic [16:0] inverses [0:7];
    (* ram_style = "distributed" *) logic [23:0] materials [0:7];

    // An end stays in clock 0 for one clock per pass. These signals are the kind of the pass, and its number among the passes of this kind.
    typedef enum logic [1:0] {NORMAL, LIGHT, SHINE} kind_t;

    logic            enable, held_valid, last_0, last_of_kind_0, has_normals, has_highlight;
    raymarch_pkg::end_t held;
    kind_t           kind_0;
    logic [1:0]      number_0;
    logic [LAST:0]   valid;

    assign has_normals   = NORMALS && lights.normals;
    assign has_highlight = HIGHLIGHT && lights.highlight;

    always_comb begin
        unique case (kind_0)
            NORMAL:  last_of_kind_0 = number_0 == 2'd2;
            LIGHT:   last_of_kind_0 = number_0 == lights.last_light;
            default: last_of_kind_0 = 1'b1;
        endcase
        last_0 = last_of_kind_0 && (kind_0 == NORMAL ? !lights.lit : kind_0 == SHINE || !has_highlight);
        if (!held.round || held.state != raymarch_pkg::HIT) last_0 = 1'b1;
    end

    assign in_ready = enable && (!held_valid || last_0);
    assign valid[0] = held_valid && last_0;

    always_ff @(posedge clk) begin
        if (in_ready) begin
            held_valid <= in_valid;
            held       <= in_end;
            number_0   <= '0;
            kind_0     <= has_normals ? NORMAL : LIGHT;
        end else if (enable) begin
            number_0 <= last_of_kind_0 ? '0 : number_0 + 1'b1;
            if (last_of_kind_0) kind_0 <= !HIGHLIGHT || kind_0 == NORMAL ? LIGHT : SHINE;
        end
        if (enable) valid[LAST:1] <= valid[LAST-1:0];

        if (rst) begin
            held_valid    <= 1'b0;
            valid[LAST:1] <= '0;
        end
    end

    // Constants of the sphere. Each constant is read from its memory just before the clock in which it is used.
    logic [2:0]       number_2, number_8, number_11, number_18;
    logic [2:0][22:0] centre_3;
    logic [4:0]       shift_8, shift_9;
    logic [16:0]      inverse_12;
    logic [23:0]      material_19;

    delay #(.WIDTH(3), .CLOCKS(2)) number_to_2 (.clk, .enable, .in(held.surface), .out(number_2));
    delay #(.WIDTH(3), .CLOCKS(6)) number_to_8 (.clk, .enable, .in(number_2), .out(number_8));
    delay #(.WIDTH(3), .CLOCKS(3)) number_to_11 (.clk, .enable, .in(number_8), .out(number_11));
    delay #(.WIDTH(3), .CLOCKS(7 + WAIT)) number_to_18 (.clk, .enable, .in(number_11), .out(number_18));

    always_ff @(posedge clk) begin
        if (sphere_write) begin
            centres[sphere_number]   <= sphere.centre;
            shifts[sphere_number]    <= sphere.shift;
            inverses[sphere_number]  <= sphere.inverse;
            materials[sphere_number] <= sphere.material;
        end
        if (enable) begin
            centre_3    <= centres[number_2];
            repeated_3  <= repeated && number_2 == '0;
            shift_9     <= CONE && lights.cone ? shift_8 : shifts[number_8];
            inverse_12  <= inverses[number_11];
            material_19 <= materials[number_18];
        end
    end

    // The suffix of a name is the signal's clock: 3 for the point where the ray ends; 4 for the point relative to the sphere's centre, and
    // for the direction of the light.
    logic              eye_2, repeated_3;
    logic [1:0]        light_3, light_14;
    kind_t             kind_3, kind_9, kind_14, kind_17, kind_18;
    logic              first_17;
    logic [2:0][22:0]  apart_4;
    logic [53:0]       towards_3;
    logic [2:0][17:0]  towards_4;
    logic [215:0]      directions;
    logic [95:0]       colours;

    assign directions = lights.directions;
    assign colours    = lights.colours;

    always_comb begin
        unique case (light_3)
            2'd0: towards_3 = directions[53:0];
            2'd1: towards_3 = directions[107:54];
            2'd2: towards_3 = directions[161:108];
            2'd3: towards_3 = directions[215:162];
        endcase
        if (HIGHLIGHT && kind_3 == SHINE) towards_3 = lights.half;
        // The unit vector of the axis with this number.
        if (NORMALS && kind_3 == NORMAL)
            towards_3 = {1'b0, light_3 == 2'd2, 16'b0, 1'b0, light_3 == 2'd1, 16'b0, 1'b0, light_3 == 2'd0, 16'b0};
        if (CONE && NORMALS && kind_3 == NORMAL && lights.cone)
            towards_3 = {lights.along & {18{light_3 == 2'd2}}, lights.across & {18{light_3 == 2'd1}}, lights.across & {18{light_3 == 2'd0}}};
    end

    delay #(.WIDTH(1), .CLOCKS(2)) eyes (.clk, .enable, .in(STEREO && held.place.eye), .out(eye_2));
    delay #(.WIDTH(2), .CLOCKS(3)) light_to_3 (.clk, .enable, .in(number_0), .out(light_3));
    delay #(.WIDTH(2), .CLOCKS(11 + WAIT)) light_to_14 (.clk, .enable, .in(light_3), .out(light_14));
    delay #(.WIDTH(1), .CLOCKS(3)) first_to_17 (.clk, .enable, .in(light_14 == '0), .out(first_17));

    if (NORMALS || HIGHLIGHT) begin : kinds
        delay #(.WIDTH(2), .CLOCKS(3)) kind_to_3 (.clk, .enable, .in(kind_0), .out({kind_3}));
        delay #(.WIDTH(2), .CLOCKS(6)) kind_to_9 (.clk, .enable, .in(kind_3), .out({kind_9}));
        delay #(.WIDTH(2), .CLOCKS(5 + WAIT)) kind_to_14 (.clk, .enable, .in(kind_9), .out({kind_14}));
        delay #(.WIDTH(2), .CLOCKS(3)) kind_to_17 (.clk, .enable, .in(kind_14), .out({kind_17}));
        delay #(.WIDTH(2), .CLOCKS(1)) kind_to_18 (.clk, .enable, .in(kind_17), .out({kind_18}));
    end else begin : lights_alone
        assign {kind_3, kind_9, kind_14, kind_17, kind_18} = {5{LIGHT}};
        wire _unused = &{1'b0, kind_3, kind_9, kind_14, kind_17, kind_18};
    end

    // 10 of T's fraction bits are used.
    for (genvar i = 0; i < 3; i++) begin : axes
        logic signed [raymarch_pkg::WIDE_BITS+14:0] sum;
        logic [raymarch_pkg::WIDE_BITS-1:0]         origin;
        logic [22:0]                             apart;

        assign origin = eye_2 ? origins[1][i] : origins[0][i];
        multiply_add #(.BITS(raymarch_pkg::WIDE_BITS + 15)) place (
            .clk, .enable, .a({1'b0, held.t[27:4]}), .b(held.direction[i]), .c({origin, 15'b0}), .p(sum)
        );
        assign apart = sum[37:15] - centre_3[i];

        always_ff @(posedge clk) begin
            if (enable) begin
                apart_4[i]   <= repeated_3 ? {{5{apart[17]}}, apart[17:0]} : apart;
                towards_4[i] <= towards_3[18*i +: 18];
            end
        end

        wire _unused = &{1'b0, sum[raymarch_pkg::WIDE_BITS+14:38], sum[14:0]};
    end

    // The suffix of a name is the signal's clock: 9 for the scalar product of the light's direction and the vector from the sphere's
    // centre to the point; 11 for this product, shifted right; 12 for the shifted product, saturated to 17 bits.
    logic [22:0]        apart_y_5, apart_z_6;
    logic [17:0]        towards_y_5, towards_z_6;
    logic signed [42:0] x_7, x_y_8, product_9;
    logic [40:4]        product_size;
    logic [36:0]        by_fours, shifted_11;
    logic [1:0]         ones_10;
    logic [16:0]        size_12;

    delay #(.WIDTH(41), .CLOCKS(1)) y_waits (.clk, .enable, .in({apart_4[1], towards_4[1]}), .out({apart_y_5, towards_y_5}));
    delay #(.WIDTH(41), .CLOCKS(2)) z_waits (.clk, .enable, .in({apart_4[2], towards_4[2]}), .out({apart_z_6, towards_z_6}));
    multiply_add #(.BITS(43)) along_x (
        .clk, .enable, .a(25'($signed(apart_4[0]))), .b(towards_4[0]), .c('0), .p(x_7)
    );
    multiply_add #(.BITS(43)) along_y (
        .clk, .enable, .a(25'($signed(apart_y_5))), .b(towards_y_5), .c(x_7), .p(x_y_8)
    );
    multiply_add #(.BITS(43)) along_z (
        .clk, .enable, .a(25'($signed(apart_z_6))), .b(towards_z_6), .c(x_y_8), .p(product_9)
    );

    // For a negative component of a normal, the complement is shifted and multiplied instead.
    logic negative_9, negative_15;

    assign negative_9   = NORMALS && kind_9 == NORMAL && product_9[42];
    assign product_size = product_9[40:4] ^ {37{negative_9}};
    delay #(.WIDTH(1), .CLOCKS(6 + CONE_WAIT)) sign_waits (.clk, .enable, .in(negative_9), .out(negative_15));

    always_ff @(posedge clk) begin
        if (enable) begin
            // The shift is 6 to 21. A light behind the surface contributes 0.
            unique case (shift_9[4:2])
                3'd1:    by_fours <= product_size[40:4];
                3'd2:    by_fours <= 37'(product_size[40:8]);
                3'd3:    by_fours <= 37'(product_size[40:12]);
                3'd4:    by_fours <= 37'(product_size[40:16]);
                default: by_fours <= 37'(product_size[40:20]);
            endcase
            if (product_9[42] && !negative_9) by_fours <= '0;
            ones_10    <= shift_9[1:0];
            shifted_11 <= by_fours >> ones_10;
            size_12    <= shifted_11[16:0] | {17{shifted_11[36:17] != '0}};
        end
    end

    // The suffix of a name is the signal's clock: 15 for the cosine of the angle between normal and light, in 256ths; 18 for the sum over
    // the lights; 19 for the sum, saturated at 255.
    logic signed [36:0] cosine_15;
    logic signed [9:0]  share_of_cosine, share_15;
    logic [23:0]        colour_15;
    logic [2:0][7:0]    colour_22, colour_last, face_colour_22;

    // The factors of the cosine. The suffix of a name in `solid_cone` is the signal's clock: 5 for the distance below the apex, 6 for its
    // logarithm, 15 for its reciprocal.
    logic [16:0] size, inverse;

    if (CONE) begin : solid_cone
        logic [22:0] below_5, mantissa_15;
        logic [4:0]  log_5, log_6, shift_7, exponent_15;
        logic signed [5:0] less_6;
        logic [16:0] inverse_15;
        logic        odd_15, low_15;

        always_comb begin
            log_5 = '0;
            for (int i = 0; i < 23; i++) if (below_5[i]) log_5 = 5'(i);
        end
        assign less_6 = $signed({1'b0, log_6}) - $signed({2'b0, lights.lead});

        always_ff @(posedge clk) begin
            if (enable) begin
                below_5 <= apart_4[2][22] ? -apart_4[2] : 23'd1;
                log_6   <= log_5;
                shift_7 <= less_6 < 6'sd6 ? 5'd6 : less_6 > 6'sd21 ? 5'd21 : less_6[4:0];
                shift_8 <= shift_7;
                inverse <= !lights.cone ? inverse_15 : low_15 ? mantissa_15[22:6] : mantissa_15[21:5] | {17{mantissa_15[22]}};
            end
        end
        exit_mantissa reciprocal (
            .clk, .enable, .whole({2'b0, below_5, 3'b0}), .mantissa(mantissa_15), .exponent(exponent_15)
        );
        // If a mantissa below 3/4 has been doubled, the parity of its exponent is inverted.
        assign low_15 = exponent_15[0] == odd_15;
        delay #(.WIDTH(1), .CLOCKS(9)) parity_waits (.clk, .enable, .in(log_6[0]), .out(odd_15));
        delay #(.WIDTH(17), .CLOCKS(3)) inverse_waits (.clk, .enable, .in(inverse_12), .out(inverse_15));
        delay #(.WIDTH(17), .CLOCKS(4)) size_waits (.clk, .enable, .in(size_12), .out(size));

        wire _unused = &{1'b0, exponent_15[4:1], mantissa_15[4:0]};
    end else begin : spheres_alone
        assign size    = size_12;
        assign inverse = inverse_12;
        assign shift_8 = '0;
        wire _unused = &{1'b0, lights.cone, lights.lead, lights.across, lights.along, shift_8};
    end

    multiply_add #(.BITS(37)) over_radius (
        .clk, .enable, .a({8'b0, size}), .b({1'b0, inverse}), .c('0), .p(cosine_15)
    );
    assign share_of_cosine = {1'b0, cosine_15[33], cosine_15[33] ? 8'd0 : cosine_15[32:25]} ^ {10{negative_15}};

    // The suffix of a name is the signal's clock: 16 for 1 - cosine; 20 for x = 1 - steepness·(1 - cosine), at least 0; 27 for x^4.
    if (HIGHLIGHT) begin : highlight
        logic [15:0]        below_16, x_20, square_23;
        logic signed [29:0] scaled_19;
        logic signed [33:0] product_23, fourth_26;
        logic [7:0]         fourth;
        logic [8:0]         part_27;
        logic signed [9:0]  waited_27;
        kind_t              kind_27;

        multiply_add #(.BITS(30)) scale (
            .clk, .enable, .a({9'b0, below_16}), .b({5'b0, lights.steepness}), .c('0), .p(scaled_19)
        );
        multiply_add #(.BITS(34)) square (.clk, .enable, .a({9'b0, x_20}), .b({2'b0, x_20}), .c('0), .p(product_23));
        multiply_add #(.BITS(34)) square_again (.clk, .enable, .a({9'b0, square_23}), .b({2'b0, square_23}), .c('0), .p(fourth_26));

        assign square_23 = product_23[31:16];
        assign fourth    = fourth_26[31:24];

        always_ff @(posedge clk) begin
            if (enable) begin
                below_16 <= ~cosine_15[32:17] & {16{!cosine_15[33]}};
                x_20     <= ~scaled_19[23:8] & {16{scaled_19[29:24] == '0}};
                part_27  <= {1'b0, fourth} + 9'(fourth[7]);
            end
        end

        delay #(.WIDTH(10), .CLOCKS(SHINE_WAIT)) share_waits (.clk, .enable, .in(share_of_cosine), .out(waited_27));
        // `kind_14` is delayed by the same number of clocks.
        delay #(.WIDTH(2), .CLOCKS(1)) kind_to_27 (.clk, .enable, .in(kind_14), .out({kind_27}));
        assign share_15 = kind_27 == SHINE ? {1'b0, part_27} : waited_27;

        wire _unused = &{1'b0, scaled_19[7:0], product_23[33:32], product_23[15:0], fourth_26[33:32], fourth_26[23:0]};
    end else begin : no_highlight
        assign share_15 = share_of_cosine;
        wire _unused = &{1'b0, lights.half, lights.steepness, lights.shine, lights.highlight};
    end

    // Contribution of a component of the normal to its own channel; with two eyes, the luminance of this contribution in every channel.
    localparam logic [7:0] SLOPE = 8'd95, MIDDLE = 8'd130;

    always_ff @(posedge clk) begin
        if (enable) begin
            unique case (light_14)
                2'd0: colour_15 <= colours[23:0];
                2'd1: colour_15 <= colours[47:24];
                2'd2: colour_15 <= colours[71:48];
                2'd3: colour_15 <= colours[95:72];
            endcase
            if (HIGHLIGHT && kind_14 == SHINE) colour_15 <= lights.shine;
            if (NORMALS && kind_14 == NORMAL) begin
                if (STEREO && stereo) colour_15 <= {3{light_14[1] ? 8'd11 : light_14[0] ? 8'd56 : 8'd29}};
                else colour_15 <= {light_14[1] ? SLOPE : 8'd0, light_14[0] ? SLOPE : 8'd0, light_14 == '0 ? SLOPE : 8'd0};
            end
        end
    end

    for (genvar i = 0; i < 3; i++) begin : channels
        logic signed [25:0] sum_18, coloured;
        logic [7:0]         ambient, begins_17, light, shine_21, colour_19;
        logic [8:0]         light_19;

        assign ambient   = lights.ambient[8*i +: 8];
        assign begins_17 = NORMALS && kind_17 == NORMAL ? MIDDLE : HIGHLIGHT && kind_17 == SHINE ? 8'd0 : ambient;

        multiply_add #(.BITS(26)) shine (
            .clk, .enable, .a({17'b0, colour_15[8*i +: 8]}), .b(18'(share_15)), .c(first_17 ? {10'b0, begins_17, 8'b0} : sum_18), .p(sum_18)
        );
        assign light = sum_18[15:8] | {8{sum_18[25:16] != '0}};

        // The passes of an end follow each other. The sum of the lights is kept for the pass of the highlight, and the material's
        // colour for the passes of the lights. Without lights, the only light is the ambient light.
        always_ff @(posedge clk)
            if (enable && !(HIGHLIGHT && kind_18 == SHINE))
                light_19 <= NORMALS && kind_18 == NORMAL ? {1'b0, ambient} + 9'(ambient[7]) : {1'b0, light} + 9'(light[7]);

        if (NORMALS) begin : material
            logic [7:0] base_19;
            always_ff @(posedge clk) if (enable && kind_18 == NORMAL) base_19 <= light;
            assign colour_19 = has_normals ? base_19 : material_19[8*i +: 8];
        end else begin : material
            assign colour_19 = material_19[8*i +: 8];
        end

        if (HIGHLIGHT) begin : shining
            logic [7:0] shine_19;
            always_ff @(posedge clk) if (enable) shine_19 <= kind_18 == SHINE ? light : '0;
            delay #(.WIDTH(8), .CLOCKS(2)) shine_waits (.clk, .enable, .in(shine_19), .out(shine_21));
        end else begin : shining
            assign shine_21 = '0;
        end

        multiply_add #(.BITS(26)) on_material (
            .clk, .enable, .a({17'b0, colour_19}), .b({9'b0, light_19}), .c({10'b0, shine_21, 8'b0}), .p(coloured)
        );
        assign colour_22[i] = coloured[15:8] | {8{HIGHLIGHT && coloured[16]}};

        wire _unused = &{1'b0, sum_18[7:0], coloured[25:16], coloured[7:0]};
    end

    // The suffix of a name is the signal's clock: 22 for the colour of the face; 23 for its difference from the sphere's colour; 26 for the
    // interpolation between both colours by `share`.
    if (BLEND) begin : between
        logic [2:0]      face_21;
        logic [7:0]      share_22;
        logic [8:0]      part_23;

        delay #(.WIDTH(3), .CLOCKS(21 + WAIT)) face_waits (.clk, .enable, .in(held.face), .out(face_21));
        delay #(.WIDTH(8), .CLOCKS(22 + WAIT)) share_waits (.clk, .enable, .in(held.share), .out(share_22));

        always_ff @(posedge clk) begin
            if (enable) begin
                unique case (face_21)
                    3'd0:    face_colour_22 <= palette[0];
                    3'd1:    face_colour_22 <= palette[1];
                    3'd2:    face_colour_22 <= palette[2];
                    3'd3:    face_colour_22 <= palette[3];
                    3'd4:    face_colour_22 <= palette[4];
                    default: face_colour_22 <= palette[5];
                endcase
                part_23 <= {1'b0, share_22} + 9'(share_22[7]);
            end
        end

        for (genvar i = 0; i < 3; i++) begin : mixed
            logic signed [8:0]  way_23;
            logic [7:0]         from_23, from_25;
            logic signed [24:0] sum_26;

            always_ff @(posedge clk) begin
                if (enable) begin
                    way_23  <= $signed({1'b0, colour_22[i]}) - $signed({1'b0, face_colour_22[i]});
                    from_23 <= face_colour_22[i];
                end
            end
            delay #(.WIDTH(8), .CLOCKS(2)) from_waits (.clk, .enable, .in(from_23), .out(from_25));
            multiply_add #(.BITS(25)) mix (
                .clk, .enable, .a(25'(way_23)), .b({9'b0, part_23}), .c({9'b0, from_25, 8'h80}), .p(sum_26)
            );
            assign colour_last[i] = sum_26[15:8];

            wire _unused = &{1'b0, sum_26[24:16], sum_26[7:0]};
        end
    end else begin : one_or_the_other
        assign colour_last    = colour_22;
        assign face_colour_22 = '0;
        wire _unused = &{1'b0, palette, held, face_colour_22};
    end

    logic [ROUND_BITS-1:0] kept_last, kept;

    delay #(.WIDTH(ROUND_BITS), .CLOCKS(LAST)) end_waits (.clk, .enable, .in(held[ROUND_BITS-1:0]), .out(kept_last));

    skid_buffer #(.WIDTH(ROUND_BITS + 24)) leaving (
        .clk, .rst, .in_valid(valid[LAST]), .in_ready(enable), .in_data({kept_last, colour_last}),
        .out_valid, .out_ready, .out_data({kept, out_colour})
    );

    assign out_end = raymarch_pkg::END_BITS'(kept);

    wire _unused = &{1'b0, sphere.radius, product_9[41], product_9[3:0], cosine_15[36:34], cosine_15[24:0]};
endmodule

`default_nettype wire

// Culling, setup and flat shading of triangles: computes a descriptor from three vertices on the screen (docs/formats/triangle.md,
// "Triangle setup"). The *start* is the pixel for which a descriptor_t contains the values of the edge functions and of the depth.
//
//         3 clocks per triangle          11 clocks per triangle, numbered by `count`
//   in ─▶│ cull: area, facing, bounds │─▶│ 1 edges, normal, 1/a, shade │ 2 E1, 1/a │ 3 gradients │ 4 depth │─▶ out
//            └▶ culled
//
// Throughput: one drawn triangle per 11 clocks, or 33 with smooth shading, one culled triangle per 3; latency at most 86 clocks,
// or 196. A beat is the time in which each of the stages 1 to 4 processes one triangle: 11 clocks, numbered by `count`, or more if the last
// clock is repeated because the light takes longer or stage 4 waits for the output. All stages move together in the last clock of a beat,
// even empty stages, so a triangle passes through the stages even if no triangle follows. A culled triangle leaves before stage 1. A culled
// triangle only waits for earlier triangles if the FIFO at the end of `cull` is full. `culled` and `drawn` are high for one clock for each
// triangle, `drawn` together with the triangle's descriptor. The frame's constants (`width`, `height`, `cull_back`, `mirror`, `row_light`,
// `light_colour`, `ambient`, `smooth`) must hold while `busy` is high and in the clock in which a triangle enters.
//
// E0, E1 and E2 are the edge functions, A is the area, and (px, py) is the start relative to vertex 0. Edges 0 and 2 meet in
// vertex 0, so both are evaluated from (px, py). Edge 1 follows from E0 + E1 + E2 = 2A = a. This equation holds at every point: the
// differences of the three vertices add up to 0, so the sum does not depend on the point, and at vertex 0 the sum is E1.
//
// With TEXTURE, in a frame with the flag `textures`, each texture coordinate has a plane. Such a frame has flat shading and beats of
// three rounds, as explained below; the first round prepares the coordinate s.
//
// With SMOOTH, each channel of light has a plane, a linear function on the screen like the depth. Stage 1 computes the values P of the
// plane at the vertices (docs/formats/triangle.md, "Smooth shading"). The channels then pass through one datapath in turn, in rounds of 11
// clocks; a beat of a frame with smooth shading has three rounds:
//
//   beat           2                       3                       4
//   round          0       1       2       0       1       2
//   normal         red     green   blue
//   gradients              red     green   blue
//   start                          red     green   blue            ─▶ out_planes

`default_nettype none

module setup #(
    // Number of the last clock of a beat. A beat is the time of a triangle in a stage. The formal proof of the control uses a smaller
    // number.
    parameter bit [3:0] LAST = 4'd10,
    parameter bit SMOOTH = 1'b0,
    parameter bit TEXTURE = 1'b0,
    localparam int unsigned LIGHT_BITS  = triangle_pkg::vertex_bits(SMOOTH, TEXTURE),
    localparam int unsigned LIT_BITS    = SMOOTH || TEXTURE ? 1 + 3 * LIGHT_BITS : 1,
    localparam int unsigned PLANES_BITS = triangle_pkg::planes_bits(SMOOTH, TEXTURE)
) (
    input  wire              clk,
    input  wire              rst,
    input  wire  [10:0]      width,
    input  wire  [9:0]       height,
    input  wire              cull_back,
    input  wire              mirror,
    input  wire  [2:0][24:0] row_light,   // row of the light, s2.23
    input  wire  [2:0][8:0]  light_colour, // u1.8, red is the lowest
    input  wire  [2:0][8:0]  ambient,
    input  wire              smooth,
    input  wire              textures,    // texture coordinates have planes; not with `smooth`
    input  wire              linear,      // orthographic projection
    output logic             busy,
    output logic             culled,
    output logic             drawn,
    input  wire              in_valid,
    output logic             in_ready,
    input  wire  [2:0][65:0] in_vertices, // screen_vertex_t each, numbered as in the mesh
    input  wire  [15:0]      in_colour,   // RGB565
    input  wire  [2:0][15:0] in_normal,   // s2.14
    input  wire  [2:0][LIGHT_BITS-1:0] in_light,
    input  wire  [TEXTURE ? 7 : 0:0] in_texture, // number of the texture, 0: none
    output logic             out_valid,
    input  wire              out_ready,
    output records_pkg::descriptor_t out_descriptor,
    output logic [PLANES_BITS-1:0]    out_planes
);
    // Values that pass through all stages unchanged; x21 and y12 are the steps of edge 1.
    typedef struct packed {
        logic [7:0]  group_start, group_right, group_left;
        logic [9:0]  bottom, top;
        logic [20:0] x21, y12, y20, x02, y01, x10;
    } passed_t;

    // Depth of vertex 0, and the centre of the start pixel relative to vertex 0, for the depth plane.
    typedef struct packed {
        logic [23:0] w0;
        logic [20:0] px, py;
    } origin_t;

    // `beat` is high in the last clock of a beat, `enable` is low while the last clock is repeated. Both signals are registers, whose
    // values are computed one clock ahead: `ending` is high if the next clock has the last count, `light_ends` if the light is also ready
    // in the next clock. The registers of a stage have copies of `beat`.
    logic [3:0] count;
    logic       enable, beat, ending, light_ends, beat_comes, waits;
    logic [4:1] valid;

    assign ending     = !beat && (count == LAST || count == LAST - 1'b1);
    assign waits      = valid[4] && out_valid && !out_ready;
    assign beat_comes = ending && light_ends && !waits;

    setup_pkg::oriented_t     first;
    logic [LIT_BITS-1:0]      first_lit;
    logic                     first_valid, cull_busy;
    logic [TEXTURE ? 7 : 0:0] first_texture;
    logic                     textured_2;
    logic [2:0][7:0]          light_2;

    cull #(.SMOOTH(SMOOTH), .TEXTURE(TEXTURE)) cull_stage (
        .clk, .rst, .width, .height, .cull_back, .mirror, .busy(cull_busy), .culled,
        .in_valid, .in_ready, .in_vertices, .in_colour, .in_normal, .in_light,
        .out_valid(first_valid), .out_ready(beat), .out_triangle(first), .out_lit(first_lit), .in_texture, .out_texture(first_texture)
    );

    always_ff @(posedge clk) begin
        beat   <= beat_comes;
        enable <= !ending || beat_comes;
        if (beat) begin
            count <= '0;
            valid <= {valid[3:1], first_valid};
        end else if (count != LAST) begin
            count <= count + 1'b1;
        end
        if (rst) begin
            beat   <= 1'b0;
            enable <= 1'b1;
            count  <= '0;
            valid  <= '0;
        end
    end

    // Stage 1. Returns the bias of an edge (docs/formats/triangle.md, "Triangle setup"): 1 if the edge is neither top nor left.
    // `right_to_left` is the sign of the edge's step_y. Both steps are 0 only for an edge of length 0.
    function automatic logic bias(input logic [20:0] step_x, input logic right_to_left);
        bias = step_x[20] || step_x == '0 && right_to_left;
    endfunction

    setup_pkg::oriented_t t;
    origin_t              origin_1;
    logic                 bias_0, bias_1, bias_2;
    logic [41:0]          e0, e2;
    logic [45:0]          nx, ny;
    logic [23:0]          m, y;
    logic [5:0]           lead;
    logic [15:0]          colour_2, lit_2;
    logic [20:0]          sum_x, sum_y;
    logic                 reciprocal_ready, reciprocal_done;
    passed_t              passed_1;

    origin_t first_origin;

    assign first_origin.w0 = first.w0;
    assign first_origin.px = {2'b0, first.group_start, 11'h080} - first.x0;
    assign first_origin.py = {3'b0, first.top, 8'h80} - first.y0;

    wide_register #(.WIDTH($bits(t) + $bits(origin_1) + 2)) stage_1 (
        .clk, .next(beat_comes),
        .in({first, first_origin, bias(first.y01, first.x10[20]), bias(first.y20, first.x02[20])}),
        .out({t, origin_1, bias_0, bias_2})
    );

    always_ff @(posedge clk) begin
        // The steps of the three edges add up to 0, so these sums are the negated steps of edge 1. They are constant from the
        // second clock of a beat on.
        sum_x <= t.y01 + t.y20;
        sum_y <= t.x10 + t.x02;
    end

    assign bias_1   = sum_x == '0 ? !sum_y[20] : !sum_x[20];
    assign passed_1 = {t.group_start, t.group_right, t.group_left, t.bottom, t.top, -sum_y, -sum_x, t.y20, t.x02, t.y01, t.x10};

    setup_edges edges (
        .clk, .enable, .count, .px(origin_1.px), .py(origin_1.py), .x10(t.x10), .y01(t.y01), .x02(t.x02), .y20(t.y20),
        .bias0(bias_0), .bias2(bias_2), .e0, .e2
    );
    setup_normal normal (
        .clk, .enable, .count, .w10(~t.not_w10), .w20(~t.not_w20), .x10(t.x10), .y01(t.y01), .x02(t.x02), .y20(t.y20), .nx, .ny
    );
    flat_shade #(.TEXTURE(TEXTURE)) shade (
        .clk, .enable, .count, .row_light, .light_colour, .ambient, .front(t.front), .normal(t.normal), .colour(colour_2),
        .lit(lit_2), .textured(textured_2), .light(light_2)
    );
    // The computation of the area's reciprocal starts in clock 3 of stage 1. The reciprocal is valid from clock 7 of stage 2 on, or earlier
    // in stage 2 if the beat of stage 1 is longer than 11 clocks.
    normalise normalised (.clk, .in(t.area), .m, .lead);
    reciprocal reciprocal_of_area (
        .clk, .rst, .in_valid(count == 4'd3), .in_ready(reciprocal_ready), .in_m(m),
        .out_valid(reciprocal_done), .out_y(y)
    );

    // Stage 2 computes (E1 − bias)/2^8, where E1 − bias = a − (E0 − bias) − (E2 − bias) − (the sum of the three biases). Of the lowest 8
    // bits only the carry is kept. The last products of flat shading are computed at the same time.
    passed_t            passed_2;
    origin_t            origin_2;
    logic        [45:0] nx_2, ny_2;
    logic        [5:0]  lead_2;
    logic        [23:0] y_2;
    logic        [41:0] e0_2, e2_2;
    logic        [7:0]  area_low;
    logic        [1:0]  biases;
    logic        [33:0] e1, addend;
    logic        [10:0] low_sum;
    logic        [2:0]  carry;

    assign low_sum = {3'b0, area_low} - {3'b0, e0_2[7:0]} - {3'b0, e2_2[7:0]} - {9'b0, biases};

    always_ff @(posedge clk) begin
        // Each negation is −e = ~e + 1. The 1s of both negations are added to the carry.
        carry <= low_sum[10:8] + 3'd2;
        unique case (count)
            4'd0:    addend <= ~e0_2[41:8];
            4'd1:    addend <= ~e2_2[41:8];
            default: addend <= 34'($signed(carry));
        endcase
        if (count == 4'd8) y_2 <= y;
        if (beat) e1 <= {2'b0, t.area[39:8]};
        else if (count == 4'd1 || count == 4'd2 || count == 4'd3)
            e1 <= e1 + addend;
    end

    wide_register #(.WIDTH($bits(passed_1) + $bits(origin_1) + 2 * 46 + 6 + 16 + 2 * 42 + 8 + 2)) stage_2 (
        .clk, .next(beat_comes),
        .in({passed_1, origin_1, nx, ny, lead, t.colour, e0, e2, t.area[7:0], {1'b0, bias_0} + {1'b0, bias_1} + {1'b0, bias_2}}),
        .out({passed_2, origin_2, nx_2, ny_2, lead_2, colour_2, e0_2, e2_2, area_low, biases})
    );

    // Stage 3.
    passed_t            passed_3;
    origin_t            origin_3;
    logic        [5:0]  lead_3;
    logic        [23:0] y_3;
    logic        [15:0] lit_3;
    logic [2:0][33:0]   start_3;

    wide_register #(.WIDTH($bits(passed_1) + $bits(origin_1) + 6 + 24 + 16 + 3 * 34)) stage_3 (
        .clk, .next(beat_comes), .in({passed_2, origin_2, lead_2, y_2, lit_2, e2_2[41:8], e1, e0_2[41:8]}),
        .out({passed_3, origin_3, lead_3, y_3, lit_3, start_3})
    );

    // Stage 4.
    passed_t            passed_4;
    origin_t            origin_4;
    logic        [31:0] step_x, step_y;
    logic        [15:0] lit_4;
    logic [2:0][33:0]   start_4;
    logic        [31:0] depth_start;

    wide_register #(.WIDTH($bits(passed_1) + $bits(origin_1) + 16 + 3 * 34)) stage_4 (
        .clk, .next(beat_comes), .in({passed_3, origin_3, lit_3, start_3}), .out({passed_4, origin_4, lit_4, start_4})
    );

    setup_plane depth (
        .clk, .next(beat_comes), .count, .nx(nx_2), .ny(ny_2), .y(y_3), .lead(lead_3),
        .px(origin_4.px), .py(origin_4.py), .value(origin_4.w0), .step_x, .step_y, .start(depth_start)
    );

    // Planes of light, one channel after the other. `round_ends` is high in the last clock of a round, and `light_enable` low
    // while the last clock of the last round is repeated. In a frame with flat shading a beat has one round, whose results are not
    // used.
    if (SMOOTH || TEXTURE) begin : light
        // The following signals are vectors, because Yosys does not support arrays here.
        logic [LIT_BITS-1:0]   lit_1;
        localparam int unsigned BITS = triangle_pkg::LIGHT_BITS;

        logic [3*BITS-1:0]     lights;
        logic [1:0]            place;
        logic [16:0]           share;
        logic                  is_coordinate;
        logic [3*96-1:0]       planes, planes_4;
        logic [3:0]            light_count;
        logic [1:0]            round;
        logic                  light_enable, round_ends, round_comes, last_round;

        assign last_round  = round == 2'd2 || !smooth && !(TEXTURE && textures);
        assign round_comes = light_count == LAST - 1'b1 && !last_round || beat_comes;
        assign light_ends  = last_round && (light_count == LAST || light_count == LAST - 1'b1);

        always_ff @(posedge clk) begin
            light_enable <= !(ending && light_ends) || beat_comes;
            round_ends   <= round_comes;
            if (beat || round_ends) begin
                light_count <= '0;
                round       <= beat ? '0 : round + 1'b1;
            end else if (light_count != LAST) begin
                light_count <= light_count + 1'b1;
            end
            if (rst) begin
                light_enable <= 1'b1;
                round_ends   <= 1'b0;
                light_count  <= '0;
                round        <= '0;
            end
        end

        wide_register #(.WIDTH(LIT_BITS)) lit_stage (.clk, .next(beat_comes), .in(first_lit), .out(lit_1));

        // Inputs for the normal of the channel of this round.
        logic [24:0] w10, w20;
        logic [23:0] value;

        setup_light #(.TEXTURE(TEXTURE)) products (
            .clk, .count(light_count), .round, .next(round_comes), .w0(origin_1.w0), .w10(~t.not_w10), .w20(~t.not_w20),
            .front(t.front), .swap(lit_1[LIT_BITS-1]), .lights, .is_coordinate, .linear, .share, .place, .value, .p10(w10), .p20(w20)
        );

        // The gradients of a triangle are computed in three rounds from round 1 on, and its starts in three rounds from round 2 on.
        (* keep *) logic [23:0] value_3, value_4;
        logic [23:0] light_y;
        logic [5:0]  light_lead;
        logic [20:0] px, py;
        logic [45:0] light_nx, light_ny;
        logic [31:0] light_step_x, light_step_y, light_start;

        always_ff @(posedge clk) begin
            if (round_ends) begin
                value_3 <= value;
                value_4 <= value_3;
                planes  <= {light_step_y, light_step_x, light_start, planes[96 +: 2*96]};
            end
            if (round_ends && round == 2'd0) {light_y, light_lead} <= {y_2, lead_2};
            if (round_ends && round == 2'd1) {px, py} <= {origin_2.px, origin_2.py};
        end

        wide_register #(.WIDTH(3 * 96)) planes_stage (.clk, .next(beat_comes), .in(planes), .out(planes_4));
        logic [PLANES_BITS-1:0] all_planes;

        wide_register #(.WIDTH(PLANES_BITS)) planes_result (
            .clk, .next(beat_comes && valid[4]), .in(all_planes), .out(out_planes)
        );

        for (genvar i = 0; i < 3; i++) begin : vertices
            if (SMOOTH) begin : lit_vertices
                assign lights[BITS * i +: BITS] = lit_1[LIGHT_BITS * i +: BITS];
            end else begin : flat_vertices
                assign lights[BITS * i +: BITS] = '0;
            end
        end

        // In a frame with textures, rounds 1 and 2 process the coordinates s and t. The shares of a coordinate
        // are prepared in the previous round.
        if (TEXTURE) begin : textures_built
            logic [3*32-1:0]  coordinates;
            logic [3:0]       range, periods;
            logic [7:0]       range_s, number_1;
            logic [23:0]      of_triangle, of_triangle_2, of_triangle_3, light_3;
            logic [47:0]      of_triangle_4;
            records_pkg::texture_planes_t texture;

            assign is_coordinate = textures && round != 2'd0;

            for (genvar i = 0; i < 3; i++) begin : coordinates_of
                assign coordinates[32 * i +: 32] = lit_1[LIGHT_BITS * (i + 1) - (round[0] ? 32 : 64) +: 32];
            end

            setup_texture shares (
                .clk, .count(light_count), .next(round_comes), .coordinates, .vertex(place), .share, .range, .periods
            );

            // The values of t are stored in the last round, and the values of s in the round before.
            always_ff @(posedge clk) if (round_ends && round == 2'd1) range_s <= {periods, range};

            assign of_triangle = {number_1, periods, range_s[7:4], range, range_s[3:0]};
            assign textured_2  = textures && of_triangle_2[23:16] != '0;

            wide_register #(.WIDTH(8)) texture_1 (.clk, .next(beat_comes), .in(first_texture), .out(number_1));
            wide_register #(.WIDTH(24)) texture_2 (.clk, .next(beat_comes), .in(of_triangle), .out(of_triangle_2));
            wide_register #(.WIDTH(24)) texture_3 (.clk, .next(beat_comes), .in(of_triangle_2), .out(of_triangle_3));
            wide_register #(.WIDTH(24)) light_stage (.clk, .next(beat_comes), .in(light_2), .out(light_3));
            wide_register #(.WIDTH(48)) texture_4 (.clk, .next(beat_comes), .in({light_3, of_triangle_3}), .out(of_triangle_4));

            always_comb begin
                {texture.light, texture.texture, texture.periods, texture.range} = of_triangle_4;
                texture.linear = linear;
                texture.planes = planes_4[96 +: 192];
                if (!textures) texture.texture = '0;
            end

            if (SMOOTH) begin : both
                assign all_planes = {texture[240:192], smooth, texture[191:0], planes_4};
            end else begin : alone
                assign all_planes = texture;

                wire _unused = &{1'b0, planes_4[95:0]};
            end
        end else begin : no_texture
            assign {is_coordinate, share, textured_2} = '0;
            assign all_planes = {smooth, planes_4};

            wire _unused = &{1'b0, first_texture, place, light_2, textures, linear};
        end

        setup_normal light_normal (
            .clk, .enable(light_enable), .count(light_count), .w10, .w20,
            .x10(passed_2.x10), .y01(passed_2.y01), .x02(passed_2.x02), .y20(passed_2.y20), .nx(light_nx), .ny(light_ny)
        );
        setup_plane plane (
            .clk, .next(round_comes), .count(light_count), .nx(light_nx), .ny(light_ny), .y(light_y), .lead(light_lead),
            .px, .py, .value(value_4), .step_x(light_step_x), .step_y(light_step_y), .start(light_start)
        );
    end else begin : flat
        assign light_ends = 1'b1;
        assign out_planes = '0;
        assign textured_2 = 1'b0;

        wire _unused = &{1'b0, smooth, textures, linear, first_lit, first_texture, light_2};
    end

    records_pkg::descriptor_t descriptor;

    always_comb begin
        descriptor              = '0;
        descriptor.colour       = lit_4;
        descriptor.group_start  = passed_4.group_start;
        descriptor.group_right  = passed_4.group_right;
        descriptor.group_left   = passed_4.group_left;
        descriptor.bottom       = passed_4.bottom;
        descriptor.top          = passed_4.top;
        descriptor.steps        = {passed_4.x02, passed_4.y20, passed_4.x21, passed_4.y12, passed_4.x10, passed_4.y01};
        descriptor.depth_step_y = step_y;
        descriptor.depth_step_x = step_x;
        descriptor.depth_start  = depth_start;
        descriptor.start        = start_4;
    end

    wide_register #(.WIDTH($bits(descriptor))) result (
        .clk, .next(beat_comes && valid[4]), .in(descriptor), .out(out_descriptor)
    );

    always_ff @(posedge clk) begin
        drawn <= beat && valid[4];
        if (out_ready) out_valid <= 1'b0;
        if (beat && valid[4]) out_valid <= 1'b1;
        if (rst) begin
            out_valid <= 1'b0;
            drawn     <= 1'b0;
        end
    end

    assign busy = cull_busy || valid != '0 || out_valid;

    wire _unused = &{1'b0, reciprocal_ready, reciprocal_done, t.w0, t.y0, t.x0, low_sum[7:0], sum_y[19:0]};
endmodule

`default_nettype wire

// The first part of the triangle setup: computes the area, the facing, the bounds in pixels, and the start group (the eight
// pixels in which rasterization begins). A triangle is dropped, with a pulse of `culled`, if it has no area, if it is a back
// face while `cull_back` is high, or if its bounds contain no pixel centre. The bounds of a triangle beyond one side of the
// picture are empty. A tiny triangle, with at most 2×2 centres in its bounds, is also dropped if it covers none of these centres. `mirror`
// exchanges front and back faces.
//
// Throughput: one triangle per 3 clocks, or per 6 if vertex 1 or 2 is 512 pixels or more above or below vertex 0; latency 18 or 21. The
// module holds two triangles, in different stages; `phase` counts the 3 clocks of a stage:
//
//   in ─▶│ first 3 clocks: products of the  │─▶│ last 3 clocks: area,        │─┬▶ FIFO ───────────────▶ drop or out
//        │ area, minima, maxima; or twice 3 │  │ bounds, start; then verdict │ └▶ centre_test ─▶ FIFO ───▲
//
// The stages cannot be stopped. A triangle is only accepted if the FIFO can hold all triangles inside, so culled triangles can be dropped
// while up to PLACES earlier triangles wait for `out`. The FIFO thereby compensates for the longer time per triangle of the later parts of
// the setup. The result of centre_test is valid after the triangle has entered the FIFO; a dropped triangle leaves the FIFO in two clocks.
// `in_ready` is a register, whose value is computed one clock ahead.

`default_nettype none

module cull #(
    parameter bit SMOOTH = 1'b0,
    parameter bit TEXTURE = 1'b0,
    // Depth of the FIFO at the end, a power of two.
    parameter int unsigned PLACES = 128,
    localparam int unsigned LIGHT_BITS = triangle_pkg::vertex_bits(SMOOTH, TEXTURE),
    localparam int unsigned LIT_BITS   = SMOOTH || TEXTURE ? 1 + 3 * LIGHT_BITS : 1
) (
    input  wire                    clk,
    input  wire                    rst,
    input  wire  [10:0]            width,
    input  wire  [9:0]             height,
    input  wire                    cull_back,
    input  wire                    mirror,
    output logic                   busy,
    output logic                   culled,
    input  wire                    in_valid,
    output logic                   in_ready,
    input  wire  [2:0][65:0]       in_vertices, // screen_vertex_t each
    input  wire  [15:0]            in_colour,
    input  wire  [2:0][15:0]       in_normal,
    input  wire  [2:0][LIGHT_BITS-1:0] in_light,
    output logic                   out_valid,
    input  wire                    out_ready,
    output setup_pkg::oriented_t              out_triangle,
    // {swap, light and texture coordinates of the vertices numbered as in the mesh}; with `swap` vertices 1 and 2 are exchanged.
    output logic [LIT_BITS-1:0]    out_lit,
    // Number of the triangle's texture, with TEXTURE.
    input  wire  [TEXTURE ? 7 : 0:0] in_texture,
    output logic [TEXTURE ? 7 : 0:0] out_texture
);
    // The inputs of a triangle, and differences of the coordinates of its vertices: x10 is x1 − x0, y01 is y0 − y1, and so on.
    typedef struct packed {
        triangle_pkg::screen_vertex_t v0, v1, v2;
        logic [15:0]          colour;
        logic [2:0][15:0]     normal;
        logic [20:0]          x10, x20, y01, y20;
        // `y_21` is high if vertex 2 is above vertex 1, `y_same` if vertices 1 and 2 have equal y.
        logic                 y_21, y_same;
    } triangle_t;

    triangle_pkg::screen_vertex_t v0, v1, v2;
    assign v0 = in_vertices[0];
    assign v1 = in_vertices[1];
    assign v2 = in_vertices[2];

    // `tall` is high if the products of the triangle `first` need both halves of its height, one in each of two turns of 3 clocks; `second`
    // is high in the last turn.
    logic [1:0] phase;
    logic       room, queue_idle, verdict, drop, kept, skip, tall, second, again;
    logic       first_valid, last_valid, first_x_21;
    triangle_t  first, last;

    assign tall    = !fits(first.y01[20:17]) || !fits(first.y20[20:17]);
    assign again   = first_valid && tall && !second;
    assign verdict = phase == 2'd2 && last_valid;
    assign kept    = verdict && !drop;
    assign culled  = verdict && drop || skip;
    assign busy    = first_valid || last_valid || !queue_idle;

    function automatic logic precedes(input logic [20:0] a, input logic [20:0] b);
        precedes = $signed(a) < $signed(b);
    endfunction

    // Returns whether a signed number fits the 18 bits of a factor. `highest` are its bits from bit 17 on.
    function automatic logic fits(input logic [3:0] highest);
        fits = highest == '0 || highest == '1;
    endfunction

    // The next triangle. `takes` is high one clock before this triangle is accepted.
    triangle_t taken;
    logic      takes;

    assign takes = phase == 2'd1 && room && !again;

    always_comb begin
        taken.v0     = v0;
        taken.v1     = v1;
        taken.v2     = v2;
        taken.colour = in_colour;
        taken.normal = in_normal;
        taken.x10    = v1.x - v0.x;
        taken.x20    = v2.x - v0.x;
        taken.y01    = v0.y - v1.y;
        taken.y20    = v2.y - v0.y;
        taken.y_21   = precedes(v2.y, v1.y);
        taken.y_same = v1.y == v2.y;
    end

    wide_register #(.WIDTH($bits(taken) + 1)) first_stage (
        .clk, .next(takes), .in({taken, precedes(v2.x, v1.x)}), .out({first, first_x_21})
    );
    wide_register #(.WIDTH($bits(taken))) last_stage (.clk, .next(phase == 2'd1), .in(first), .out(last));

    always_ff @(posedge clk) begin
        phase    <= phase == 2'd2 ? 2'd0 : phase + 2'd1;
        in_ready <= takes;
        if (phase == 2'd2) begin
            first_valid <= again || in_valid && in_ready;
            second      <= again;
            last_valid  <= first_valid && !again;
        end
        if (rst) begin
            phase       <= '0;
            in_ready    <= 1'b0;
            first_valid <= 1'b0;
            last_valid  <= 1'b0;
        end
    end

    // `area` is 2A = x10·y20 + x20·y01, twice the signed area, one product per clock in phases 0 and 1. For a tall triangle the first turn
    // uses the highest four bits of y20 and y01, the second turn their low 17 bits. The sum is valid in phases 1 and 2 of a triangle's
    // last 3 clocks.
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [43:0] c, area;
    logic        [20:0] factor;

    always_comb begin
        factor = phase[0] ? first.y01 : first.y20;
        a      = 25'($signed(phase[0] ? first.x20 : first.x10));
        if (phase[1])    b = '0;
        else if (again)  b = 18'($signed(factor[20:17]));
        else             b = {factor[17] && !tall, factor[16:0]};
        if (!phase[1])   c = area;
        else if (second) c = {area[26:0], 17'b0};
        else             c = '0;
    end

    multiply_add #(.BITS(44)) dsp (.clk, .enable(1'b1), .a, .b, .c, .p(area));

    // Left and top of the bounds (selected in phase 0), then right and bottom (selected in phase 1). One clock later these values are
    // rounded up to a pixel's centre, and then clamped to the picture.
    logic [20:0] extreme_x, extreme_y, rounded_x, rounded_y;
    logic [12:0] pixel_x, pixel_y, first_x, first_y, columns, rows;
    logic [10:0] cut_x, cut_y, left, right;
    logic [9:0]  top, bottom;

    // Returns the number of the vertex with the smallest coordinate, or with the largest coordinate if `largest` is high. `before_10` is
    // high if vertex 1 precedes vertex 0 in this order, and so on.
    function automatic logic [1:0] choose(input logic largest, input logic before_10, input logic before_20, input logic before_21);
        unique case ({largest, before_10})
            2'b00:   choose = before_20 ? 2'd2 : 2'd0;
            2'b01:   choose = before_21 ? 2'd2 : 2'd1;
            2'b10:   choose = before_21 ? 2'd1 : 2'd2;
            default: choose = before_20 ? 2'd0 : 2'd2;
        endcase
    endfunction

    function automatic logic [10:0] clamp(input logic [12:0] pixel, input logic [10:0] size);
        clamp = pixel[12] ? '0 : pixel[11:0] > {1'b0, size} ? size : pixel[10:0];
    endfunction

    logic [1:0] chosen_x, chosen_y;

    always_comb begin
        chosen_x  = choose(phase[0], first.x10[20], first.x20[20], first_x_21);
        chosen_y  = choose(phase[0], !first.y01[20], first.y20[20], first.y_21);
        rounded_x = extreme_x + 21'd127;
        rounded_y = extreme_y + 21'd127;
        cut_x     = clamp(pixel_x, width);
        cut_y     = clamp(pixel_y, {1'b0, height});
    end

    // The reasons to cull the triangle, and the values that depend on its facing, registered for phase 2.
    // `swap`: vertices 1 and 2 are exchanged, so that the vertices are clockwise on the screen.
    logic        swap, front, no_area, no_column, no_row, tiny;
    logic [39:0] magnitude;
    logic [9:0]  group_top;
    logic [7:0]  group_left, group_right;
    logic [1:0]  topmost;
    logic [10:0] right_last;

    assign right_last = right - 1'b1;
    // Numbers of pixel centres in the bounds before clamping to the picture.
    assign columns    = pixel_x - first_x;
    assign rows       = pixel_y - first_y;

    always_comb begin
        // `topmost` is the number, before the swap of vertices 1 and 2, of the highest vertex on the screen. If several vertices are
        // equally high, it is the one that has the smallest number after the swap.
        if ((last.y01[20] || last.y01 == '0) && !last.y20[20]) topmost = 2'd0;
        else if (last.y_same)                                  topmost = area[43] ? 2'd2 : 2'd1;
        else                                                   topmost = last.y_21 ? 2'd2 : 2'd1;
    end

    assign drop = no_area || no_row || no_column || cull_back && !front;

    always_ff @(posedge clk) begin
        extreme_x <= chosen_x[1] ? first.v2.x : chosen_x[0] ? first.v1.x : first.v0.x;
        extreme_y <= chosen_y[1] ? first.v2.y : chosen_y[0] ? first.v1.y : first.v0.y;
        pixel_x   <= rounded_x[20:8];
        pixel_y   <= rounded_y[20:8];
        unique case (phase)
            2'd2: begin
                left    <= cut_x;
                top     <= cut_y[9:0];
                first_x <= pixel_x;
                first_y <= pixel_y;
            end
            2'd0: begin
                right  <= cut_x;
                bottom <= cut_y[9:0];
                tiny   <= columns <= 13'd2 && rows <= 13'd2;
            end
            default: begin
                swap         <= area[43];
                front        <= area[43] ^ mirror;
                no_area      <= area == '0;
                no_column    <= left >= right;
                no_row       <= top >= bottom;
                magnitude    <= (area[39:0] ^ {40{area[43]}}) + 40'(area[43]);
                group_top    <= topmost[1] ? last.v2.x[20:11] : topmost[0] ? last.v1.x[20:11] : last.v0.x[20:11];
                group_left   <= left[10:3];
                group_right  <= right_last[10:3];
            end
        endcase
    end

    // Negations use −v = ~v + 1.
    setup_pkg::oriented_t oriented;

    always_comb begin
        oriented.front       = front;
        oriented.normal      = last.normal;
        oriented.colour      = last.colour;
        oriented.top         = top;
        oriented.bottom      = bottom;
        oriented.group_left  = group_left;
        oriented.group_right = group_right;
        oriented.group_start = $signed(group_top) < $signed({2'b0, group_left})  ? group_left
                             : $signed(group_top) > $signed({2'b0, group_right}) ? group_right : group_top[7:0];
        oriented.area        = magnitude;
        // ~(a − b) = b + ~a: Yosys puts the selection of the last summand into the LUTs of a sum, but uses separate LUTs for the selection
        // of a minuend.
        oriented.not_w10     = {1'b0, last.v0.w} + ~{1'b0, swap ? last.v2.w : last.v1.w};
        oriented.not_w20     = {1'b0, last.v0.w} + ~{1'b0, swap ? last.v1.w : last.v2.w};
        oriented.x10         = swap ? last.x20 : last.x10;
        oriented.x02         = -(swap ? last.x10 : last.x20);
        oriented.y01         = (swap ? ~last.y20 : last.y01) + 21'(swap);
        oriented.y20         = (swap ? ~last.y01 : last.y20) + 21'(swap);
        oriented.w0          = last.v0.w;
        oriented.y0          = last.v0.y;
        oriented.x0          = last.v0.x;
    end

    // setup_light, which uses the light of the vertices, exchanges vertices 1 and 2 according to `swap`.
    logic [LIT_BITS-1:0] lit;

    if (SMOOTH || TEXTURE) begin : light
        // The following signals are vectors, because Yosys does not support arrays here.
        logic [3*LIGHT_BITS-1:0] first_light, last_light;

        assign lit = {swap, last_light};

        always_ff @(posedge clk) begin
            if (in_ready)      first_light <= in_light;
            if (phase == 2'd2) last_light  <= first_light;
        end
    end else begin : flat
        assign lit = '0;

        wire _unused = &{1'b0, in_light};
    end

    localparam int unsigned NUMBER_BITS = TEXTURE ? 8 : 1;

    logic [NUMBER_BITS-1:0] number;

    if (TEXTURE) begin : texture
        logic [7:0] first_texture, last_texture;

        assign number = last_texture;

        always_ff @(posedge clk) begin
            if (in_ready)      first_texture <= in_texture;
            if (phase == 2'd2) last_texture  <= first_texture;
        end
    end else begin : no_texture
        assign number = '0;

        wire _unused = &{1'b0, in_texture};
    end

    logic queued, tested, covers, pop;

    assign out_valid = queued && tested && covers;
    assign skip      = queued && tested && !covers && !verdict;
    assign pop       = out_valid && out_ready || skip;

    // `room` includes an item before the next triangle can be accepted, so at most the two triangles in the stages are not counted.
    pipeline_fifo #(.WIDTH($bits(oriented) + LIT_BITS + NUMBER_BITS), .DEPTH(PLACES), .FLIGHT(2), .BLOCK(1'b1)) queue (
        .clk, .rst, .idle(queue_idle), .room, .in_valid(kept), .in_data({number, lit, oriented}),
        .out_valid(queued), .out_ready(pop), .out_data({out_texture, out_lit, out_triangle})
    );

    logic             result_valid, result, result_room;
    logic [2:0][10:0] step_x, step_y;

    always_comb begin
        // Each difference between vertices 1 and 2 is a single sum: a swap of these vertices negates the difference, which is done by
        // complementing both operands.
        step_x = {oriented.y20[10:0], (last.v1.y[10:0] ^ {11{swap}}) + ~(last.v2.y[10:0] ^ {11{swap}}) + 11'd1, oriented.y01[10:0]};
        step_y = {oriented.x02[10:0], (last.v2.x[10:0] ^ {11{swap}}) + ~(last.v1.x[10:0] ^ {11{swap}}) + 11'd1, oriented.x10[10:0]};
    end

    centre_test centre_test (
        .clk, .rst, .in_valid(kept), .in_tiny(tiny), .in_step_x(step_x), .in_step_y(step_y),
        .in_px({first_x[2:0], 8'h80} - last.v0.x[10:0]), .in_py({first_y[2:0], 8'h80} - last.v0.y[10:0]),
        .out_valid(result_valid), .out_covers(result)
    );

    // This FIFO is never full: each of its results belongs to a triangle in the queue.
    fifo #(.WIDTH(1), .DEPTH(PLACES)) results (
        .clk, .rst, .in_valid(result_valid), .in_ready(result_room), .in_data(result),
        .out_valid(tested), .out_ready(pop), .out_data(covers)
    );

    wire _unused = &{1'b0, area[42:40], rounded_x[7:0], rounded_y[7:0], right_last[2:0], cut_y[10], result_room};
endmodule

`default_nettype wire

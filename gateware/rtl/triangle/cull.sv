// The first part of the triangle setup: computes the area, the facing, the bounds in pixels, and the start group (the eight
// pixels in which rasterization begins). A triangle is dropped, with a pulse of `culled`, if it has no area, if it is a back
// face while `cull_back` is high, or if its bounds contain no pixel centre. The bounds of a triangle beyond one side of the
// picture are empty.
//
// Throughput a triangle in 4 clocks, latency 8. Two triangles are inside, in different stages; `phase` counts the 4
// clocks of a stage:
//
//   in ─▶│ first 4 clocks: products of the area,  │─▶│ last 4 clocks: area,        │─▶ out
//        │ minima and maxima, one in each clock   │  │ bounds, start; then verdict │
//
// All stages stop while a triangle that is not culled waits in phase 3 for `out`; a culled triangle never waits. `in_ready` is a
// register, decided a clock ahead: high in the clock in which the stages move. So it follows `out_ready` a clock later.

`default_nettype none

module cull #(
    parameter bit SMOOTH = 1'b0,
    localparam int unsigned LIGHT_BITS = SMOOTH ? 41 : 1,
    localparam int unsigned LIT_BITS   = SMOOTH ? 40 : 1
) (
    input  wire                    clk,
    input  wire                    rst,
    input  wire  [10:0]            width,
    input  wire  [9:0]             height,
    input  wire                    cull_back,
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
    // Light L of the vertices, for the visible side of the triangle.
    output logic [2:0][LIT_BITS-1:0] out_lit
);
    // The inputs of a triangle, and differences of the coordinates of its vertices: x10 is x1 − x0, y01 is y0 − y1, and so on.
    typedef struct packed {
        triangle_pkg::screen_vertex_t v0, v1, v2;
        logic [15:0]          colour;
        logic [2:0][15:0]     normal;
        logic [20:0]          x10, x20, y01, y20;
        // `y_21`: vertex 2 is above vertex 1. `y_same`: vertices 1 and 2 have the same height.
        logic                 y_21, y_same;
    } triangle_t;

    triangle_pkg::screen_vertex_t v0, v1, v2;
    assign v0 = in_vertices[0];
    assign v1 = in_vertices[1];
    assign v2 = in_vertices[2];

    logic [1:0] phase;
    logic       advance, drop, drop_next, room;
    logic       first_valid, last_valid, first_x_21;
    triangle_t  first, last;

    // `room`: the output is free in the next clock.
    assign room    = !out_valid || out_ready;
    assign advance = phase != 2'd3 || in_ready;
    assign busy    = first_valid || last_valid || out_valid;

    function automatic logic precedes(input logic [20:0] a, input logic [20:0] b);
        precedes = $signed(a) < $signed(b);
    endfunction

    always_ff @(posedge clk) begin
        if (advance) phase <= phase + 1'b1;
        in_ready <= phase == 2'd2 && (!last_valid || drop_next || room) || phase == 2'd3 && !in_ready && room;
        if (in_ready) begin
            first_valid  <= in_valid;
            first.v0     <= v0;
            first.v1     <= v1;
            first.v2     <= v2;
            first.colour <= in_colour;
            first.normal <= in_normal;
            first.x10    <= v1.x - v0.x;
            first.x20    <= v2.x - v0.x;
            first.y01    <= v0.y - v1.y;
            first.y20    <= v2.y - v0.y;
            first_x_21   <= precedes(v2.x, v1.x);
            first.y_21   <= precedes(v2.y, v1.y);
            first.y_same <= v1.y == v2.y;
            last_valid   <= first_valid;
            last         <= first;
        end
        if (rst) begin
            phase       <= '0;
            in_ready    <= 1'b0;
            first_valid <= 1'b0;
            last_valid  <= 1'b0;
        end
    end

    // `area` is 2A = x10·y20 + x20·y01, twice the signed area. The products with the highest four bits of y20 and y01 come
    // first, then the products with their low 17 bits. The sum is valid in phase 2 of a triangle's last 4 clocks.
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [43:0] c, area;
    logic        [20:0] factor;

    always_comb begin
        factor = phase[0] ? first.y01 : first.y20;
        a      = 25'($signed(phase[0] ? first.x20 : first.x10));
        b      = phase[1] ? {1'b0, factor[16:0]} : 18'($signed(factor[20:17]));
        unique case (phase)
            2'd2:    c = '0;
            2'd0:    c = {area[26:0], 17'b0};
            default: c = area;
        endcase
    end

    multiply_add #(.BITS(44)) dsp (.clk, .enable(advance), .a, .b, .c, .p(area));

    // Left, right, top and bottom of the bounds: selected in phases 0 to 3, rounded up to a pixel's centre one clock later,
    // and then clamped to the picture.
    logic [20:0] extreme;
    logic [12:0] pixel;
    logic [10:0] size, cut, left, right;
    logic [9:0]  top, bottom;
    logic [1:0]  chosen;
    logic        before_10, before_20, before_21;
    logic [20:0] rounded;

    always_comb begin
        before_10 = phase[1] ? !first.y01[20] : first.x10[20];
        before_20 = phase[1] ? first.y20[20]  : first.x20[20];
        before_21 = phase[1] ? first.y_21     : first_x_21;
        unique case ({phase[0], before_10})
            2'b00:   chosen = before_20 ? 2'd2 : 2'd0;
            2'b01:   chosen = before_21 ? 2'd2 : 2'd1;
            2'b10:   chosen = before_21 ? 2'd1 : 2'd2;
            default: chosen = before_20 ? 2'd0 : 2'd2;
        endcase
        rounded = extreme + 21'd127;
        size    = phase[1] ? width : {1'b0, height};
        cut     = pixel[12] ? '0 : pixel[11:0] > {1'b0, size} ? size : pixel[10:0];
    end

    // The decision to cull the triangle, and the values that depend on its facing, registered for phase 3.
    logic        front, no_column;
    logic [39:0] flipped_area;
    logic [9:0]  group_top;
    logic [7:0]  group_left, group_right;
    logic [1:0]  topmost;
    logic [10:0] right_last;

    assign right_last = right - 1'b1;

    always_comb begin
        // `topmost` is the number of the highest vertex on the screen, after vertices 1 and 2 of a front face are swapped.
        // Among vertices of equal height it is the smallest number.
        if ((last.y01[20] || last.y01 == '0) && !last.y20[20]) topmost = 2'd0;
        else if (last.y_same)                                  topmost = area[43] ? 2'd2 : 2'd1;
        else                                                   topmost = last.y_21 ? 2'd2 : 2'd1;
    end

    assign drop_next = area == '0 || top >= bottom || no_column || cull_back && !area[43];

    always_ff @(posedge clk) begin
        if (advance) begin
            extreme <= phase[1] ? (chosen[1] ? first.v2.y : chosen[0] ? first.v1.y : first.v0.y)
                                : (chosen[1] ? first.v2.x : chosen[0] ? first.v1.x : first.v0.x);
            pixel   <= rounded[20:8];
            unique case (phase)
                2'd2: begin
                    left          <= cut;
                    front         <= area[43];
                    drop          <= drop_next;
                    flipped_area  <= area[39:0] ^ {40{area[43]}};
                    group_top     <= topmost[1] ? last.v2.x[20:11] : topmost[0] ? last.v1.x[20:11] : last.v0.x[20:11];
                end
                2'd3: right <= cut;
                2'd0: top   <= cut[9:0];
                2'd1: begin
                    bottom      <= cut[9:0];
                    group_left  <= left[10:3];
                    group_right <= right_last[10:3];
                    no_column   <= left >= right;
                end
            endcase
        end
    end

    assign culled = in_ready && last_valid && drop;

    // In a front face, vertices 1 and 2 are swapped. Values that change their sign use −v = ~v + 1.
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
        oriented.area        = flipped_area + 40'(front);
        oriented.w10         = {1'b0, front ? last.v2.w : last.v1.w} - {1'b0, last.v0.w};
        oriented.w20         = {1'b0, front ? last.v1.w : last.v2.w} - {1'b0, last.v0.w};
        oriented.x10         = front ? last.x20 : last.x10;
        oriented.x02         = -(front ? last.x10 : last.x20);
        oriented.y01         = (front ? ~last.y20 : last.y01) + 21'(front);
        oriented.y20         = (front ? ~last.y01 : last.y20) + 21'(front);
        oriented.w0          = last.v0.w;
        oriented.y0          = last.v0.y;
        oriented.x0          = last.v0.x;
    end

    always_ff @(posedge clk) begin
        // A triangle that is not culled moves only when the output is free.
        if (!out_valid) out_triangle <= oriented;
        out_valid <= out_valid ? !out_ready : in_ready && last_valid && !drop;
        if (rst) out_valid <= 1'b0;
    end

    // Light of the vertices in the order after the swap; 0 for a vertex whose light belongs to the other side of the triangle.
    if (SMOOTH) begin : light
        // The following signals are vectors, because Yosys does not support arrays here.
        logic [3*LIGHT_BITS-1:0] first_light, last_light;
        logic [3*LIT_BITS-1:0]   lit;

        for (genvar i = 0; i < 3; i++) begin : vertices
            localparam int unsigned OTHER = i == 0 ? 0 : 3 - i;
            triangle_pkg::light_t vertex;

            assign vertex = front ? last_light[LIGHT_BITS * OTHER +: LIGHT_BITS] : last_light[LIGHT_BITS * i +: LIGHT_BITS];
            assign lit[LIT_BITS * i +: LIT_BITS] = vertex.back != front ? {vertex.red, vertex.green, vertex.blue} : '0;
        end

        always_ff @(posedge clk) begin
            if (in_ready) begin
                first_light <= in_light;
                last_light  <= first_light;
            end
            if (!out_valid) out_lit <= lit;
        end
    end else begin : flat
        assign out_lit = '0;

        wire _unused = &{1'b0, in_light};
    end

    wire _unused = &{1'b0, area[42:40], rounded[7:0], right_last[2:0]};
endmodule

`default_nettype wire

// Tests whether a tiny triangle covers at least one of 2×2 pixel centres: evaluates its three edge functions at these centres
// (docs/formats/triangle.md, "Triangle setup"). A triangle is tiny if it has at most 2×2 pixel centres in its bounds, so its extents are
// below 3 pixels, and differences of coordinates fit 11 bits. Other triangles pass.
//
// P is the upper left centre, (px, py) its position relative to the vertex at which an edge begins, E = dx·py − dy·px the edge
// function at P. Edges 0 → 1 and 2 → 0 are evaluated from vertex 0, edge 1 → 2 from vertex 1.
//
//            E · ─── · E − 256·dy
//              │     │                     in_valid ─▶ 0 → 1 ─▶ 1 → 2 ─▶ 2 → 0 ─▶ … ─▶ out_valid
//   E + 256·dx · ─── · E + 256·(dx − dy)
//
// Throughput one triangle per 3 clocks, one edge per clock; latency 10 clocks; never stalls. The inputs are the steps of the
// three edge functions for one pixel to the right (−dy) and for one pixel down (dx), and (px, py) relative to vertex 0, s3.8. The
// vertices are clockwise on the screen.

`default_nettype none

module centre_test (
    input  wire              clk,
    input  wire              rst,
    input  wire              in_valid,
    input  wire              in_tiny,
    input  wire  [2:0][10:0] in_step_x,
    input  wire  [2:0][10:0] in_step_y,
    input  wire  [10:0]      in_px,
    input  wire  [10:0]      in_py,
    output logic             out_valid,
    output logic             out_covers
);
    logic [2:0][10:0] steps_x, steps_y;
    logic [10:0]      px_0, py_0;
    // Bit 0: the edge of this clock is the first one. Bit 1: it is the second one.
    logic [1:0]       now;

    always_ff @(posedge clk) begin
        if (in_valid) begin
            steps_x <= in_step_x;
            steps_y <= in_step_y;
            px_0    <= in_px;
            py_0    <= in_py;
        end
        now <= {now[0], in_valid};
    end

    logic signed [10:0] step_x, step_y, px, py, later_py, later_step_y;
    logic               bias, bias_1, bias_2;

    always_comb begin
        step_x = now[0] ? steps_x[0] : now[1] ? steps_x[1] : steps_x[2];
        step_y = now[0] ? steps_y[0] : now[1] ? steps_y[1] : steps_y[2];
        // dx and −dy of the edge 0 → 1 convert the position relative to vertex 0 to the position relative to vertex 1.
        px     = px_0 - (now[1] ? steps_y[0] : '0);
        py     = py_0 + (now[1] ? steps_x[0] : '0);
        bias   = step_x[10] || step_x == '0 && step_y[10];
    end

    always_ff @(posedge clk) begin
        bias_1       <= bias;
        bias_2       <= bias_1;
        later_py     <= py;
        later_step_y <= step_y;
    end

    // The edge functions at P minus their biases. The product of the second multiplier is valid one clock after the product of the first
    // multiplier.
    logic signed [24:0] at_first, at_p;

    multiply_add #(.BITS(25)) along (
        .clk, .enable(1'b1), .a(25'(step_x)), .b(18'(px)), .c({25{bias_2}}), .p(at_first)
    );
    multiply_add #(.BITS(25)) down (
        .clk, .enable(1'b1), .a(25'(later_step_y)), .b(18'(later_py)), .c(at_first), .p(at_p)
    );

    // Delays the steps of an edge until its edge function is valid, in flip-flops (`keep`), because shift registers would take LUTs.
    (* keep *) logic signed [10:0] step_x_1, step_x_2, step_x_3, step_x_4, step_y_1, step_y_2, step_y_3, step_y_4;
    logic signed [11:0] both;

    always_ff @(posedge clk) begin
        step_x_1 <= step_x;
        step_x_2 <= step_x_1;
        step_x_3 <= step_x_2;
        step_x_4 <= step_x_3;
        step_y_1 <= step_y;
        step_y_2 <= step_y_1;
        step_y_3 <= step_y_2;
        step_y_4 <= step_y_3;
        both     <= 12'(step_x_3) + 12'(step_y_3);
    end

    // Bit k of `beyond`: the centre k (P, right, below, diagonal) is outside of the current edge; of `outside`: outside of at least one of
    // the edges evaluated so far. A centre is inside an edge if the edge function is at least its bias; centres are 256 units apart, so the low
    // 8 bits are not needed.
    logic signed [13:0] value, right, below, across;
    logic [3:0]         beyond, outside;

    always_comb begin
        value  = at_p[21:8];
        right  = value + 14'(step_x_4);
        below  = value + 14'(step_y_4);
        across = value + 14'(both);
    end

    // Bit k of `since` is high if a triangle entered k + 1 clocks ago; bit k of `tiny` is high if that triangle is tiny.
    logic [8:0] since, tiny;

    always_ff @(posedge clk) begin
        since      <= {since[7:0], in_valid};
        tiny       <= {tiny[7:0], in_tiny};
        beyond     <= {across[13], below[13], right[13], value[13]};
        outside    <= (since[5] ? '0 : outside) | beyond;
        out_valid  <= since[8];
        out_covers <= !tiny[8] || outside != '1;
        if (rst) begin
            since     <= '0;
            out_valid <= 1'b0;
        end
    end

    wire _unused = &{1'b0, at_p[24:22], at_p[7:0], right[12:0], below[12:0], across[12:0]};
endmodule

`default_nettype wire

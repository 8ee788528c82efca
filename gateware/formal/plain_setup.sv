// Stand-ins for the arithmetic parts of the triangle setup in proofs. The result of each part is one of its operands, which identifies the
// triangle. The stand-in for `cull` derives the cull decision and the triangle's number from the colour.

`default_nettype none

module cull #(
    parameter bit SMOOTH  = 1'b0,
    parameter bit TEXTURE = 1'b0
) (
    input  wire              clk,
    input  wire              rst,
    input  wire  [10:0]      width,
    input  wire  [9:0]       height,
    input  wire              cull_back,
    input  wire              mirror,
    output logic             busy,
    output logic             culled,
    input  wire              in_valid,
    output logic             in_ready,
    input  wire  [2:0][65:0] in_vertices,
    input  wire  [15:0]      in_colour,
    input  wire  [2:0][15:0] in_normal,
    input  wire  [2:0]       in_light,
    output logic             out_valid,
    input  wire              out_ready,
    output setup_pkg::oriented_t out_triangle,
    output logic             out_lit,
    input  wire              in_texture,
    output logic             out_texture
);
    logic [3:0] number;

    assign busy     = out_valid || culled;
    assign in_ready = !out_valid || out_ready;

    always_ff @(posedge clk) begin
        culled <= in_valid && in_ready && in_colour[15];
        if (in_ready) begin
            out_valid <= in_valid && !in_colour[15];
            number    <= in_colour[3:0];
        end
        if (rst) begin
            culled    <= 1'b0;
            out_valid <= 1'b0;
        end
    end

    always_comb begin
        out_texture              = 1'b0;
        out_triangle             = '0;
        out_triangle.colour      = {12'd1, number};
        out_triangle.top         = {6'd2, number};
        out_triangle.bottom      = {6'd3, number};
        out_triangle.group_left  = {4'd4, number};
        out_triangle.group_right = {4'd5, number};
        out_triangle.group_start = {4'd6, number};
        out_triangle.not_w10     = ~{21'd7, number};
        out_triangle.not_w20     = ~{21'd8, number};
        out_triangle.x10         = {17'd1, number};
        out_triangle.y01         = {17'd2, number};
        out_triangle.x02         = {17'd3, number};
        out_triangle.y20         = {17'd4, number};
        out_triangle.w0          = {20'd9, number};
    end
endmodule

module setup_edges (
    input  wire         clk,
    input  wire         enable,
    input  wire  [3:0]  count,
    input  wire  [20:0] px,
    input  wire  [20:0] py,
    input  wire  [20:0] x10,
    input  wire  [20:0] y01,
    input  wire  [20:0] x02,
    input  wire  [20:0] y20,
    input  wire         bias0,
    input  wire         bias2,
    output logic [41:0] e0,
    output logic [41:0] e2
);
    assign e0 = {13'd0, x10, 8'd0};
    assign e2 = {13'd0, x02, 8'd0};
endmodule

module setup_normal (
    input  wire         clk,
    input  wire         enable,
    input  wire  [3:0]  count,
    input  wire  [24:0] w10,
    input  wire  [24:0] w20,
    input  wire  [20:0] x10,
    input  wire  [20:0] y01,
    input  wire  [20:0] x02,
    input  wire  [20:0] y20,
    output logic [45:0] nx,
    output logic [45:0] ny
);
    assign nx = {21'd0, w10};
    assign ny = {21'd0, w20};
endmodule

module flat_shade #(
    parameter bit TEXTURE = 1'b0
) (
    input  wire              clk,
    input  wire              enable,
    input  wire  [3:0]       count,
    input  wire  [2:0][24:0] row_light,
    input  wire  [2:0][8:0]  light_colour,
    input  wire  [2:0][8:0]  ambient,
    input  wire              front,
    input  wire  [2:0][15:0] normal,
    input  wire  [15:0]      colour,
    output logic [15:0]      lit,
    input  wire              textured,
    output logic [2:0][7:0]  light
);
    assign lit   = colour;
    assign light = '0;

    // `enable` is low exactly when the last clock of a beat, here number 2, is repeated.
    logic       running = 1'b0;
    logic [3:0] step = '0;

    always_ff @(posedge clk) begin
        running <= 1'b1;
        if (running && enable) step <= step == 4'd2 ? 4'd0 : step + 1'b1;
        if (running) in_step: assert (step == count);
    end
endmodule

module normalise (
    input  wire         clk,
    input  wire         enable,
    input  wire  [39:0] in,
    output logic [23:0] m,
    output logic [5:0]  lead
);
    assign m    = in[23:0];
    assign lead = '0;
endmodule

module reciprocal (
    input  wire         clk,
    input  wire         rst,
    input  wire         in_valid,
    output logic        in_ready,
    input  wire  [23:0] in_m,
    output logic        out_valid,
    output logic [23:0] out_y
);
    assign in_ready  = 1'b1;
    assign out_valid = in_valid;
    assign out_y     = in_m;
endmodule

module setup_gradient (
    input  wire         clk,
    input  wire  [3:0]  count,
    input  wire  [45:0] nx,
    input  wire  [45:0] ny,
    input  wire  [23:0] y,
    input  wire  [5:0]  lead,
    output logic [40:0] twice_gx,
    output logic [40:0] twice_gy
);
    assign twice_gx = {nx[39:0], 1'b0};
    assign twice_gy = {ny[39:0], 1'b0};
endmodule

module setup_start (
    input  wire         clk,
    input  wire         next_is_odd,
    input  wire  [3:0]  count,
    input  wire  [39:0] gx,
    input  wire  [39:0] gy,
    input  wire  [20:0] px,
    input  wire  [20:0] py,
    input  wire  [23:0] value,
    output logic [31:0] start
);
    assign start = {8'd0, value};
endmodule

`default_nettype wire

// Places a triangle at the row where it enters the band: its first one, or the band's if it begins above.
//
//        top ─────────▲            E' and depth there are start + step_y * (first - top), and at the other end of the
//                    ╱ ╲           group E' + 7 * step_x: exact, E' in 34 bits and depth modulo 2^32
//      ═════════════╱═══╲════════  first
//         band     ╱     ╲
//      ═══════════════════════════
//
// One multiplier and adder does all in eight passes, one a clock:
//
//   pass   product              plus           gives
//   0, 1   step_y * offset      start          E' at lane 0 of edges 0 and 1
//   2, 3   step_x * 7           pass 0, 1      E' at lane 7
//   4      step_y * offset      start          edge 2
//   5      low 24 bits of the depth's step     depth start and half a code
//   6      step_x * 7           pass 4
//   7      its high 8 bits      pass 5         depth
//
// Streams are valid/ready, and ready comes from a register. Latency 12 clocks, throughput a triangle in 12 clocks; one is in
// work and one waits, while another is walked over. A triangle without a row in the band is taken and dropped. The band's
// first row `y0` and its `rows` hold while triangles are inside.

`default_nettype none

module band_entry (
    input  wire                            clk,
    input  wire                            rst,
    input  wire  [9:0]                     y0,
    input  wire  [5:0]                     rows,
    output logic                           idle,
    input  wire                            in_valid,
    output logic                           in_ready,
    input  wire triangle_pkg::descriptor_t in_descriptor,
    output logic                           out_valid,
    input  wire                            out_ready,
    output raster_pkg::placed_t            out_triangle
);
    localparam logic [31:0] HALF_A_CODE = 32'd1 << 13;
    localparam logic [3:0]  ROWS_KNOWN = 4'd4, LAST = 4'd10;

    triangle_pkg::descriptor_t triangle;
    logic        busy;
    logic [3:0]  pass;

    assign idle     = !busy && !out_valid;
    assign in_ready = !busy;

    // Rows, from the band's first one.
    logic [10:0] above, below;
    logic [9:0]  offset;
    logic [5:0]  first, past, count;

    assign above  = {1'b0, y0} - {1'b0, triangle.top};
    assign offset = above[10] ? '0 : above[9:0];

    always_ff @(posedge clk) begin
        below <= {1'b0, triangle.bottom} - {1'b0, y0};
        first <= !above[10] ? '0 : (-above > 11'(rows)) ? rows : 6'(-above);
        past  <= below[10] ? '0 : (below > 11'(rows)) ? rows : below[5:0];
        count <= past > first ? past - first : '0;
    end

    // The step_x that is in use.
    logic [2:0][20:0] step_x, step_y;
    logic [20:0]      step;
    logic             rises, falls;
    logic [19:0]      slope;

    always_comb begin
        case (pass)
            4'd2:    step = step_x[0];
            4'd3:    step = step_x[1];
            default: step = step_x[2];
        endcase
        falls = step[20];
        rises = !falls && step != '0;
        slope = falls ? 20'(-step) : step[19:0];
    end

    logic signed [24:0] factor_a, a;
    logic signed [17:0] factor_b, b;
    logic signed [42:0] product;
    logic        [47:0] c, sum;

    always_comb begin
        case (pass)
            4'd0:             factor_a = 25'(signed'(step_y[0]));
            4'd1:             factor_a = 25'(signed'(step_y[1]));
            4'd4:             factor_a = 25'(signed'(step_y[2]));
            4'd2, 4'd3, 4'd6: factor_a = 25'(signed'(step));
            4'd5:             factor_a = {1'b0, triangle.depth_step_y[23:0]};
            default:          factor_a = {triangle.depth_step_y[31:24], 17'd0};
        endcase
        case (pass)
            4'd0, 4'd1, 4'd4, 4'd5: factor_b = {8'd0, offset};
            4'd2, 4'd3, 4'd6:       factor_b = 18'sd7;
            default:                factor_b = {1'b0, offset, 7'd0};
        endcase
    end

    // Operands of a pass are in `a` and `b` after it, its product and its `c` a clock later, its `sum` another one later. That of
    // the last pass stays.
    always_ff @(posedge clk) begin
        a       <= factor_a;
        b       <= factor_b;
        product <= a * b;
        sum     <= {{5{product[42]}}, product} + c;
        case (pass)
            4'd1:                   c <= {{14{triangle.start[0][33]}}, triangle.start[0]};
            4'd2:                   c <= {{14{triangle.start[1][33]}}, triangle.start[1]};
            4'd5:                   c <= {{14{triangle.start[2][33]}}, triangle.start[2]};
            4'd6:                   c <= {16'd0, triangle.depth_start + HALF_A_CODE};
            4'd3, 4'd4, 4'd7, 4'd8: c <= sum;
            default: ;
        endcase
    end

    logic [2:0][33:0] best, worst;
    logic [2:0][19:0] slopes;
    logic [2:0]       all_rises, all_falls;

    for (genvar k = 0; k < 3; k++) begin : edges
        // The pass that has the edge's step_x in use, and the clocks that have its sums.
        localparam logic [3:0] LANE_0 = k == 2 ? 4'd7 : 4'd3 + 4'(k);
        localparam logic [3:0] STEP   = k == 2 ? 4'd6 : 4'd2 + 4'(k);
        localparam logic [3:0] LANE_7 = k == 2 ? 4'd9 : 4'd5 + 4'(k);

        always_ff @(posedge clk) begin
            if (pass == STEP) begin
                slopes[k]    <= slope;
                all_rises[k] <= rises;
                all_falls[k] <= falls;
            end
            if (pass == LANE_0 || pass == LANE_7 && all_rises[k]) best[k] <= sum[33:0];
            if (pass == LANE_0 || pass == LANE_7 && !all_rises[k]) worst[k] <= sum[33:0];
        end

        triangle_pkg::steps_t steps;

        assign steps = triangle.steps[k];
        assign step_x[k] = steps.x;
        assign step_y[k] = steps.y;
    end

    always_ff @(posedge clk) begin
        if (out_ready) out_valid <= 1'b0;
        if (in_ready) begin
            triangle <= in_descriptor;
            busy     <= in_valid;
            pass     <= '0;
        end else if (pass != LAST) begin
            pass <= pass + 1'b1;
            if (pass == ROWS_KNOWN && count == '0) busy <= 1'b0;
        end else if (!out_valid || out_ready) begin
            busy      <= 1'b0;
            out_valid <= 1'b1;
            out_triangle.best         <= best;
            out_triangle.worst        <= worst;
            out_triangle.depth        <= sum[31:0];
            out_triangle.step_x       <= step_x;
            out_triangle.step_y       <= step_y;
            out_triangle.depth_step_x <= triangle.depth_step_x;
            out_triangle.depth_step_y <= triangle.depth_step_y;
            out_triangle.slope        <= slopes;
            out_triangle.rises        <= all_rises;
            out_triangle.falls        <= all_falls;
            out_triangle.line         <= first;
            out_triangle.rows         <= count;
            out_triangle.group_left   <= triangle.group_left;
            out_triangle.group_right  <= triangle.group_right;
            out_triangle.group_start  <= triangle.group_start;
            out_triangle.colour       <= triangle.colour;
        end

        if (rst) begin
            busy      <= 1'b0;
            out_valid <= 1'b0;
        end
    end
endmodule

`default_nettype wire

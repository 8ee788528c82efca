// Evaluates the edge functions E' and the depth of a triangle at the row where it enters the band. This row, `first` in the drawing, is the
// triangle's first row, or the first row of the band if the triangle begins above the band.
//
//        top ─────────▲            E' and depth there are start + step_y * (first - top), and at the other end of the
//                    ╱ ╲           group E' + 7 * step_x: exact, E' in 34 bits and depth modulo 2^32
//      ═════════════╱═══╲════════  first
//         band     ╱     ╲
//      ═══════════════════════════
//
// One multiply_add computes E' and the depth in eight passes, one per clock, and a second multiply_add computes `beside`, the value of E'
// one lane outside of the group (see raster_pkg):
//
//   pass   product              plus           result
//   0, 1   step_y * offset      start          E' in lane 0 of edges 0 and 1
//   2, 3   step_x * 7           pass 0, 1      E' in lane 7; `beside` from step_x * 8 or -step_x
//   4      step_y * offset      start          E' in lane 0 of edge 2
//   5      low 24 bits of the depth's step_y   depth_start plus half a depth code
//   6      step_x * 7           pass 4         E' in lane 7, and `beside`, of edge 2
//   7      its high 8 bits      pass 5         depth in lane 0
//
// `offset` is the number of rows from the triangle's top to `first`. Streams are valid/ready, and ready comes from registers.
// Latency 13 clocks, throughput one triangle per 8 clocks: while one triangle is in its passes, the previous triangle completes, or is held
// until the output is free, and the next triangle waits at the input. At least two clocks pass between two triangles at the output. A
// triangle without a row in the band is taken and dropped. `in_y0` (the band's first row) and `in_odd` (the parity of the band's number)
// arrive with the triangle; bit b of `holds` is high while a triangle of a band with parity b is inside. `rows`, the rows of a band, must
// hold while triangles are inside. With SMOOTH or TEXTURE, the planes of light and of texture coordinates pass through plane_entry, each
// with its own multiplier.

`default_nettype none

module band_entry #(
    parameter bit SMOOTH = 1'b0,
    parameter bit TEXTURE = 1'b0,
    localparam int unsigned CHANNELS    = triangle_pkg::channels(SMOOTH, TEXTURE),
    localparam int unsigned PLANES_BITS = triangle_pkg::planes_bits(SMOOTH, TEXTURE)
) (
    input  wire                            clk,
    input  wire                            rst,
    input  wire  [5:0]                     rows,
    output logic [1:0]                     holds,
    input  wire                            in_valid,
    output logic                           in_ready,
    input  wire  [9:0]                     in_y0,
    input  wire                            in_odd,
    input  wire records_pkg::descriptor_t in_descriptor,
    input  wire  [PLANES_BITS-1:0]         in_planes,
    output logic                           out_valid,
    input  wire                            out_ready,
    output logic                           out_odd,
    output raster_pkg::placed_t            out_triangle,
    // `out_late` is valid one clock later than `out_triangle`, and `out_planes` LIGHT_LATER clocks after `out_late`. `out_planes` has the
    // format of `in_planes`, but contains the values of the planes in lane 0 of the triangle's first row in the band.
    output raster_pkg::placed_late_t       out_late,
    output logic [PLANES_BITS-1:0]         out_planes
);
    localparam logic [31:0] HALF_A_CODE = 32'd1 << 13;
    localparam logic [2:0]  STALLS = 3'd3, ROWS_KNOWN = 3'd4, LAST_BUT_ONE = 3'd6, LAST = 3'd7;

    // Stages of a triangle: first its passes (`busy`), then three clocks in which its last products arrive (`ending`), then the held stage,
    // in which the triangle waits for the output register.
    records_pkg::descriptor_t triangle;
    logic [9:0]  y0;
    logic        busy, dropped, odd, held_valid, held_odd, advance, moved, out_free;
    logic [2:0]  pass;
    logic [3:1]  ending;

    // A new triangle may enter while no triangle is in its passes, or during the last pass of a triangle.
    held_register #(.WIDTH($bits(in_descriptor) + 10 + 1)) inputs (
        .clk, .rst, .free(in_ready), .in_valid, .in({in_odd, in_y0, in_descriptor}),
        .leaves(dropped || pass == LAST_BUT_ONE), .out({odd, y0, triangle})
    );

    // The first result of a triangle overwrites the first result of the previous triangle, so the passes stall until the previous triangle
    // has left the held stage.
    assign advance   = pass != STALLS || !held_valid || !out_valid;

    for (genvar b = 0; b < 2; b++) begin : bands
        assign holds[b] = busy && odd == 1'(b) || (ending != '0 || held_valid) && held_odd == 1'(b)
                        || out_valid && out_odd == 1'(b);
    end

    // Rows of the triangle in the band, counted from the first row of the band: the first row, the row after the last row, and the number
    // of rows. `top` and `bottom` are these rows before they are limited to the band.
    logic [10:0] above, top, bottom;
    logic [9:0]  offset;
    logic [5:0]  first, past, count;

    assign dropped = pass == ROWS_KNOWN && count == '0;

    assign above  = {1'b0, y0} - {1'b0, triangle.top};
    assign offset = above[10] ? '0 : above[9:0];

    always_ff @(posedge clk) begin
        top    <= {1'b0, triangle.top} - {1'b0, y0};
        bottom <= {1'b0, triangle.bottom} - {1'b0, y0};
        first  <= top[10] ? '0 : (top > 11'(rows)) ? rows : top[5:0];
        past   <= bottom[10] ? '0 : (bottom > 11'(rows)) ? rows : bottom[5:0];
        count  <= past > first ? past - first : '0;
    end

    // The horizontal step of the edge that the current pass uses, selected one clock ahead, with its sign and magnitude.
    logic [2:0][20:0] step_x, step_y;
    logic [20:0]      step;
    logic             rises, falls;
    logic [19:0]      slope;

    always_ff @(posedge clk) begin
        if (advance) begin
            case (pass)
                3'd1:    step <= step_x[0];
                3'd2:    step <= step_x[1];
                default: step <= step_x[2];
            endcase
        end
    end

    always_comb begin
        falls = step[20];
        rises = !falls && step != '0;
        slope = (step[19:0] ^ {20{falls}}) + 20'(falls);
    end

    // Operands of a pass. `c` is selected one clock after `a` and `b`; the results `sum` and `beside` are valid two clocks after that.
    logic signed [24:0] a;
    logic signed [17:0] b, b_beside;
    logic signed [47:0] c, sum;
    logic signed [33:0] beside;

    always_comb begin
        case (pass)
            3'd0:             a = 25'(signed'(step_y[0]));
            3'd1:             a = 25'(signed'(step_y[1]));
            3'd4:             a = 25'(signed'(step_y[2]));
            3'd2, 3'd3, 3'd6: a = 25'(signed'(step));
            3'd5:             a = {1'b0, triangle.depth_step_y[23:0]};
            default:          a = {triangle.depth_step_y[31:24], 17'd0};
        endcase
        case (pass)
            3'd0, 3'd1, 3'd4, 3'd5: b = {8'd0, offset};
            3'd2, 3'd3, 3'd6:       b = 18'sd7;
            default:                b = {1'b0, offset, 7'd0};
        endcase
        b_beside = rises ? -18'sd1 : 18'sd8;
    end

    multiply_add #(.BITS(48)) dsp (.clk, .enable(advance), .a, .b, .c, .p(sum));
    multiply_add #(.BITS(34)) dsp_beside (.clk, .enable(advance), .a, .b(b_beside), .c(c[33:0]), .p(beside));

    always_ff @(posedge clk) begin
        if (advance) begin
            case (pass)
                3'd1:    c <= {{14{triangle.start[0][33]}}, triangle.start[0]};
                3'd2:    c <= {{14{triangle.start[1][33]}}, triangle.start[1]};
                3'd5:    c <= {{14{triangle.start[2][33]}}, triangle.start[2]};
                3'd6:    c <= {16'd0, triangle.depth_start + HALF_A_CODE};
                default: c <= sum;
            endcase
        end
    end

    raster_pkg::placed_t      placed;
    raster_pkg::placed_late_t late;
    logic [2:0][19:0]         slopes;
    logic [2:0]               all_rises, all_falls;

    for (genvar k = 0; k < 3; k++) begin : edges
        // LANE_0: number of the pass during which the edge's value in lane 0 arrives. STEP: the number of the pass that
        // multiplies the edge's step_x.
        localparam logic [2:0] LANE_0 = k == 2 ? 3'd7 : 3'd3 + 3'(k);
        localparam logic [2:0] STEP   = k == 2 ? 3'd6 : 3'd2 + 3'(k);
        logic at_lane_0, at_lane_7;

        assign at_lane_0 = busy && pass == LANE_0 && advance;
        assign at_lane_7 = k == 2 ? ending[2] : busy && pass == 3'd5 + 3'(k);

        always_ff @(posedge clk) begin
            if (pass == STEP) begin
                slopes[k]    <= slope;
                all_rises[k] <= rises;
                all_falls[k] <= falls;
            end
            if (at_lane_0 || at_lane_7 && all_rises[k]) placed.best[k] <= sum[33:0];
            // Written without a clock enable, because flip-flops with different enables cannot share a slice of the FPGA.
            placed.beside_fails[k] <= at_lane_7 && beside[33] || !at_lane_7 && placed.beside_fails[k];
        end

        records_pkg::steps_t steps;

        assign steps = triangle.steps[k];
        assign step_x[k] = steps.x;
        assign step_y[k] = steps.y;
    end

    // The held triangle: its results stay in their registers, and its other fields are copied in the last pass. Two registers enable the
    // copy, one for each half of the fields. Each of these registers depends on itself, because synthesis would otherwise merge them.
    (* keep *) logic [1:0] copies;

    always_ff @(posedge clk) begin
        for (int i = 0; i < 2; i++) copies[i] <= pass == LAST_BUT_ONE && !copies[i];
        if (copies[0]) begin
            placed.slope       <= slopes;
            placed.step_y      <= step_y;
        end
        if (copies[1]) begin
            held_odd           <= odd;
            placed.rises       <= all_rises;
            placed.falls       <= all_falls;
            placed.rows        <= count;
            placed.group_left  <= triangle.group_left;
            placed.group_right <= triangle.group_right;
            placed.group_start <= triangle.group_start;
            late.depth_step_x  <= triangle.depth_step_x;
            late.depth_step_y  <= triangle.depth_step_y;
            late.line          <= first;
            late.colour        <= triangle.colour;
        end
        if (ending[3]) late.depth <= sum[31:0];
    end

    if (CHANNELS > 0) begin : planes
        localparam int unsigned CONSTANT_BITS = PLANES_BITS - 96 * CHANNELS;

        logic [CONSTANT_BITS-1:0] constants, held_constants;
        logic                     give;

        // The held planes are sent LIGHT_LATER clocks after the held triangle has moved.
        delay #(.WIDTH(1), .CLOCKS(raster_pkg::LIGHT_LATER)) give_delay (.clk, .enable(1'b1), .in(moved), .out(give));

        always_ff @(posedge clk) begin
            if (in_ready)     constants <= in_planes[96 * CHANNELS +: CONSTANT_BITS];
            if (pass == LAST) held_constants <= constants;
            if (give)         out_planes[96 * CHANNELS +: CONSTANT_BITS] <= held_constants;
        end

        for (genvar k = 0; k < CHANNELS; k++) begin : channels
            plane_entry plane (
                .clk, .take(in_ready), .pass, .advance, .offset, .hold(pass == LAST), .begins(ending[1]), .result(ending[3]), .give,
                .in_plane(in_planes[96 * k +: 96]), .out_plane(out_planes[96 * k +: 96])
            );
        end
    end else begin : flat
        assign out_planes = '0;

        wire _unused = &{1'b0, in_planes};
    end

    // The output register only loads while it is empty, so that its enable is a register. This takes one clock between two triangles.
    assign out_valid = !out_free;

    held_register #(.WIDTH($bits(placed) + 1)) result (
        .clk, .rst, .free(out_free), .in_valid(held_valid), .in({held_odd, placed}),
        .leaves(out_ready), .out({out_odd, out_triangle})
    );

    always_ff @(posedge clk) begin
        ending <= {ending[2:1], busy && pass == LAST};

        if (in_ready) begin
            busy <= in_valid;
            pass <= '0;
        end else if (advance) begin
            pass <= pass + 1'b1;
            if (dropped) busy <= 1'b0;
        end

        if (!out_valid) held_valid <= 1'b0;
        moved <= !out_valid;
        if (moved) out_late <= late;
        if (ending[3]) held_valid <= 1'b1;

        if (rst) begin
            busy       <= 1'b0;
            ending     <= '0;
            held_valid <= 1'b0;
        end
    end

    wire _unused = &{1'b0, beside[32:0]};
endmodule

`default_nettype wire

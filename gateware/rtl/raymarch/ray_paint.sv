// Computes pixels from the ends of rays: the colour of the surface, darkened by occlusion and blended with fog, and the depth code
// (docs/formats/raymarch.md, "Ends").
//
//             ┌─▶ depth ─┬─▶ depth_code ──────────────────────────────────────────────┐
//   ends ─────┤          └─▶ fog ─────┐                                               ├─▶ group of one pixel
//             ├─▶ steps ─▶ light ──┐  ▼                                               │
//             └─▶ surface ─▶ colour × ─▶ mixed with the horizon ─▶ RGB565, L8 ────────┘
//
// A pixel leaves as a group for the band buffer: row, line, column of eight pixels, a mask with one bit set, one depth code, and one colour
// for all pixels of the group. With `stereo` the colour holds the pixel's luminance twice, and `out_eye` selects the valid half.
//
// With ROUND, the end of a ray on a sphere or fillet arrives with its colour, `in_colour`. Streams are valid/ready. Latency 25 clocks;
// throughput one pixel per clock. The parameters must hold while pixels are in the pipeline, which cannot be stopped: valid bits travel with
// the pixels, and credit_fifo at its end limits the number of pixels inside.

`default_nettype none

module ray_paint #(
    parameter bit ROUND   = 1'b0,
    // With OCTANTS there are eight face colours, for faces perpendicular to the diagonals; otherwise six.
    parameter bit OCTANTS = 1'b0,
    // Whether faces may be in the shadow of the first light.
    parameter bit SHADOW  = 1'b0,
    // Depth of the FIFO of pixels after the pipeline.
    parameter int unsigned PLACES = 64
) (
    input  wire                     clk,
    input  wire                     rst,
    // Frame.
    input  wire                     stereo,
    // Whether colours are dithered, and the lowest bits of the number of the band's first line.
    input  wire                     dither,
    input  wire  [1:0]              first_line,
    // Number of groups of eight pixels in a line: 40, 80 or 160.
    input  wire  [7:0]              stride,
    input  wire  [16:0]             depth_mantissa,
    input  wire  signed [5:0]       depth_exponent,
    input  wire  [2:0]              fog_shift,
    input  wire raymarch_registers_pkg::palette_t palette,
    input  wire  [23:0]             horizon,
    input  wire                     table_write,
    input  wire  [8:0]              table_entry,
    input  wire  [7:0]              table_part,
    // Ends.
    input  wire                     in_valid,
    output logic                    in_ready,
    input  wire raymarch_pkg::end_t    in_end,
    input  wire  [23:0]             in_colour,
    // Groups.
    output logic                    out_valid,
    input  wire                     out_ready,
    output logic                    out_eye,
    output logic [10:0]             out_row,
    output logic [5:0]              out_line,
    output logic [7:0]              out_column,
    output logic [7:0]              out_mask,
    output logic [17:0]             out_code,
    output logic [15:0]             out_colour
);
    // The suffix of a name is the signal's clock. An end enters in clock BEGIN, and its group leaves in clock LAST.
    localparam int unsigned LAST = 29, BEGIN = 5;

    localparam int unsigned LATENCY = LAST - BEGIN;

    logic [LATENCY:1] valid;

    always_ff @(posedge clk) begin
        valid <= {valid[LATENCY-1:1], in_valid && in_ready};
        if (rst) valid <= '0;
    end

    // The parameter T of a ray is a depth.
    logic [39:0] depth_5;
    logic [17:0] code_28;

    assign depth_5 = {5'b0, in_end.t, 7'b0};

    depth_code coded (
        .clk, .mantissa(depth_mantissa), .exponent(depth_exponent), .depth(depth_5), .code(code_28)
    );

    // Indices into the tables of fog and light in clock 7, and the entries of the tables in clock 9. The steps of the table of fog are
    // equal in its first 64 entries, and in each further 32 entries twice as long as before: the index has an exponent of three bits and
    // the five bits below the leading bit of the depth.
    logic [22:0] deep_6;
    logic [7:0]  fog_entry_6, fog_entry_7, fog_9, light_9, height_9, steps_7;

    always_comb begin
        fog_entry_6 = {3'd0, deep_6[4:0]};
        for (int unsigned k = 0; k < 7; k++) if (deep_6[k + 5]) fog_entry_6 = {3'(k + 1), deep_6[k +: 5]};
        if (deep_6[22:12] != '0) fog_entry_6 = '1;
    end

    always_ff @(posedge clk) begin
        deep_6      <= depth_5[39:17] >> fog_shift;
        fog_entry_7 <= fog_entry_6;
    end

    delay #(.WIDTH(8), .CLOCKS(7 - BEGIN)) steps_wait (.clk, .enable(1'b1), .in(in_end.steps), .out(steps_7));
    delay #(.WIDTH(8), .CLOCKS(9 - BEGIN)) height_waits (.clk, .enable(1'b1), .in(in_end.t[7:0]), .out(height_9));
    paint_table fog_and_light (
        .clk, .write(table_write), .write_entry(table_entry), .write_part(table_part),
        .fog_entry(fog_entry_7), .fog(fog_9), .light_entry(steps_7), .light(light_9)
    );

    // State and surface of the end in clock 7; in clock 8 two colours, of which the highest bit of the surface selects one; in clock 9 the
    // colour of the surface; in clock 10 the shares of light and fog in 256ths.
    raymarch_pkg::state_t state_7, state_8, state_9;
    logic [2:0]        surface_7;
    logic              upper_8;
    logic [23:0]       lower_colour_8, upper_colour_8, plain_8;
    logic [2:0][7:0]   colour_9, colour_10;
    logic [7:0]        fog_part;
    logic [8:0]        light_10, fog_10, fog_14;

    delay #(.WIDTH(5), .CLOCKS(7 - BEGIN)) surfaces (
        .clk, .enable(1'b1), .in({in_end.state, in_end.surface}), .out({state_7, surface_7})
    );

    // The end of a ray on a sphere or fillet arrives with a colour that includes the light.
    logic        lit_8;
    logic [23:0] lit_colour_8;

    if (ROUND) begin : lit
        delay #(.WIDTH(25), .CLOCKS(8 - BEGIN)) light_waits (
            .clk, .enable(1'b1), .in({in_end.round && in_end.state == raymarch_pkg::HIT, in_colour}), .out({lit_8, lit_colour_8})
        );
    end else begin : unlit
        assign lit_8        = 1'b0;
        assign lit_colour_8 = '0;
        wire _unused = &{1'b0, in_end.round, in_colour};
    end

    function automatic logic [23:0] one_of_four(input logic [3:0][23:0] colours, input logic [1:0] number);
        unique case (number)
            2'd0: one_of_four = colours[0];
            2'd1: one_of_four = colours[1];
            2'd2: one_of_four = colours[2];
            2'd3: one_of_four = colours[3];
        endcase
    endfunction

    // The colour of a miss is the last of the four colours for surfaces 4 to 7, and the colour of an undecided ray is the last but one.
    // With OCTANTS these colours belong to faces.
    logic       hit_7;
    logic [2:0] number_7;

    assign hit_7    = state_7[0];
    assign number_7 = hit_7 ? surface_7 : {2'b11, state_7 == raymarch_pkg::MISS};

    always_ff @(posedge clk) begin
        state_8        <= state_7;
        upper_8        <= number_7[2];
        lower_colour_8 <= one_of_four(palette.faces[3:0], number_7[1:0]);
        if (OCTANTS && hit_7) upper_colour_8 <= one_of_four(palette.faces[7:4], surface_7[1:0]);
        else                  upper_colour_8 <= one_of_four({palette.zenith, palette.undecided, palette.faces[5:4]}, number_7[1:0]);
        if (SHADOW && state_7 == raymarch_pkg::SHADED) begin
            upper_8        <= 1'b0;
            lower_colour_8 <= one_of_four({24'd0, palette.shadows}, surface_7[2:1]);
        end
    end
    assign plain_8 = upper_8 ? upper_colour_8 : lower_colour_8;

    assign fog_part = state_9[0] ? fog_9 : ~height_9;

    always_ff @(posedge clk) begin
        state_9  <= state_8;
        colour_9 <= lit_8 ? lit_colour_8 : plain_8;

        colour_10 <= colour_9;
        light_10  <= state_9[0] ? {1'b0, light_9} + 9'(light_9[7]) : 9'd256;
        fog_10    <= state_9 == raymarch_pkg::UNDECIDED ? '0 : {1'b0, fog_part} + 9'(fog_part[7]);
    end

    delay #(.WIDTH(9), .CLOCKS(4)) fog_waits (.clk, .enable(1'b1), .in(fog_10), .out(fog_14));

    // The darkened colour in clock 13, its difference from the horizon's colour in clock 14, the colour blended with fog in clock 17.
    logic [2:0][7:0] faded_17;

    for (genvar i = 0; i < 3; i++) begin : channels
        logic signed [25:0] lit_13, faded;
        logic signed [8:0]  apart_14;
        logic [7:0]         lit_16;

        multiply_add #(.BITS(26)) darken (
            .clk, .enable(1'b1), .a({17'b0, colour_10[i]}), .b({9'b0, light_10}), .c('0), .p(lit_13)
        );
        always_ff @(posedge clk) apart_14 <= $signed({1'b0, horizon[8*i +: 8]}) - $signed({1'b0, lit_13[15:8]});
        delay #(.WIDTH(8), .CLOCKS(3)) lit_waits (.clk, .enable(1'b1), .in(lit_13[15:8]), .out(lit_16));
        multiply_add #(.BITS(26)) fade (
            .clk, .enable(1'b1), .a(25'(apart_14)), .b({9'b0, fog_14}), .c({10'b0, lit_16, 8'd128}), .p(faded)
        );
        assign faded_17[i] = faded[15:8];

        wire _unused = &{1'b0, lit_13[25:16], lit_13[7:0], faded[25:16], faded[7:0]};
    end

    // In clock 18 a full channel is 31 or 63 steps, with fraction bits; in clock 19 the colour is in the format of the frame buffer:
    // RGB565, rounded with the threshold of the pixel's position, or with `stereo` two luminances.
    logic [2:0][7:0] scaled_18;
    logic [1:0]      line_17, column_17;
    logic [2:0]      threshold_18;
    logic [15:0]     colour_19, colour_29;

    delay #(.WIDTH(4), .CLOCKS(17 - BEGIN)) corner_waits (
        .clk, .enable(1'b1), .in({in_end.place.line[1:0], in_end.place.column[1:0]}), .out({line_17, column_17})
    );

    always_ff @(posedge clk) begin
        scaled_18[0] <= faded_17[0] - 8'(faded_17[0][7:5]);
        scaled_18[1] <= faded_17[1] - (stereo ? 8'd0 : 8'(faded_17[1][7:6]));
        scaled_18[2] <= faded_17[2] - 8'(faded_17[2][7:5]);
        threshold_18 <= colour_pkg::threshold(dither, column_17, line_17 + first_line);
        colour_19    <= stereo ? {scaled_18[1], scaled_18[1]} : colour_pkg::rounded(scaled_18, threshold_18);
    end

    delay #(.WIDTH(16), .CLOCKS(10)) colour_waits (.clk, .enable(1'b1), .in(colour_19), .out(colour_29));

    // In clock 29 the group is complete. The depth code is 0 for a ray without a hit.
    raymarch_pkg::place_t place_26, place_29;
    logic              hit_28;
    logic [17:0]       code_29;
    logic [8:0]        line_times_5;
    logic [10:0]       first_row_28, row_29;
    logic [7:0]        column_28;

    delay #(.WIDTH(raymarch_pkg::PLACE_BITS), .CLOCKS(26 - BEGIN)) place_waits (.clk, .enable(1'b1), .in(in_end.place), .out(place_26));
    delay #(.WIDTH(raymarch_pkg::PLACE_BITS), .CLOCKS(3)) place_goes (.clk, .enable(1'b1), .in(place_26), .out(place_29));
    delay #(.WIDTH(8), .CLOCKS(2)) column_waits (.clk, .enable(1'b1), .in(place_26.column[10:3]), .out(column_28));
    delay #(.WIDTH(1), .CLOCKS(28 - BEGIN)) hit_waits (.clk, .enable(1'b1), .in(in_end.state[0]), .out(hit_28));

    always_ff @(posedge clk) begin
        line_times_5 <= {1'b0, place_26.line, 2'd0} + 9'(place_26.line);
        if (stride[7])      first_row_28 <= {line_times_5[5:0], 5'd0};
        else if (stride[6]) first_row_28 <= {line_times_5[6:0], 4'd0};
        else                first_row_28 <= {line_times_5[7:0], 3'd0};
        row_29  <= first_row_28 + 11'(column_28);
        code_29 <= hit_28 ? code_28 : '0;
    end

    logic [2:0] number;

    /* verilator lint_off PINCONNECTEMPTY */
    credit_fifo #(.WIDTH(1 + 11 + 6 + 8 + 3 + 18 + 16), .DEPTH(PLACES)) leaving (
        .clk, .rst, .idle(), .credit(in_ready), .sent(in_valid),
        .in_valid(valid[LATENCY]), .in_data({place_29.eye, row_29, place_29.line, place_29.column, code_29, colour_29}),
        .out_valid, .out_ready, .out_data({out_eye, out_row, out_line, out_column, number, out_code, out_colour})
    );
    /* verilator lint_on PINCONNECTEMPTY */

    assign out_mask = 8'b1 << number;

    wire _unused = &{1'b0, in_end, depth_5[39:17], place_29.odd, line_times_5[8], stride[5:0]};
endmodule

`default_nettype wire

// Computes the sky behind the triangles of a picture: a colour for each group of eight pixels, in the order of the picture's lines, by the
// height of the group, which is linear in the picture (docs/formats/triangle.md, "Sky").
//
//   height + across, or ─▶ magnitude ─▶ zenith or nadir, mixed with the horizon ─▶ fifo ─▶ colours
//   line's height + down
//
// `start` (one clock) drops the rest of the previous picture and begins one with `stride` groups in a line. With `twice` (TWICE only) the
// colours are those of groups of samples, two in each direction for a group of pixels. `sky`, `stride` and `twice` must hold until the last
// colour of the picture has been taken; after this colour, further colours have no meaning. The stream is valid/ready.
// Latency 8 clocks from `start`; throughput one colour per clock.

`default_nettype none

module band_sky #(
    parameter bit TWICE = 1'b0
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         start,
    input  wire  [7:0]  stride,
    input  wire         twice,
    input  wire triangle_registers_pkg::sky_t sky,
    output logic        out_valid,
    input  wire         out_ready,
    // The lowest bits of the number of the line, and {blue, green, red} for colour_pkg::rounded.
    output logic [1:0]  out_line,
    output logic [23:0] out_colour
);
    localparam int unsigned LATENCY = 5;

    // Heights of the group, and of the first group of its line. `left` is the number of groups after this one in the line; `ends` is high
    // for the last one. Before the first line, `line` is the height of the line above the picture, and `running` is low.
    logic signed [31:0] height, line, next;
    logic [7:0]         left;
    logic [1:0]         number, number_5;
    logic               running, ends, credit, sent, clear;

    assign clear = rst || start;
    assign sent  = running && credit;
    // High if the next group in a line, or the next line, has another height.
    logic new_group, new_line;

    if (TWICE) begin : samples
        logic right, lower;

        assign new_group = !twice || right;
        assign new_line  = !twice || lower;

        always_ff @(posedge clk) begin
            if (!running || sent) begin
                right <= !ends && !right;
                if (ends) lower <= !lower;
            end
            if (start) lower <= 1'b1;
        end
    end else begin : pixels
        assign {new_group, new_line} = '1;
        wire _unused = &{1'b0, twice};
    end

    assign next = (ends ? line : height) + (ends ? new_line ? sky.down : '0 : new_group ? sky.across : '0);

    always_ff @(posedge clk) begin
        running <= 1'b1;
        if (!running || sent) begin
            height <= next;
            ends   <= left == 8'd1;
            left   <= ends ? stride - 1'b1 : left - 1'b1;
            if (ends) begin
                line   <= next;
                number <= number + 1'b1;
            end
        end
        if (start) begin
            line   <= sky.above;
            number <= '1;
            ends   <= 1'b1;
            left   <= '0;
        end
        if (clear) running <= 1'b0;
    end

    // The valid bits of the pipeline; the suffix of a name is the clock after `sent`.
    logic [LATENCY:1] valid;

    always_ff @(posedge clk) begin
        valid <= {valid[LATENCY-1:1], sent};
        if (clear) valid <= '0;
    end

    // The share of the horizon's colour, 255 minus the magnitude of the height, and the sign.
    logic [7:0] part_1;
    logic       down_1, down_3;

    always_ff @(posedge clk) begin
        part_1 <= height[30:23] != {8{height[31]}} ? '0 : height[22:15] ^ {8{!height[31]}};
        down_1 <= height[31];
    end

    delay #(.WIDTH(1), .CLOCKS(2)) down_goes (.clk, .enable(1'b1), .in(down_1), .out(down_3));

    logic [2:0][7:0] colour_4;

    for (genvar i = 0; i < 3; i++) begin : channels
        logic signed [25:0] mixed;
        logic signed [8:0]  from_zenith, from_nadir;
        logic [7:0]         end_3;

        // Constant in a picture.
        always_ff @(posedge clk) begin
            from_zenith <= $signed({1'b0, sky.horizon[8*i +: 8]}) - $signed({1'b0, sky.zenith[8*i +: 8]});
            from_nadir  <= $signed({1'b0, sky.horizon[8*i +: 8]}) - $signed({1'b0, sky.nadir[8*i +: 8]});
        end
        assign end_3 = down_3 ? sky.nadir[8*i +: 8] : sky.zenith[8*i +: 8];

        multiply_add #(.BITS(26)) mix (
            .clk, .enable(1'b1), .a(25'(down_1 ? from_nadir : from_zenith)), .b({9'b0, 9'(part_1) + 9'(part_1[7])}),
            .c({10'b0, end_3, 8'd128}), .p(mixed)
        );
        assign colour_4[i] = mixed[15:8];

        wire _unused = &{1'b0, mixed[25:16], mixed[7:0]};
    end

    // A full channel becomes 31 or 63 steps.
    logic [2:0][7:0] colour_5;

    always_ff @(posedge clk) begin
        colour_5[0] <= colour_4[0] - 8'(colour_4[0][7:5]);
        colour_5[1] <= colour_4[1] - 8'(colour_4[1][7:6]);
        colour_5[2] <= colour_4[2] - 8'(colour_4[2][7:5]);
    end

    delay #(.WIDTH(2), .CLOCKS(LATENCY)) numbers (.clk, .enable(1'b1), .in(number), .out(number_5));

    /* verilator lint_off PINCONNECTEMPTY */
    credit_fifo #(.WIDTH(26), .DEPTH(16)) colours (
        .clk, .rst(clear), .idle(), .credit, .sent(running),
        .in_valid(valid[LATENCY]), .in_data({number_5, colour_5}), .out_valid, .out_ready,
        .out_data({out_line, out_colour})
    );
    /* verilator lint_on PINCONNECTEMPTY */

    wire _unused = &{1'b0, height[14:0]};
endmodule

`default_nettype wire

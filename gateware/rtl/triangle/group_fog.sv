// Applies fog to groups of eight pixels: mixes each colour with the colour of the fog, by the depth code of its pixel
// (docs/formats/triangle.md, "Fog").
//
//             ┌─ fifo: groups ─────────────────────────────────────────────────────────────────────────────────┐
//   group ──▶ ┤                                                                                                ├──▶ group
//             └─ quads ─▶ log2 of the codes ─▶ table of shares ─▶ mix with the fog ─▶ round ──▶ fifo: colours ─┘
//
// A group takes one clock for each half with a pixel in its mask (a quad of four pixels). Streams are valid/ready; `in_ready` depends on
// `in_mask`. Latency 14 clocks from the last quad of a group; throughput one quad per clock. The pipeline of quads cannot be stopped: a
// group enters only while the FIFO of groups has a free entry. The FIFO of colours is as deep, and never holds more groups. Without
// `enable` there is no fog. Input colours have the format of the input of colour_pkg::rounded, and are rounded to RGB565; with `dither`,
// the threshold depends on the position of the pixel. `enable`, `dither`, `fog` and `first_line`, the number in the picture of the groups'
// line 0, must hold while groups are inside. `idle` is high while no group is inside.

`default_nettype none

module group_fog #(
    // Width of the fields of a group other than mask, codes and colours.
    parameter int unsigned BESIDE_BITS = 8,
    // Maximum number of groups inside, a power of two.
    parameter int unsigned GROUPS      = 32
) (
    input  wire                    clk,
    input  wire                    rst,
    input  wire                    enable,
    input  wire                    dither,
    input  wire triangle_registers_pkg::fog_t fog,
    input  wire  [1:0]             first_line,
    output logic                   idle,
    input  wire                    in_valid,
    output logic                   in_ready,
    input  wire  [BESIDE_BITS-1:0] in_beside,
    input  wire  [1:0]             in_line,    // lowest bits of the line's number
    input  wire  [7:0]             in_mask,
    input  wire  [7:0][17:0]       in_codes,
    input  wire  [7:0][23:0]       in_colours,
    input  wire                    in_added,   // the group is added to the picture, and the fog darkens it
    output logic                   out_valid,
    input  wire                    out_ready,
    output logic [BESIDE_BITS-1:0] out_beside,
    output logic [7:0]             out_mask,
    output logic [7:0][17:0]       out_codes,
    output logic [7:0][15:0]       out_colours
);
    // The suffix of a name is the number of clocks after `sends`.
    localparam int unsigned LAST = 12;

    logic second, half, ends, sends, room, group_valid, colours_valid;

    assign half     = second || in_mask[3:0] == '0;
    assign ends     = half || in_mask[7:4] == '0;
    assign sends    = in_valid && room;
    assign in_ready = room && ends;

    always_ff @(posedge clk) begin
        if (sends) second <= !ends;
        if (rst) second <= 1'b0;
    end

    fifo #(.WIDTH(BESIDE_BITS + 8 + 8 * 18), .DEPTH(GROUPS), .DIRECT(1'b1)) groups (
        .clk, .rst, .in_valid(sends && ends), .in_ready(room), .in_data({in_beside, in_mask, in_codes}),
        .out_valid(group_valid), .out_ready(out_ready && colours_valid), .out_data({out_beside, out_mask, out_codes})
    );

    assign idle      = !group_valid;
    assign out_valid = group_valid && colours_valid;

    // Fields that are delayed with a quad.
    logic [LAST:1]       valid;
    logic                added_7, half_12, ends_12;
    logic [1:0]          line_1, line_11;
    // The colour of the fog, plus 1: blue and red side by side, with eight bits between them, and green.
    logic signed [24:0]  fog_8;
    logic signed [8:0]   green_fog_8;

    always_ff @(posedge clk) begin
        valid       <= {valid[LAST-1:1], sends};
        line_1      <= in_line + first_line;
        fog_8       <= $signed({1'b0, added_7 ? 24'd0 : {fog.colour[23:16], 8'd0, fog.colour[7:0]}}) + 25'sd1;
        green_fog_8 <= $signed({1'b0, added_7 ? 8'd0 : fog.colour[15:8]}) + 9'sd1;
        if (rst) valid <= '0;
    end

    delay #(.WIDTH(1), .CLOCKS(7)) added_waits (.clk, .enable(1'b1), .in(in_added), .out(added_7));
    delay #(.WIDTH(2), .CLOCKS(10)) line_waits (.clk, .enable(1'b1), .in(line_1), .out(line_11));
    delay #(.WIDTH(2), .CLOCKS(12)) half_waits (.clk, .enable(1'b1), .in({half, ends}), .out({half_12, ends_12}));

    logic [3:0][10:0] index_6;
    logic [3:0][8:0]  share_8;
    logic [3:0][15:0] foggy_12;

    for (genvar pair = 0; pair < 2; pair++) begin : pairs
        fog_shares table_of_shares (.clk, .indices(index_6[2*pair +: 2]), .shares(share_8[2*pair +: 2]));
    end

    for (genvar lane = 0; lane < 4; lane++) begin : lanes
        logic [17:0] code_1;
        // The complement of the colour.
        logic [23:0] less_1, less_8, less_10, colour_10;

        always_ff @(posedge clk) begin
            code_1   <= half ? in_codes[4 + lane] : in_codes[lane];
            less_1   <= half ? ~in_colours[4 + lane] : ~in_colours[lane];
        end

        fog_index indices (.clk, .enable, .offset(fog.offset), .code(code_1), .index(index_6[lane]));

        // The fog minus the colour, as the sum of fog + 1 and the complement of the colour, which a DSP48 adds before its multiplier. Each
        // sum of a channel is at most 255·2^8 + 128, so red does not carry into blue, although a difference may be negative.
        logic signed [24:0] difference_9;
        logic signed [8:0]  green_difference_9;
        logic signed [9:0]  share_9;
        logic signed [34:0] product_10;
        logic signed [18:0] green_product_10;
        logic [31:0]        sum_11;
        logic [15:0]        green_11;

        delay #(.WIDTH(24), .CLOCKS(7)) colour_waits (.clk, .enable(1'b1), .in(less_1), .out(less_8));
        delay #(.WIDTH(24), .CLOCKS(2)) colour_goes (.clk, .enable(1'b1), .in(less_8), .out(less_10));

        assign colour_10 = ~less_10;

        always_ff @(posedge clk) begin
            difference_9       <= fog_8 + $signed({1'b1, less_8[23:16], 8'hFF, less_8[7:0]});
            green_difference_9 <= green_fog_8 + $signed({1'b1, less_8[15:8]});
            share_9            <= {1'b0, share_8[lane]};

            product_10         <= difference_9 * share_9;
            green_product_10   <= green_difference_9 * share_9;

            sum_11             <= product_10[31:0] + {colour_10[23:16], 8'd128, colour_10[7:0], 8'd128};
            green_11           <= green_product_10[15:0] + {colour_10[15:8], 8'd128};

            foggy_12[lane]     <= colour_pkg::rounded(
                {sum_11[31:24], green_11[15:8], sum_11[15:8]}, colour_pkg::threshold(dither, 2'(lane), line_11)
            );
        end

        wire _unused = &{1'b0, sum_11[23:16], sum_11[7:0], green_11[7:0], product_10[34:32], green_product_10[18:16]};
    end

    // Collects the colours of a group.
    logic             finished, colours_room;
    logic [7:0][15:0] collected;

    always_ff @(posedge clk) begin
        finished <= valid[LAST] && ends_12;
        if (valid[LAST] && !half_12) collected[3:0] <= foggy_12;
        if (valid[LAST] && half_12)  collected[7:4] <= foggy_12;
        if (rst) finished <= 1'b0;
    end

    fifo #(.WIDTH(8 * 16), .DEPTH(GROUPS), .DIRECT(1'b1)) colours (
        .clk, .rst, .in_valid(finished), .in_ready(colours_room), .in_data(collected),
        .out_valid(colours_valid), .out_ready(out_ready && group_valid), .out_data(out_colours)
    );

    wire _unused = &{1'b0, colours_room};
endmodule

`default_nettype wire

// Draws the parts of triangles that are in a band. Input: descriptors (triangles after the setup). Output: groups of eight
// neighbouring pixels of a row.
//
//               ┌────────────┐     ┌────────┐     ┌───────┐     ┌───────────────┐
//   triangle ──▶│ band_entry │────▶│ walker │────▶│ lanes │────▶│ pipeline_fifo │──▶ group
//               └────────────┘     └────────┘     └───────┘     └───────────────┘
//                                      ▲                                │
//                                      └────────────── room ────────────┘
//
// With SMOOTH, a triangle arrives with the planes of its three colour channels, and `smooth_shader` replaces `pipeline_fifo`.
// `smooth_shader` takes one clock for each pixel of a group of a smooth triangle. With TEXTURE, a triangle arrives with the planes of its
// texture coordinates, and `texture_shader` replaces `pipeline_fifo`; it reads textures from memory.
//
// A group is {line = y - y0, where y0 is the first row of the band, column = x / 8, row address in the band buffer = line * stride +
// column, mask, eight depth codes u18, eight colours RGB565}, lane 0 (the leftmost pixel) in the lowest bits. The mask is never
// 0. Each group that a triangle covers is sent once, or not at all if its texels are transparent; triangles keep their order.
//
// With FOG, `group_fog` follows, which applies fog to the groups if `has_fog` is high, and takes one clock for each half of a group with a
// covered pixel. With TEXTURE, `texture_blend` comes last: groups may be blended with the picture, see band_buffer.
//
// Streams are valid/ready, with a register between any two ready signals. The lanes cannot be stopped; instead, the walker stalls while
// the FIFO cannot hold all groups in the lanes. Latency 21 clocks from a descriptor to its first group. Throughput: the walker tests one
// group per clock, and a triangle takes at least 8 clocks. `triangle_y0`, the first row of the band, and `triangle_odd`, the parity of the
// band's number, arrive with each triangle. `odd` is the parity of the band that is drawn. Triangles of the next band are accepted and
// prepared, but wait until `odd` is the parity of their band. `idle` is low from the clock after a descriptor of the drawn band is taken
// until the last group of that band is taken. `rows` (rows of a band) and `stride` (groups of a row: 40, 80 or 160) must hold while
// triangles are inside. `events` are one clock late.

`default_nettype none

module triangle_raster #(
    parameter bit SMOOTH = 1'b0,
    parameter bit TEXTURE = 1'b0,
    parameter bit FOG = 1'b0,
    localparam int unsigned ADDRESS_BITS = triangle_registers_pkg::ADDRESS_BITS,
    localparam int unsigned PLANES_BITS  = triangle_pkg::planes_bits(SMOOTH, TEXTURE)
) (
    input  wire                            clk,
    input  wire                            rst,
    input  wire                            odd,
    input  wire  [5:0]                     rows,
    input  wire  [7:0]                     stride,
    output logic                           idle,
    output triangle_registers_pkg::events_t events,
    // Descriptors.
    input  wire                            triangle_valid,
    output logic                           triangle_ready,
    input  wire  [9:0]                     triangle_y0,
    input  wire                            triangle_odd,
    input  wire records_pkg::descriptor_t triangle_descriptor,
    input  wire  [PLANES_BITS-1:0]         triangle_planes,
    // Fog, whether colours are dithered, and the number of the first row of the band that is drawn.
    input  wire                            has_fog,
    input  wire triangle_registers_pkg::fog_t fog,
    input  wire                            dither,
    input  wire  [1:0]                     first_row,
    // Textures: the address of their table, and the client of a read_port that reads them. texture_shader explains `forget`.
    input  wire                            forget,
    input  wire  [ADDRESS_BITS-1:0]        texture_table,
    output logic                           ask_valid,
    input  wire                            ask_ready,
    output logic [ADDRESS_BITS-1:0]        ask_addr,
    input  wire                            data_valid,
    output logic                           data_ready,
    input  wire  [127:0]                   data,
    // Groups.
    output logic                           group_valid,
    input  wire                            group_ready,
    output logic [10:0]                    group_row,
    output logic [5:0]                     group_line,
    output logic [7:0]                     group_column,
    output logic [7:0]                     group_mask,
    output logic [8*18-1:0]                group_codes,
    output logic [8*16-1:0]                group_colours,
    // Blended pixels.
    output logic                           group_asks,
    output logic                           group_blended,
    input  wire                            answer_valid,
    input  wire  [7:0]                     answer_lanes,
    output logic [2:0]                     behind_lane,
    input  wire  [15:0]                    behind
);
    logic                   walker_idle, lanes_idle, fifo_idle, fog_idle, waits;
    logic [1:0]             holds;
    logic                   placed_valid, placed_ready, placed_odd;
    raster_pkg::placed_t    placed;
    logic [PLANES_BITS-1:0] placed_planes;
    raster_pkg::placed_late_t placed_late;
    logic                   walking, walked_valid, room;
    raster_pkg::candidate_t walked;
    raster_pkg::late_t      walked_late;
    logic [PLANES_BITS-1:0] walked_planes;

    assign waits = placed_odd != odd;
    assign idle  = !holds[odd] && walker_idle && lanes_idle && fifo_idle && fog_idle;

    logic counts_walking, counts_empty;

    always_ff @(posedge clk) begin
        counts_walking <= walking;
        counts_empty   <= walking && !walked_valid;
    end

    always_comb begin
        events = '0;
        events.cycles_walking = counts_walking;
        events.cycles_empty   = counts_empty;
    end

    band_entry #(.SMOOTH(SMOOTH), .TEXTURE(TEXTURE)) band_entry (
        .clk, .rst, .rows, .holds,
        .in_valid(triangle_valid), .in_ready(triangle_ready), .in_y0(triangle_y0), .in_odd(triangle_odd),
        .in_descriptor(triangle_descriptor), .in_planes(triangle_planes),
        .out_valid(placed_valid), .out_ready(placed_ready && !waits), .out_odd(placed_odd), .out_triangle(placed),
        .out_late(placed_late), .out_planes(placed_planes)
    );

    walker #(.SMOOTH(SMOOTH), .TEXTURE(TEXTURE)) walker (
        .clk, .rst, .idle(walker_idle), .walking,
        .in_valid(placed_valid && !waits), .in_ready(placed_ready), .in_triangle(placed),
        .in_late(placed_late), .in_planes(placed_planes), .out_valid(walked_valid), .out_ready(room), .out_group(walked),
        .out_late(walked_late), .out_planes(walked_planes)
    );

    typedef struct packed {
        logic [10:0]      row;
        logic [5:0]       line;
        logic [7:0]       column;
        logic [7:0]       mask;
        logic [7:0][17:0] codes;
    } group_t;

    group_t      found;
    logic [15:0] found_colour;
    logic        found_valid;

    localparam int unsigned GROUP_BITS = $bits(found);
    // Number of clocks from the walker to the FIFO.
    localparam int unsigned FLIGHT     = 5;

    lanes lanes (
        .clk, .rst, .stride, .idle(lanes_idle),
        .in_valid(walked_valid && room), .in_group(walked), .in_late(walked_late),
        .out_valid(found_valid), .out_row(found.row), .out_line(found.line), .out_column(found.column),
        .out_mask(found.mask), .out_codes(found.codes), .out_colour(found_colour)
    );

    // The groups with their colours, and the rule by which a group is blended with the picture (`blend`); then the same groups with fog.
    logic       shaded_valid, shaded_ready, foggy_valid, foggy_ready;
    group_t     shaded;
    logic [7:0] opaque, foggy_mask;
    logic [3:0] blend, foggy_blend;
    logic [8*16-1:0] foggy_colours;

    // With FOG, colours are rounded to RGB565 only in group_fog.
    localparam int unsigned COLOUR_BITS = FOG ? 24 : 16;

    logic [8*COLOUR_BITS-1:0] shaded_colours;

    // The lowest bits of the line in the picture.
    logic [1:0] found_line;

    assign found_line = found.line[1:0] + first_row;

    if (TEXTURE) begin : textured
        records_pkg::plane_t found_depth;

        delay #(.WIDTH(96), .CLOCKS(FLIGHT - 1)) depth_delay (
            .clk, .enable(1'b1), .in({walked_late.depth_step_y, walked_late.depth_step_x, walked_late.depth}), .out(found_depth)
        );

        texture_shader #(.ADDRESS_BITS(ADDRESS_BITS), .GROUP_BITS(GROUP_BITS), .FLIGHT(FLIGHT), .FRACTIONS(FOG)) texture_shader (
            .clk, .rst, .forget, .dither, .table_base(texture_table), .idle(fifo_idle), .room,
            .in_valid(found_valid), .in_group(found), .in_mask(found.mask), .in_line(found_line), .in_colour(found_colour),
            .in_texture(walked_planes), .in_depth(found_depth),
            .ask_valid, .ask_ready, .ask_addr, .data_valid, .data_ready, .data,
            .out_valid(shaded_valid), .out_ready(shaded_ready), .out_group(shaded), .out_opaque(opaque), .out_colours(shaded_colours),
            .out_blend(blend)
        );

        texture_blend texture_blend (
            .clk, .rst, .in_valid(foggy_valid), .in_ready(foggy_ready), .in_blend(foggy_blend), .in_mask(foggy_mask),
            .in_colours(foggy_colours), .out_valid(group_valid), .out_ready(group_ready), .out_mask(group_mask), .out_colours(group_colours),
            .out_asks(group_asks), .out_blended(group_blended), .answer_valid, .answer_lanes, .lane(behind_lane), .behind
        );
    end else begin : plain
        assign {ask_valid, ask_addr, data_ready} = '0;
        assign {blend, group_asks, group_blended, behind_lane} = '0;
        assign group_valid   = foggy_valid;
        assign foggy_ready   = group_ready;
        assign group_mask    = foggy_mask;
        assign group_colours = foggy_colours;

        wire _unused = &{1'b0, foggy_blend, answer_valid, answer_lanes, behind, forget, texture_table, ask_ready, data_valid, data, walked_late.depth_step_y};
    end

    if (SMOOTH) begin : light
        // The depth of a group is delayed until its mask is valid. The light is valid in the same clock (LIGHT_LATER).
        logic [63:0] found_depth;

        delay #(.WIDTH(64), .CLOCKS(FLIGHT - 1)) depth_delay (
            .clk, .enable(1'b1), .in({walked_late.depth_step_x, walked_late.depth}), .out(found_depth)
        );

        smooth_shader #(.GROUP_BITS(GROUP_BITS), .FLIGHT(FLIGHT), .FRACTIONS(FOG)) smooth_shader (
            .clk, .rst, .dither, .idle(fifo_idle), .room, .in_valid(found_valid), .in_group(found), .in_mask(found.mask), .in_line(found_line),
            .in_colour(found_colour), .in_smooth(walked_planes[288]),
            .in_depth(found_depth[31:0]), .in_depth_step_x(found_depth[63:32]),
            .in_light({walked_planes[192 +: 32], walked_planes[96 +: 32], walked_planes[0 +: 32]}),
            .in_light_step_x({walked_planes[224 +: 32], walked_planes[128 +: 32], walked_planes[32 +: 32]}),
            .out_valid(shaded_valid), .out_ready(shaded_ready), .out_group(shaded), .out_colours(shaded_colours)
        );
        assign opaque = '1;

        wire _unused = &{1'b0, walked_planes};
    end else if (!TEXTURE) begin : flat
        logic [15:0] colour;

        pipeline_fifo #(.WIDTH(GROUP_BITS + 16), .DEPTH(16), .FLIGHT(FLIGHT), .DIRECT(1'b1)) pipeline_fifo (
            .clk, .rst, .idle(fifo_idle), .room, .in_valid(found_valid), .in_data({found, found_colour}),
            .out_valid(shaded_valid), .out_ready(shaded_ready), .out_data({shaded, colour})
        );

        if (FOG) begin : exact
            assign shaded_colours = {8{colour_pkg::fractions(colour)}};
        end else begin : rounding
            assign shaded_colours = {8{colour}};
        end
        assign opaque         = '1;

        wire _unused = &{1'b0, walked_planes, found_line};
    end

    if (FOG) begin : in_fog
        localparam int unsigned BESIDE_BITS = 11 + 6 + 8 + (TEXTURE ? 4 : 0);

        logic [BESIDE_BITS-1:0] beside;

        group_fog #(.BESIDE_BITS(BESIDE_BITS)) group_fog (
            .clk, .rst, .enable(has_fog), .dither, .fog, .first_line(first_row), .idle(fog_idle),
            .in_valid(shaded_valid), .in_ready(shaded_ready), .in_beside(BESIDE_BITS'({blend, shaded.row, shaded.line, shaded.column})),
            .in_line(shaded.line[1:0]), .in_mask(shaded.mask & opaque), .in_codes(shaded.codes), .in_colours(shaded_colours),
            .in_added(TEXTURE && blend[3]),
            .out_valid(foggy_valid), .out_ready(foggy_ready), .out_beside(beside), .out_mask(foggy_mask), .out_codes(group_codes),
            .out_colours(foggy_colours)
        );

        assign {foggy_blend, group_row, group_line, group_column} = 29'(beside);
    end else begin : clear
        assign fog_idle      = 1'b1;
        assign foggy_valid   = shaded_valid;
        assign shaded_ready  = foggy_ready;
        assign foggy_blend   = blend;
        assign foggy_mask    = shaded.mask & opaque;
        assign foggy_colours = shaded_colours;
        assign group_row     = shaded.row;
        assign group_line    = shaded.line;
        assign group_column  = shaded.column;
        assign group_codes   = shaded.codes;

        wire _unused = &{1'b0, has_fog, fog, dither};
    end
endmodule

`default_nettype wire

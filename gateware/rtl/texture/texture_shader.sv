// The colours of groups of eight pixels, some of which have a texture.
//
//            ┌─ pipeline_fifo: groups ─────────────────────────────────────────────────────────────────────────────┐
//   group ──▶┤                                                                                                     ├──▶ group, colours
//            └─ fifo: planes ─▶ quads ─▶ texture_place ─▶ texture_sampler ─▶ texture_filter ─▶ texture_collect ─────┘
//                                 │                         ▲
//                                 └─▶ texture_loader ───────┘ texture, palette
//
// A group without a texture takes one clock. A group with a texture takes one clock for each half with a covered pixel (a quad of four
// pixels), or, with bilinear filtering, for each pair of lanes with a covered pixel. It takes more clocks if its texels are in more than
// 2x2 blocks of the texture. A group whose texture differs from that of the previous group waits until the previous group has left the
// sampler, and until texture_loader has read the new texture's header and palette.
//
// The source of the groups is a pipeline that cannot be stopped. The pipeline sends groups only while `room` is high; a group arrives
// FLIGHT clocks after it is sent (see pipeline_fifo). Groups stay in order. A group whose texels are all transparent is dropped. Output: a
// valid/ready stream. `idle` is high while no group is inside. `forget` (one clock, while idle) discards the texels and the texture of
// earlier frames. The colours of textures are rounded to RGB565; with `dither`, the threshold depends on the position of the pixel.
// `in_line` has the lowest bits of the number of the picture's line. With FRACTIONS, the colours of textures are not rounded yet, and all
// colours have the format of the input of colour_pkg::rounded. `table_base` is the address of the table of the textures' addresses, in
// words of 16 bytes.

`default_nettype none

module texture_shader #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned GROUP_BITS   = 8,
    parameter int unsigned FLIGHT       = 5,
    // Maximum number of groups inside, a power of two. These groups can fill the sampler's queue, because each has one or two quads.
    parameter int unsigned GROUPS       = 256,
    parameter bit          FRACTIONS    = 1'b0,
    localparam int unsigned COLOUR_BITS = FRACTIONS ? 24 : 16
) (
    input  wire                    clk,
    input  wire                    rst,
    input  wire                    forget,
    input  wire                    dither,     // constant while groups are inside
    input  wire  [ADDRESS_BITS-1:0] table_base,
    output logic                   idle,
    output logic                   room,
    input  wire                    in_valid,
    input  wire  [GROUP_BITS-1:0]  in_group,
    input  wire  [7:0]             in_mask,
    input  wire  [1:0]             in_line,
    input  wire  [15:0]            in_colour,  // of a triangle without a texture
    // Texture and planes of s and t, with the accumulators in lane 0.
    input  wire records_pkg::texture_planes_t in_texture,
    input  wire records_pkg::plane_t in_depth, // with half a code added, in lane 0
    // Client of a read_port.
    output logic                   ask_valid,
    input  wire                    ask_ready,
    output logic [ADDRESS_BITS-1:0] ask_addr,
    input  wire                    data_valid,
    output logic                   data_ready,
    input  wire  [127:0]           data,
    output logic                   out_valid,
    input  wire                    out_ready,
    output logic [GROUP_BITS-1:0]  out_group,
    output logic [7:0]             out_opaque, // lanes without a transparent texel
    output logic [7:0][COLOUR_BITS-1:0] out_colours,
    output logic [3:0]             out_blend   // rule by which the group is blended with the picture, see texture_blend; 0 for none
);
    // Groups that wait for their colours.
    logic             is_textured, group_valid, group_textured, group_gone, colours_valid, colours_room, groups_room, waiting_idle, waiting_room;
    logic [15:0]      group_colour;
    logic [7:0]       opaque;
    logic [7:0][COLOUR_BITS-1:0] colours;
    logic [COLOUR_BITS-1:0]      flat_colour;

    assign is_textured = in_texture.texture != '0;

    pipeline_fifo #(.WIDTH(GROUP_BITS + 17), .DEPTH(GROUPS), .FLIGHT(FLIGHT), .BLOCK(1'b1), .PAUSE(1'b0)) groups (
        .clk, .rst, .idle, .room(groups_room), .in_valid, .in_data({is_textured, in_colour, in_group}),
        .out_valid(group_valid), .out_ready(group_gone), .out_data({group_textured, group_colour, out_group})
    );

    logic [3:0] blend;

    if (FRACTIONS) begin : exact
        assign flat_colour = colour_pkg::fractions(group_colour);
    end else begin : rounding
        assign flat_colour = group_colour;
    end

    assign out_valid   = group_valid && (!group_textured || colours_valid && opaque != '0);
    assign group_gone  = !group_textured ? out_ready : colours_valid && (opaque == '0 || out_ready);
    assign out_opaque  = group_textured ? opaque : '1;
    assign out_colours = group_textured ? colours : {8{flat_colour}};
    assign out_blend   = group_textured ? blend : '0;

    // Groups with a texture wait for their positions. The FIFO is wide, so it holds fewer groups than the module. The lowest 8 bits of a
    // plane's step_y have no effect, and are not stored.
    localparam int unsigned PLANE_BITS   = 88;
    localparam int unsigned OTHER_BITS   = $bits(in_texture) - 2 * 96;
    localparam int unsigned WAITING_BITS = 2 + 8 + 3 * PLANE_BITS + OTHER_BITS;

    logic                           waiting_valid, waiting_gone;
    logic [7:0]                     mask;
    logic [1:0]                     line;
    logic [2:0][95:0]               in_planes, planes;
    logic [2:0][PLANE_BITS-1:0]     in_short, short;
    records_pkg::texture_planes_t   texture;

    assign room      = groups_room && waiting_room;
    assign in_planes = {in_texture.planes, in_depth};

    for (genvar k = 0; k < 3; k++) begin : shortened
        assign in_short[k] = {in_planes[k][95:72], in_planes[k][63:0]};
        assign planes[k]   = {short[k][87:64], 8'd0, short[k][63:0]};
    end

    assign texture.planes = planes[2:1];

    pipeline_fifo #(.WIDTH(WAITING_BITS), .DEPTH(32), .FLIGHT(FLIGHT)) waiting (
        .clk, .rst, .idle(waiting_idle), .room(waiting_room), .in_valid(in_valid && is_textured),
        .in_data({in_line, in_mask, in_short, in_texture.linear, in_texture.texture, in_texture.periods, in_texture.range, in_texture.light}),
        .out_valid(waiting_valid), .out_ready(waiting_gone),
        .out_data({line, mask, short, texture.linear, texture.texture, texture.periods, texture.range, texture.light})
    );

    // Sends the quads of the first waiting group, one per clock, if its texture is the current one; otherwise changes the texture as soon as
    // all quads have left the sampler.
    typedef enum logic [1:0] {EMPTY, START, LOAD, SEND} state_t;
    state_t state;

    logic [7:0] number;
    logic       second, half, sends, ends, both, follows, credit, sampler_idle, same, loaded;
    logic [3:0] quad;

    assign half  = second || mask[3:0] == '0;
    assign quad  = half ? mask[7:4] : mask[3:0];
    assign ends  = half || mask[7:4] == '0;
    assign sends = state == SEND && waiting_valid && same && credit && !follows;

    // With bilinear filtering, a quad with pixels in both pairs is two items of the sampler; the second item follows one clock after the
    // first.
    assign both = sampler.bilinear && quad[1:0] != '0 && quad[3:2] != '0;

    assign waiting_gone = sends && ends;
    assign same         = texture.texture == number;

    always_ff @(posedge clk) begin
        if (sends) second <= !ends;
        follows <= sends && both;

        case (state)
            EMPTY: if (waiting_valid && sampler_idle) begin
                number <= texture.texture;
                state  <= START;
            end
            START:   state <= LOAD;
            LOAD:    if (loaded) state <= SEND;
            default: if (waiting_valid && !same) state <= EMPTY;
        endcase

        if (rst || forget) state <= EMPTY;
        if (rst) {second, follows} <= '0;
    end

    texture_pkg::sampler_t sampler;
    logic                  level_write, palette_write;
    logic [3:0]            level_number;
    logic [ADDRESS_BITS-1:0] level_first;
    logic [7:0]            palette_index;
    logic [15:0]           palette_colour;

    // Both clients of the memory take turns: the loader reads only while the sampler is idle.
    logic                    loading, load_ask_valid, sample_ask_valid, load_data_ready, sample_data_ready;
    logic [ADDRESS_BITS-1:0] load_ask_addr, sample_ask_addr;

    assign loading    = state == LOAD;
    assign ask_valid  = loading ? load_ask_valid : sample_ask_valid;
    assign ask_addr   = loading ? load_ask_addr : sample_ask_addr;
    assign data_ready = loading ? load_data_ready : sample_data_ready;

    texture_loader #(.ADDRESS_BITS(ADDRESS_BITS)) texture_loader (
        .clk, .rst, .start(state == START), .number, .table_base, .done(loaded),
        .ask_valid(load_ask_valid), .ask_ready(ask_ready && loading), .ask_addr(load_ask_addr),
        .data_valid(data_valid && loading), .data_ready(load_data_ready), .data,
        .sampler, .level_write, .level_number, .level_first, .palette_write, .palette_index, .palette_colour
    );

    logic                   placed_valid, placed_half, placed_last;
    logic [3:0]             placed_mask, placed_level;
    logic [1:0][3:0][17:0]  placed_positions;

    texture_place texture_place (
        .clk, .rst, .sampler, .in_valid(sends), .in_mask(quad), .in_half(half), .in_first(!second), .in_last(ends),
        .in_planes(planes), .in_linear(texture.linear), .in_range(texture.range), .in_periods(texture.periods),
        .out_valid(placed_valid), .out_mask(placed_mask), .out_half(placed_half), .out_last(placed_last), .out_level(placed_level),
        .out_positions(placed_positions)
    );

    logic                        step_valid, step_half, step_last, step_bilinear;
    logic [3:0]                  step_mask, step_opaque;
    logic [3:0][15:0]            step_texels;
    logic [1:0][3:0][15:0]       step_neighbours;
    logic [1:0][1:0][3:0]        step_weights;

    texture_sampler #(.ADDRESS_BITS(ADDRESS_BITS)) texture_sampler (
        .clk, .rst, .forget, .idle(sampler_idle), .sampler, .number,
        .level_write, .level_number, .level_first, .palette_write, .palette_index, .palette_colour,
        .credit, .sent(sends || follows), .in_valid(placed_valid), .in_mask(placed_mask), .in_half(placed_half), .in_last(placed_last),
        .in_level(placed_level), .in_positions(placed_positions),
        .ask_valid(sample_ask_valid), .ask_ready(ask_ready && !loading), .ask_addr(sample_ask_addr),
        .data_valid(data_valid && !loading), .data_ready(sample_data_ready), .data,
        .out_room(colours_room), .out_valid(step_valid), .out_mask(step_mask), .out_half(step_half), .out_last(step_last), .out_bilinear(step_bilinear),
        .out_opaque(step_opaque), .out_texels(step_texels), .out_neighbours(step_neighbours), .out_weights(step_weights)
    );

    // The light and the line of the groups whose steps are in the filter. Both are stored from the group's first quad until the light of
    // its last step is used.
    logic [2:0][7:0] light;
    logic [1:0]      light_line;
    logic            light_valid, light_room, light_gone;

    delay #(.WIDTH(1), .CLOCKS(texture_pkg::LIGHT)) light_delay (
        .clk, .enable(1'b1), .in(step_valid && step_last), .out(light_gone)
    );

    fifo #(.WIDTH(26), .DEPTH(GROUPS), .BLOCK(1'b1)) lights (
        .clk, .rst, .in_valid(sends && !second), .in_ready(light_room), .in_data({line, texture.light}),
        .out_valid(light_valid), .out_ready(light_gone), .out_data({light_line, light})
    );

    logic             lit_valid, lit_half, lit_last;
    logic [3:0]       lit_mask, lit_opaque;
    logic [3:0][COLOUR_BITS-1:0] lit_colours;

    texture_filter #(.FRACTIONS(FRACTIONS)) texture_filter (
        .clk, .rst, .dither, .in_valid(step_valid), .in_mask(step_mask), .in_half(step_half), .in_last(step_last), .in_bilinear(step_bilinear),
        .in_opaque(step_opaque), .in_texels(step_texels), .in_neighbours(step_neighbours), .in_weights(step_weights),
        .light, .line(light_line),
        .out_valid(lit_valid), .out_mask(lit_mask), .out_half(lit_half), .out_last(lit_last), .out_opaque(lit_opaque),
        .out_colours(lit_colours)
    );

    // The texture's rule for blending is delayed like the pixels, because the next texture may be loaded while the pixels are in the
    // filter.
    logic [3:0] lit_blend;

    delay #(.WIDTH(4), .CLOCKS(texture_pkg::FILTER)) blend_delay (
        .clk, .enable(1'b1), .in(sampler.blend), .out(lit_blend)
    );

    texture_collect #(.COLOUR_BITS(COLOUR_BITS)) texture_collect (
        .clk, .rst, .room(colours_room), .in_valid(lit_valid), .in_mask(lit_mask), .in_half(lit_half), .in_last(lit_last),
        .in_opaque(lit_opaque), .in_colours(lit_colours), .in_blend(lit_blend),
        .out_valid(colours_valid), .out_ready(group_gone && group_textured), .out_blend(blend), .out_opaque(opaque), .out_colours(colours)
    );

    wire _unused = &{1'b0, waiting_idle, light_room, light_valid, in_planes, texture.planes};
endmodule

`default_nettype wire

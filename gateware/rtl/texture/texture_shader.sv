// The colours of groups of eight pixels, some of which have a texture.
//
//            ┌─ pipeline_fifo: groups ─────────────────────────────────────────────────────────────────────────────┐
//   group ──▶┤                                                                                                     ├──▶ group, colours
//            └─ fifo: planes ─▶ quads ─▶ texture_place ─▶ credit_fifo ─▶ texture_sampler ─▶ texture_filter ─▶ fifo ─┘
//                                 │                                        ▲
//                                 └─▶ texture_loader ── texture, palette ──┘
//
// A group without a texture takes one clock. A group with a texture takes one clock for each half with a covered pixel (a quad of four
// pixels), with bilinear filtering one clock for each two pixels; more if its texels are in more than 2x2 blocks of the texture. A group
// with another texture than the one before waits until that one has left, and until texture_loader has read the texture's header and
// palette.
//
// The source of the groups is a pipeline that cannot be stopped. The pipeline sends groups only while `room` is high; a group arrives
// FLIGHT clocks after it is sent (see pipeline_fifo). Groups stay in order. A group without an opaque pixel is dropped. Output: a
// valid/ready stream. `idle` is high while no group is inside. `forget` (one clock, while idle) forgets the texels and the texture of
// earlier frames. `table_base` is the address of the table of the textures' addresses, in words of 16 bytes.

`default_nettype none

module texture_shader #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned GROUP_BITS   = 8,
    parameter int unsigned FLIGHT       = 5,
    // Most groups inside, a power of two. Each has one or two quads, and a quad takes some 60 clocks if no block is missing.
    parameter int unsigned GROUPS       = 64
) (
    input  wire                    clk,
    input  wire                    rst,
    input  wire                    forget,
    input  wire  [ADDRESS_BITS-1:0] table_base,
    output logic                   idle,
    output logic                   room,
    input  wire                    in_valid,
    input  wire  [GROUP_BITS-1:0]  in_group,
    input  wire  [7:0]             in_mask,
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
    output logic [7:0]             out_opaque, // lanes that no transparent texel hides
    output logic [7:0][15:0]       out_colours,
    output logic [3:0]             out_blend   // rule by which the group is blended with the picture, see texture_blend; 0 for none
);
    // Groups that wait for their colours.
    logic             is_textured, group_valid, group_textured, group_gone, colours_valid, groups_room, waiting_idle, waiting_room;
    logic [15:0]      group_colour;
    logic [7:0]       opaque;
    logic [7:0][15:0] colours;

    assign is_textured = in_texture.texture != '0;

    pipeline_fifo #(.WIDTH(GROUP_BITS + 17), .DEPTH(GROUPS), .FLIGHT(FLIGHT)) groups (
        .clk, .rst, .idle, .room(groups_room), .in_valid, .in_data({is_textured, in_colour, in_group}),
        .out_valid(group_valid), .out_ready(group_gone), .out_data({group_textured, group_colour, out_group})
    );

    logic [3:0] blend;

    assign out_valid   = group_valid && (!group_textured || colours_valid && opaque != '0);
    assign group_gone  = !group_textured ? out_ready : colours_valid && (opaque == '0 || out_ready);
    assign out_opaque  = group_textured ? opaque : '1;
    assign out_colours = group_textured ? colours : {8{group_colour}};
    assign out_blend   = group_textured ? blend : '0;

    // Groups with a texture wait for their positions. The FIFO is wide, so it holds fewer groups than there may be inside.
    localparam int unsigned WAITING_BITS = 8 + $bits(in_depth) + $bits(in_texture);

    logic                         waiting_valid, waiting_gone;
    logic [7:0]                   mask;
    records_pkg::plane_t          depth;
    records_pkg::texture_planes_t texture;

    assign room = groups_room && waiting_room;

    pipeline_fifo #(.WIDTH(WAITING_BITS), .DEPTH(32), .FLIGHT(FLIGHT)) waiting (
        .clk, .rst, .idle(waiting_idle), .room(waiting_room), .in_valid(in_valid && is_textured), .in_data({in_mask, in_depth, in_texture}),
        .out_valid(waiting_valid), .out_ready(waiting_gone), .out_data({mask, depth, texture})
    );

    // Sends the quads of the first waiting group, one per clock, if its texture is the current one; otherwise changes the texture as soon as
    // all quads have left the sampler.
    typedef enum logic [1:0] {EMPTY, START, LOAD, SEND} state_t;
    state_t state;

    logic [7:0] number;
    logic       second, half, sends, ends, credit, place_idle, sampler_idle, same, loaded;
    logic [3:0] quad;

    assign half  = second || mask[3:0] == '0;
    assign quad  = half ? mask[7:4] : mask[3:0];
    assign ends  = half || mask[7:4] == '0;
    assign sends = state == SEND && waiting_valid && same && credit;

    assign waiting_gone = sends && ends;
    assign same         = texture.texture == number;

    always_ff @(posedge clk) begin
        if (sends) second <= !ends;

        case (state)
            EMPTY: if (waiting_valid && place_idle && sampler_idle) begin
                number <= texture.texture;
                state  <= START;
            end
            START:   state <= LOAD;
            LOAD:    if (loaded) state <= SEND;
            default: if (waiting_valid && !same) state <= EMPTY;
        endcase

        if (rst || forget) state <= EMPTY;
        if (rst) second <= 1'b0;
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

    logic                   placed_valid, placed_half, placed_last, quad_valid, quad_ready, quad_half, quad_last;
    logic [3:0]             placed_mask, placed_level, quad_mask, quad_level;
    logic [1:0][3:0][20:0]  placed_positions, quad_positions;

    texture_place texture_place (
        .clk, .rst, .sampler, .in_valid(sends), .in_mask(quad), .in_half(half), .in_first(!second), .in_last(ends),
        .in_planes({texture.planes, depth}), .in_linear(texture.linear), .in_range(texture.range), .in_periods(texture.periods),
        .out_valid(placed_valid), .out_mask(placed_mask), .out_half(placed_half), .out_last(placed_last), .out_level(placed_level),
        .out_positions(placed_positions)
    );

    credit_fifo #(.WIDTH(4 + 1 + 1 + 4 + 8 * 21), .DEPTH(32)) quads (
        .clk, .rst, .idle(place_idle), .credit, .sent(sends), .in_valid(placed_valid),
        .in_data({placed_mask, placed_half, placed_last, placed_level, placed_positions}),
        .out_valid(quad_valid), .out_ready(quad_ready), .out_data({quad_mask, quad_half, quad_last, quad_level, quad_positions})
    );

    logic                        step_valid, step_half, step_last, step_bilinear;
    logic [3:0]                  step_mask, step_opaque;
    logic [3:0][15:0]            step_texels;
    logic [1:0][3:0][15:0]       step_neighbours;
    logic [1:0][1:0][3:0]        step_weights;

    texture_sampler #(.ADDRESS_BITS(ADDRESS_BITS)) texture_sampler (
        .clk, .rst, .forget, .idle(sampler_idle), .sampler, .number,
        .level_write, .level_number, .level_first, .palette_write, .palette_index, .palette_colour,
        .in_valid(quad_valid), .in_ready(quad_ready), .in_mask(quad_mask), .in_half(quad_half), .in_last(quad_last),
        .in_level(quad_level), .in_positions(quad_positions),
        .ask_valid(sample_ask_valid), .ask_ready(ask_ready && !loading), .ask_addr(sample_ask_addr),
        .data_valid(data_valid && !loading), .data_ready(sample_data_ready), .data,
        .out_valid(step_valid), .out_mask(step_mask), .out_half(step_half), .out_last(step_last), .out_bilinear(step_bilinear),
        .out_opaque(step_opaque), .out_texels(step_texels), .out_neighbours(step_neighbours), .out_weights(step_weights)
    );

    // The light of the groups whose steps are in the filter. It waits from the group's first quad until its last step is lit.
    logic [2:0][7:0] light;
    logic            light_valid, light_room, light_gone;

    delay #(.WIDTH(1), .CLOCKS(texture_pkg::LIGHT)) light_delay (
        .clk, .enable(1'b1), .in(step_valid && step_last), .out(light_gone)
    );

    fifo #(.WIDTH(24), .DEPTH(GROUPS)) lights (
        .clk, .rst, .in_valid(sends && !second), .in_ready(light_room), .in_data(texture.light),
        .out_valid(light_valid), .out_ready(light_gone), .out_data(light)
    );

    logic             lit_valid, lit_half, lit_last;
    logic [3:0]       lit_mask, lit_opaque;
    logic [3:0][15:0] lit_colours;

    texture_filter texture_filter (
        .clk, .rst, .in_valid(step_valid), .in_mask(step_mask), .in_half(step_half), .in_last(step_last), .in_bilinear(step_bilinear),
        .in_opaque(step_opaque), .in_texels(step_texels), .in_neighbours(step_neighbours), .in_weights(step_weights),
        .light,
        .out_valid(lit_valid), .out_mask(lit_mask), .out_half(lit_half), .out_last(lit_last), .out_opaque(lit_opaque),
        .out_colours(lit_colours)
    );

    // The blend of the texture comes along with the pixels, because the next texture may be loaded while they are in the filter.
    logic [3:0] finished_blend;

    delay #(.WIDTH(4), .CLOCKS(texture_pkg::FILTER + 1)) blend_delay (
        .clk, .enable(1'b1), .in(sampler.blend), .out(finished_blend)
    );

    // Collects the pixels of a group.
    logic             finished, colours_room;
    logic [7:0]       found, found_before;
    logic [7:0][15:0] collected;

    assign found_before = finished ? '0 : found;

    always_ff @(posedge clk) begin
        finished <= lit_valid && lit_last;
        found    <= found_before;
        for (int i = 0; i < 8; i++)
            if (lit_valid && lit_half == 1'(i / 4) && lit_mask[i % 4]) begin
                found[i]     <= lit_opaque[i % 4];
                collected[i] <= lit_colours[i % 4];
            end
        if (rst) begin
            finished <= 1'b0;
            found    <= '0;
        end
    end

    // This FIFO only holds colours of groups that are in the FIFO of groups, so it is never full.
    fifo #(.WIDTH(4 + 8 + 8 * 16), .DEPTH(GROUPS)) finished_colours (
        .clk, .rst, .in_valid(finished), .in_ready(colours_room), .in_data({finished_blend, found, collected}),
        .out_valid(colours_valid), .out_ready(group_gone && group_textured), .out_data({blend, opaque, colours})
    );

    wire _unused = &{1'b0, waiting_idle, light_room, light_valid, colours_room};
endmodule

`default_nettype wire

// Reads the texels of pixels, through a cache of 16 KiB, 512 blocks of texels.
//
//   quad ─▶ texture_wrap ─▶ texture_choice ─┬─────────────────▶ texture_queue ─▶ texture_store ─▶ texture_texels ─▶ step
//           columns, rows    steps          └─▶ texture_tags ──┘    ▲            cached blocks    colours
//                                                    │ misses       │
//                                                    └─▶ texture_fetch ─▶ memory
//
// A quad is four neighbouring pixels of a row, at positions in the texture. A step contains the texels of some of these pixels: pixels that
// need at most 2x2 neighbouring blocks, which have 4x4 to 8x8 texels. With nearest filtering, a quad takes one step if its pixels need no
// other blocks; with bilinear filtering, it takes one step for each pair of lanes that has covered pixels, under the same condition. Each
// covered pixel of a quad is in exactly one step, and the steps have the order of the quads. Colours are read from memory without a check;
// `sampler` may have any value, and no value stalls the unit.
//
// Throughput one step per clock without misses; each missing block stalls the steps for 2 clocks, and its words are requested up to 250
// steps ahead. Latency 18 clocks without misses. Quads come from a pipeline that cannot be stopped: `sent` is high for one clock for each
// item of texture_wrap that enters the pipeline (texture_choice). Steps have no ready: they leave the queue while `out_room` is high, and
// at most nine are output after `out_room` has fallen. `idle` is high while no quad is in the pipeline or in this module; `sampler`, and
// the texture's `number`, must hold while `idle` is low. `forget` (one clock while `idle` is high) invalidates the cache in 128 clocks,
// during which quads wait; it is required after a texture has changed in memory, or after its number has been assigned to another texture.
// The palette and the addresses of the levels may be written while `idle` is high.
//
// Memory: a client of read_port.

`default_nettype none

module texture_sampler #(
    parameter int unsigned ADDRESS_BITS = 23
) (
    input  wire                          clk,
    input  wire                          rst,
    input  wire                          forget,
    output logic                         idle,
    input  texture_pkg::sampler_t        sampler,
    input  wire  [7:0]                   number,
    // Word address of the first block of a level.
    input  wire                          level_write,
    input  wire  [3:0]                   level_number,
    input  wire  [ADDRESS_BITS-1:0]      level_first,
    input  wire                          palette_write,
    input  wire  [7:0]                   palette_index,
    input  wire  [15:0]                  palette_colour,
    // Quads: the mask of the covered pixels, never 0; whether the quad is in lanes 4 to 7 of its group; whether it is the group's last
    // quad.
    output logic                         credit,
    input  wire                          sent,
    input  wire                          in_valid,
    input  wire  [3:0]                   in_mask,
    input  wire                          in_half,
    input  wire                          in_last,
    input  wire  [3:0]                   in_level,
    input  wire  [1:0][3:0][17:0]        in_positions, // axis, lane: a texture_pkg::position_t
    output logic                         ask_valid,
    input  wire                          ask_ready,
    output logic [ADDRESS_BITS-1:0]      ask_addr,
    input  wire                          data_valid,
    output logic                         data_ready,
    input  wire  [127:0]                 data,
    // Steps.
    input  wire                          out_room,
    output logic                         out_valid,
    output logic [3:0]                   out_mask,     // lanes of the quad that are in the step
    output logic                         out_half,
    output logic                         out_last,     // the last step of the last quad of a group
    output logic                         out_bilinear,
    output logic [3:0]                   out_opaque,   // lanes that are not transparent
    output logic [3:0][15:0]             out_texels,   // nearest: the colour of each lane
    // Bilinear, for lanes 0 and 1, or for 2 and 3: the colours at (u, v), (u+1, v), (u, v+1), (u+1, v+1); the weights of u+1 and of v+1.
    output logic [1:0][3:0][15:0]        out_neighbours,
    output logic [1:0][1:0][3:0]         out_weights
);
    // Number of clocks from the head of the queue to the output.
    localparam int unsigned LATENCY = 7;

    logic choice_busy, queue_idle, tags_busy, sweeping, passing;

    always_ff @(posedge clk) begin
        idle <= !sent && !choice_busy && !tags_busy && queue_idle && !passing;
        if (rst) idle <= 1'b1;
    end

    logic               item_valid;
    texture_pkg::item_t item;

    texture_wrap wrapping (
        .clk, .rst, .side_log2(sampler.side_log2), .wrap(sampler.wrap), .bilinear(sampler.bilinear),
        .in_valid, .in_mask, .in_half, .in_last, .in_level, .in_positions, .out_valid(item_valid), .out_item(item)
    );

    logic                 queue_room, step_room, step_valid;
    texture_pkg::step_t   step;
    logic [1:0][3:0][7:0] step_places;
    logic [3:0]           step_level;

    // No step is accepted while the tags are cleared. This costs no time: the tags are clear long before the first quad after `forget`
    // arrives.
    assign step_room = queue_room && !sweeping;

    texture_choice choice (
        .clk, .rst, .format(sampler.format), .bilinear(sampler.bilinear), .busy(choice_busy), .credit, .sent, .in_valid(item_valid),
        .in_item(item), .step_room, .out_valid(step_valid), .out_step(step), .out_places(step_places), .out_level(step_level)
    );

    logic                 places_valid, missed_valid;
    logic [3:0][6:0]      places;
    logic [3:0]           missed;
    texture_pkg::blocks_t blocks;

    texture_tags tags (
        .clk, .rst, .forget, .sweeping, .busy(tags_busy), .format(sampler.format), .bilinear(sampler.bilinear), .number,
        .in_valid(step_valid), .in_served(step.served), .in_parity(step.parity), .in_places(step_places), .in_level(step_level),
        .at_valid(places_valid), .at_places(places),
        .out_valid(missed_valid), .out_missed(missed), .out_blocks(blocks)
    );

    texture_fetch #(.ADDRESS_BITS(ADDRESS_BITS)) fetch (
        .clk, .rst, .format(sampler.format), .width_log2(sampler.side_log2[0]), .level_write, .level_number, .level_first,
        .in_valid(missed_valid && missed != '0), .in_missed(missed), .in_blocks(blocks), .ask_valid, .ask_ready, .ask_addr
    );

    logic               fills, fill_second, reads;
    logic [1:0]         fill_class;
    texture_pkg::step_t head;
    logic [3:0][6:0]    head_places;

    texture_queue queue (
        .clk, .rst, .idle(queue_idle), .room(queue_room), .step_valid, .in_step(step), .places_valid, .in_places(places), .missed_valid,
        .in_missed(missed), .data_valid, .data_ready, .fills, .fill_class, .fill_second, .out_room, .reads, .head_step(head),
        .head_places
    );

    logic [1:0][3:0][15:0] values;
    logic [1:0][15:0]      seconds, second_colours;
    logic [1:0][3:0][1:0]  quarters, late_quarters;
    logic [1:0][1:0]       nearest, late_nearest;
    logic [1:0]            opaque, seconds_opaque;

    texture_store store (
        .clk, .format(sampler.format), .bilinear(sampler.bilinear), .fills, .fill_class, .fill_second, .data, .parity(head.parity),
        .x(head.x), .y(head.y), .places(head_places), .out_values(values), .out_seconds(seconds)
    );

    for (genvar j = 0; j < 2; j++) begin : neighbours
        for (genvar i = 0; i < 4; i++) begin : each
            assign quarters[j][i] = {head.y[2*j+i/2][0], head.x[2*j+i%2][0]};
        end

        assign nearest[j] = head.upper[j];
    end

    delay #(.WIDTH(20), .CLOCKS(LATENCY - 2)) order (
        .clk, .enable(1'b1), .in({quarters, nearest}), .out({late_quarters, late_nearest})
    );

    texture_texels texels (
        .clk, .format(sampler.format), .cut_out(sampler.cut_out), .key(sampler.key), .palette_write, .palette_index, .palette_colour,
        .in_values(values), .in_seconds(seconds),
        .in_quarters(late_quarters), .in_nearest(late_nearest), .out_neighbours, .out_seconds(second_colours), .out_opaque(opaque),
        .out_seconds_opaque(seconds_opaque)
    );

    // The other fields of a step are delayed until its texels are valid.
    logic [LATENCY-1:0] valid;
    logic [3:0]         mask;

    assign passing      = reads || valid != '0;
    assign out_valid    = valid[LATENCY-1];
    assign out_bilinear = sampler.bilinear;
    assign mask         = !sampler.bilinear ? head.served : head.second ? {head.served[1:0], 2'b00} : {2'b00, head.served[1:0]};

    always_ff @(posedge clk) begin
        valid <= {valid[LATENCY-2:0], reads};
        if (rst) valid <= '0;
    end

    delay #(.WIDTH(22), .CLOCKS(LATENCY)) fields (
        .clk, .enable(1'b1), .in({mask, head.half, head.last, head.weights}), .out({out_mask, out_half, out_last, out_weights})
    );

    for (genvar j = 0; j < 2; j++) begin : lanes
        assign out_texels[2*j]     = out_neighbours[j][0];
        assign out_texels[2*j + 1] = second_colours[j];
    end

    // With bilinear filtering, a pair is in lanes 0 and 1, or 2 and 3.
    assign out_opaque = sampler.bilinear ? {opaque, opaque} : {seconds_opaque[1], opaque[1], seconds_opaque[0], opaque[0]};

    wire _unused = &{1'b0, sampler.last_level, sampler.blend};
endmodule

`default_nettype wire

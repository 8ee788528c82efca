// The tags of the cache: looks up the blocks of steps, and replaces them.
//
//   step ─▶ blocks ─▶ places in the cache ─▶ tags read and replaced ─▶ compared ─▶ misses
//
// The cache is direct mapped, with 128 places for each class of blocks; all places together hold 32 columns by 16 rows of blocks. The high
// bits of a block's column are XORed into the row of its place, and the high bits of its row into the column of its place, so that the
// blocks of a row of a wide texture, or of a column of a high texture, have different places. The level and the texture's number are XORed
// too, for neighbouring levels and textures. A tag contains all these bits, so it identifies its block. A tag is read and replaced by one
// access, and compared one clock later, so a step sees the tags as the previous steps have left them.
//
// `forget` (one clock while no step is inside) invalidates all tags in 128 clocks, during which `sweeping` is high and no step may arrive;
// a reset does the same. Latency: `at_valid` with the places 2 clocks after the step, `out_valid` with the misses 3 clocks after it.
// Throughput one step per clock.

`default_nettype none

module texture_tags (
    input  wire                    clk,
    input  wire                    rst,
    input  wire                    forget,
    output logic                   sweeping,
    output logic                   busy,
    input  wire  [1:0]             format,
    input  wire                    bilinear,
    input  wire  [7:0]             number,
    input  wire                    in_valid,
    input  wire  [3:0]             in_served,
    input  wire  [1:0][3:0]        in_parity,
    input  wire  [1:0][3:0][7:0]   in_places,
    input  wire  [3:0]             in_level,
    output logic                   at_valid,
    output logic [3:0][6:0]        at_places,  // in the cache, by class
    output logic                   out_valid,
    output logic [3:0]             out_missed, // by class
    output texture_pkg::blocks_t   out_blocks
);
    localparam int unsigned PLACE_BITS = 7;
    localparam int unsigned TAG_BITS   = 1 + 8 + 4 + 4 + 3;

    // The step, and the slots that its pixels use.
    logic                 valid;
    logic [3:0]           used, level;
    logic [1:0][3:0]      parity;
    logic [1:0][3:0][7:0] places;

    always_ff @(posedge clk) begin
        valid  <= in_valid && !rst;
        used   <= bilinear ? {{2{in_served[1]}}, {2{in_served[0]}}} : in_served;
        parity <= in_parity;
        places <= in_places;
        level  <= in_level;
    end

    // The classes that the pixels need, and for each axis and parity the block column or row: that of the first slot in use with this
    // parity.
    texture_pkg::blocks_t blocks;
    logic [3:0]           needed, needs;
    logic [1:0][1:0][7:0] chosen;
    logic [1:0][1:0][1:0] first;
    logic [2:0]           mix;

    always_comb begin
        needs = '0;
        for (int class_of = 0; class_of < 4; class_of++)
            for (int i = 0; i < 4; i++)
                for (int k = 0; k < 4; k++)
                    if (used[i] && used[k] && (i == k || bilinear && i / 2 == k / 2)
                            && parity[0][i] == 1'(class_of) && parity[1][k] == 1'(class_of / 2)) needs[class_of] = 1'b1;
        for (int axis = 0; axis < 2; axis++)
            for (int odd = 0; odd < 2; odd++) begin
                first[axis][odd] = 2'd3;
                for (int i = 2; i >= 0; i--) if (used[i] && parity[axis][i] == 1'(odd)) first[axis][odd] = 2'(i);
                chosen[axis][odd] = places[axis][first[axis][odd]];
            end
    end

    always_ff @(posedge clk) begin
        at_valid      <= valid && !rst;
        needed        <= needs;
        blocks.places <= chosen;
        blocks.level  <= level;
        mix           <= {level[0], level[1], level[2]} ^ number[2:0];
    end

    logic [PLACE_BITS-1:0]    swept;
    logic [3:0][TAG_BITS-1:0] entries, found, replaced;
    logic [3:0]               writes, missing;

    for (genvar i = 0; i < 4; i++) begin : classes
        logic [7:1] column, row;
        logic [3:0] column_place;
        logic [2:0] row_place;

        // The place does not include the parity, which is bit 0 for blocks of four texels and bit 1 for blocks of eight texels.
        assign column       = blocks.places[0][i % 2][7:1];
        assign row          = blocks.places[1][i / 2][7:1];
        assign column_place = {column[4:2], format != 2'd0 ? column[5] : column[1]} ^ {row[4], row[5], row[6], row[7]};
        assign row_place    = {row[3:2], format[1] ? row[4] : row[1]} ^ {column[5], column[6], column[7]} ^ mix;
        assign at_places[i] = sweeping ? swept : {row_place, column_place};
        assign entries[i]   = {!sweeping, number, blocks.level, row[7:4], column[7:5]};
        assign writes[i]    = sweeping || at_valid && needed[i];

        (* ram_style = "distributed" *) logic [TAG_BITS-1:0] memory [0:2**PLACE_BITS-1];

        always_ff @(posedge clk) begin
            found[i]    <= memory[at_places[i]];
            replaced[i] <= entries[i];
            if (writes[i]) memory[at_places[i]] <= entries[i];
        end

        logic hit;

        equal #(.WIDTH(TAG_BITS)) compared (.a(found[i]), .b(replaced[i]), .same(hit));

        assign out_missed[i] = missing[i] && !hit;
    end

    assign busy = valid || at_valid || out_valid;

    always_ff @(posedge clk) begin
        out_valid  <= at_valid && !rst;
        missing    <= needed;
        out_blocks <= blocks;

        if (sweeping) begin
            swept    <= swept + 1'b1;
            sweeping <= swept != '1;
        end
        if (forget) sweeping <= 1'b1;
        if (rst) begin
            swept    <= '0;
            sweeping <= 1'b1;
        end
    end
endmodule

`default_nettype wire

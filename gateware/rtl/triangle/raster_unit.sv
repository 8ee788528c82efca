// Draws a frame, band by band, from the descriptors (triangles after the setup) and the band lists (the numbers of the
// descriptors in each band), which the geometry unit and the firmware have written to memory.
//
//                                                                             ┌─▶ write_port 0 ─┐
//   lists, descriptors ──▶ list_reader ─┬▶ triangle_raster ──┬▶ band_buffer ──┴─▶ write_port 1 ─┴─▶ frame, depth
//                                       └▶ line_raster ──────┤
//   pixels of a field, from a raymarcher ────────────────────┘
//
// `start` (one clock, not while `busy`) begins a frame. The parameters must hold until `done` (one clock), when the frame is in
// memory. The time of a band is the time for its groups of eight pixels, plus about 16 clocks until its flush begins. During these 16
// clocks, descriptors are read ahead and the first triangles of the next band are prepared. `restart` (any time) cancels the frame; the
// next start must wait until the unit is `ready` and read_port is idle.
//
// With FIELDS, a raymarcher outside of this unit draws a distance field into each frame with `field_source.enable`.
// `field_sink.start` begins the field. In each band `open` admits the field's pixels until the raymarcher raises `done`; then the
// triangles and lines of the band are drawn, so that they may be blended with the field. At the end of the band `next` makes the raymarcher
// continue with the next band, whose first rays it has computed in the meantime. `compose` selects how the luminances of two eyes become
// colours, see band_flush.
//
// With LINES, a descriptor may be a piece of a line (records_pkg::stored_piece_t). Triangles and pieces are drawn in the order of
// the lists: when a piece follows a triangle, or a triangle follows a piece, the next item waits about 30 clocks until the last group of
// the previous items is taken.
//
// With SKY, `flags.sky` draws the sky (band_sky) behind the triangles, in a frame without a field. Each band takes the sky's colours while
// it is flushed, or, with `flags.sky_first` (TEXTURE only), as groups before its triangles, which textures that are blended need.
//
// With FOG, `flags.fog` draws triangles in fog.
//
// With `flags.dither` the colours of smooth triangles, textures, sky and fog are dithered, otherwise rounded to nearest.
//
// With AVERAGE, `flags.average` draws four samples for each pixel: the flush averages the samples of a picture of `flags.size` to a picture
// of half the width and height. With `flags.quarter` this picture is a quarter, `flags.right` and `flags.lower`, of the frame, which has the
// width and height `flags.size`. All words are written, and no depths.
//
// With TEXTURE, triangles may have textures, opaque or blended with the picture drawn so far. `parameters.textures` is the address of
// their table (docs/textures.md, "Textures of a frame").
//
// Without TRIANGLES, triangle_raster is not built, and a descriptor that is no piece of a line counts as damaged. With neither TRIANGLES
// nor LINES, list_reader is not built either: frames have fields only, `flags.first` and `flags.second` must be low, and the unit reads no
// memory.
//
// `slot` is the number of the frame buffer into which the frame is drawn. Only words that can differ from the last frame in the same slot
// are written. `whole` writes all words; `whole` is required when the contents of the frame buffer are unknown (after a change of its
// address, of the picture's size or of the clear colour, or after a write by the CPU). `depth` implies `whole`. All words are also written
// if the slot holds no complete frame: after reset, and after a cancelled frame.
//
// Memory: clients of read_ports, three for lists and descriptors and, with TEXTURE, one for texels; and two native write ports, one for the
// words in even banks of the DDR3 memory and one for the words in odd banks. 128 successive words of a frame lie in one bank, and the
// following words in the next bank. A port only switches to another bank when the previous bank is idle, a dozen clocks later. With two
// ports, one port writes while the other port waits for its bank.

`default_nettype none

module raster_unit #(
    parameter  bit          TRIANGLES    = 1'b1,
    parameter  bit          SMOOTH       = 1'b0,
    parameter  bit          TEXTURE      = 1'b0,
    parameter  bit          SKY          = 1'b0,
    parameter  bit          FOG          = 1'b0,
    parameter  bit          FIELDS       = 1'b0,
    parameter  bit          LINES        = 1'b0,
    parameter  bit          DEPTHS       = 1'b1,
    parameter  bit          AVERAGE      = 1'b0,
    localparam int unsigned ADDRESS_BITS = triangle_registers_pkg::ADDRESS_BITS,
    localparam int unsigned COUNT_BITS   = triangle_registers_pkg::COUNT_BITS
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       restart,
    output logic                      ready,
    input  wire                       start,
    output logic                      busy,
    output logic                      done,
    // Valid with `done`: high if a band list was damaged (see list_reader), or if a descriptor with groups outside of the
    // picture was skipped.
    output logic                      list_error,
    input  wire triangle_registers_pkg::raster_flags_t flags,
    input  wire triangle_registers_pkg::raster_t parameters,
    input  wire triangle_registers_pkg::sky_t sky,
    input  wire triangle_registers_pkg::fog_t fog,
    // Link to a raymarcher, which sends each pixel as a group in which only this pixel is covered.
    input  wire triangle_registers_pkg::field_source_t field_source,
    output triangle_registers_pkg::field_sink_t field_sink,
    // Memory.
    output logic [3:0]                ask_valid,
    input  wire  [3:0]                ask_ready,
    output logic [4*ADDRESS_BITS-1:0] ask_addr,
    input  wire  [3:0]                data_valid,
    output logic [3:0]                data_ready,
    input  wire  [4*128-1:0]          data,
    output triangle_registers_pkg::write_request_t even_write_request,
    input  wire triangle_registers_pkg::write_answer_t even_write_answer,
    output triangle_registers_pkg::write_request_t odd_write_request,
    input  wire triangle_registers_pkg::write_answer_t odd_write_answer,
    output triangle_registers_pkg::events_t events
);
    // Values derived from the size of the picture: the number of its last band, and the numbers of rows of a band, of groups of a row, and
    // of 128-bit words of a band.
    logic [5:0]  last_band, rows;
    logic [7:0]  stride;
    logic [10:0] words;

    // `flags.size` must not change during a frame, nor in the clock before `start`.
    always_ff @(posedge clk) {last_band, rows, stride, words} <= band_pkg::cut(flags.size);

    // Numbers of words in memory from the beginning of the frame to the beginning of the quarter, from a band to the next band, and between
    // the lines of a band.
    logic                    averages;
    logic [ADDRESS_BITS-1:0] quarter_words;
    logic [10:0]             band_words;
    logic [7:0]              gap;

    assign averages = AVERAGE && flags.average;

    if (AVERAGE) begin : samples
        localparam int unsigned LARGEST = picture_pkg::FRAME_WORDS << 4;
        localparam int unsigned STRIDE  = picture_pkg::WIDTH / 2;

        always_comb begin
            band_words    = !flags.average ? words : flags.quarter ? words >> 1 : words >> 2;
            gap           = flags.quarter ? stride >> 1 : '0;
            quarter_words = !(flags.average && flags.quarter) ? '0
                          : ADDRESS_BITS'((flags.lower ? LARGEST / 2 : 0) + (flags.right ? STRIDE / 2 : 0));
        end
    end else begin : pixels
        assign quarter_words = '0;
        assign band_words    = words;
        assign gap           = '0;
    end

    typedef enum logic [2:0] {IDLE, FIELD, SKY_FIRST, DRAW, HAND_OVER, FLUSH} state_t;
    state_t state;

    logic [5:0]              band;
    logic [9:0]              first_row;
    logic [ADDRESS_BITS-1:0] base, band_depth_base;
    logic                    clearing, flushed, in_memory, band_ready, begins, drawn, has_field, has_sky, sky_first, sky_drawn;
    state_t                  first_state;

    // For each slot, whether its frame buffer holds a complete frame. The bit of a slot is 0 while the slot is drawn.
    logic [1:0] known;
    logic       all_words;

    always_ff @(posedge clk) begin
        if (state == IDLE) begin
            all_words <= flags.whole || has_sky || averages || !known[flags.slot];
            if (start) known[flags.slot] <= 1'b0;
        end
        if (state == FLUSH && in_memory) known[flags.slot] <= 1'b1;
        if (rst) known <= '0;
    end

    assign busy  = state != IDLE;
    assign ready = !clearing && in_memory;
    assign begins = state == IDLE && start;

    assign has_field        = FIELDS && field_source.enable;
    assign has_sky          = SKY && flags.sky && !has_field;
    assign sky_first        = TEXTURE && has_sky && flags.sky_first;
    assign first_state      = has_field ? FIELD : sky_first ? SKY_FIRST : DRAW;
    assign field_sink.start = begins && has_field;
    assign field_sink.open  = state == FIELD;
    assign field_sink.next  = state == HAND_OVER && band_ready && has_field;

    always_ff @(posedge clk) begin
        done <= 1'b0;
        case (state)
            IDLE: begin
                band            <= '0;
                first_row       <= '0;
                base            <= parameters.frame[4 +: ADDRESS_BITS] + quarter_words;
                band_depth_base <= parameters.depth[4 +: ADDRESS_BITS];
                if (start) state <= first_state;
            end
            FIELD: if (field_source.done) state <= DRAW;
            SKY_FIRST: if (sky_drawn) state <= DRAW;
            DRAW: if (drawn) state <= HAND_OVER;
            HAND_OVER: if (band_ready) begin
                band            <= band + 1'b1;
                first_row       <= first_row + 10'(rows);
                base            <= base + ADDRESS_BITS'(band_words);
                band_depth_base <= band_depth_base + (ADDRESS_BITS'(words) << 1);
                state           <= band == last_band ? FLUSH : first_state;
            end
            default: if (in_memory) begin
                done  <= 1'b1;
                state <= IDLE;
            end
        endcase
        if (rst || restart) begin
            state <= IDLE;
            done  <= 1'b0;
        end
    end

    // A group of one pixel, of a line or of the field.
    typedef struct packed {
        logic [1:0]  halves;
        logic [10:0] row;
        logic [5:0]  line;
        logic [7:0]  column;
        logic [7:0]  mask;
        logic [17:0] code;
        logic [15:0] colour;
    } pixel_t;

    // `from_line` is high while descriptors are pieces of lines, and groups come from line_raster.
    logic   from_line, line_valid, line_ready;
    pixel_t line_pixel;

    // Each band is drawn in two steps: first the pixels of the field (`field_source`), then its triangles (`drawn_*`) and lines.
    logic            group_valid, group_ready;
    logic            drawn_valid, drawn_ready;
    logic [10:0]     drawn_row;
    logic [5:0]      drawn_line;
    logic [7:0]      drawn_column;
    logic [7:0]      drawn_mask;
    logic [8*18-1:0] drawn_codes;
    logic [8*16-1:0] drawn_colours;
    logic [1:0]      group_halves;
    logic [10:0]     group_row;
    logic [5:0]      group_line;
    logic [7:0]      group_column;
    logic [7:0]      group_mask;
    logic [8*18-1:0] group_codes;
    logic [8*16-1:0] group_colours;
    // Blended pixels. Only triangles are blended.
    logic            drawn_asks, drawn_blended, group_asks, group_blended, answer_valid;
    logic [7:0]      answer_lanes;
    logic [2:0]      behind_lane;
    logic [15:0]     behind;

    triangle_registers_pkg::events_t walk_events, band_events;

    if (TRIANGLES || LINES) begin : descriptors
        logic        item_valid, item_ready, band_ends, triangle_valid, triangle_ready, raster_idle;
        records_pkg::descriptor_t descriptor;
        logic [triangle_pkg::planes_bits(SMOOTH, TEXTURE)-1:0] planes;

        // The first row and the parity of the band whose triangles are read, which is the current band or the next band.
        logic [9:0] read_row;
        logic       read_odd;

        // `stray` is high for a descriptor that is skipped, because its groups are outside of the picture or the build has no TRIANGLES.
        logic stray, list_damaged;
        // `is_line` is high for a piece of a line, and `piece_taken` is high in the clock after line_raster has taken the piece.
        logic is_line, piece_taken, line_idle;

        assign stray = !TRIANGLES || descriptor.group_left > descriptor.group_start || descriptor.group_start > descriptor.group_right
                    || descriptor.group_right >= stride;

        // The item that ends a band is taken only while that band is drawn, so descriptors are read at most one band ahead.
        assign triangle_valid = item_valid && !band_ends && !stray && !is_line && !from_line;
        assign item_ready     = band_ends ? read_odd == band[0] : is_line ? piece_taken : triangle_ready && !from_line;
        assign drawn          = read_odd != band[0] && raster_idle && line_idle;

        always_ff @(posedge clk) begin
            list_error <= !begins && (list_error || list_damaged || item_valid && !band_ends && stray && !is_line);
            if (rst) list_error <= 1'b0;

            if (begins) begin
                read_row <= '0;
                read_odd <= 1'b0;
            end else if (item_valid && item_ready && band_ends) begin
                read_row <= read_row + 10'(rows);
                read_odd <= !read_odd;
            end
        end

        list_reader #(.ADDRESS_BITS(ADDRESS_BITS), .COUNT_BITS(COUNT_BITS), .SMOOTH(SMOOTH), .TEXTURE(TEXTURE)) list_reader (
            .clk, .rst(rst || restart), .start(begins), .forget(state == IDLE), .last_band,
            .present({flags.second, flags.first}),
            .list_base({parameters.lists[1][4 +: ADDRESS_BITS], parameters.lists[0][4 +: ADDRESS_BITS]}),
            .descriptor_base({parameters.descriptors[1][4 +: ADDRESS_BITS], parameters.descriptors[0][4 +: ADDRESS_BITS]}),
            .counts(parameters.count), .list_shift(parameters.list_shift),
            .list_error(list_damaged),
            .ask_valid(ask_valid[2:0]), .ask_ready(ask_ready[2:0]), .ask_addr(ask_addr[3*ADDRESS_BITS-1:0]),
            .data_valid(data_valid[2:0]), .data_ready(data_ready[2:0]), .data(data[3*128-1:0]),
            .out_valid(item_valid), .out_ready(item_ready), .out_end(band_ends), .out_descriptor(descriptor),
            .out_planes(planes)
        );

        if (TRIANGLES) begin : triangles
            triangle_raster #(.SMOOTH(SMOOTH), .TEXTURE(TEXTURE), .FOG(FOG)) triangle_raster (
                .clk, .rst(rst || restart), .odd(band[0]), .rows, .stride, .idle(raster_idle), .events(walk_events),
                .triangle_valid, .triangle_ready, .triangle_y0(read_row), .triangle_odd(read_odd), .triangle_descriptor(descriptor),
                .triangle_planes(planes), .has_fog(flags.fog), .fog, .dither(flags.dither),
                .first_row(first_row[1:0]), .forget(begins), .texture_table(parameters.textures[4 +: ADDRESS_BITS]),
                .ask_valid(ask_valid[3]), .ask_ready(ask_ready[3]), .ask_addr(ask_addr[3*ADDRESS_BITS +: ADDRESS_BITS]),
                .data_valid(data_valid[3]), .data_ready(data_ready[3]), .data(data[3*128 +: 128]),
                .group_valid(drawn_valid), .group_ready(drawn_ready), .group_row(drawn_row), .group_line(drawn_line),
                .group_column(drawn_column), .group_mask(drawn_mask), .group_codes(drawn_codes), .group_colours(drawn_colours),
                .group_asks(drawn_asks), .group_blended(drawn_blended), .answer_valid, .answer_lanes, .behind_lane, .behind
            );
        end else begin : lines_alone
            assign triangle_ready = 1'b1;
            assign raster_idle    = 1'b1;
            assign walk_events    = '0;
            assign {drawn_valid, drawn_row, drawn_line, drawn_column, drawn_mask, drawn_codes, drawn_colours} = '0;
            assign {drawn_asks, drawn_blended, behind_lane} = '0;

            assign {ask_valid[3], ask_addr[3*ADDRESS_BITS +: ADDRESS_BITS], data_ready[3]} = '0;

            wire _unused_answer = &{1'b0, answer_valid, answer_lanes, behind};
            wire _unused = &{1'b0, triangle_valid, descriptor, fog, planes, drawn_ready, ask_ready[3], data_valid[3], data[3*128 +: 128]};
        end

        if (LINES) begin : lines
            records_pkg::stored_piece_t stored;
            logic              piece_valid, piece_ready;

            assign stored  = descriptor;
            assign is_line = stored.mark == records_pkg::PIECE_MARK;

            // The descriptor stays at the input until the clock after line_raster has taken its piece, so that no path leads from the walk
            // along a line to list_reader.
            assign piece_valid = item_valid && !band_ends && is_line && from_line && read_odd == band[0] && !piece_taken;

            always_ff @(posedge clk) begin
                piece_taken <= piece_valid && piece_ready;
                if (item_valid && !band_ends)
                    from_line <= from_line ? is_line || !line_idle : is_line && read_odd == band[0] && raster_idle;

                if (rst || restart) {piece_taken, from_line} <= '0;
            end

            line_raster line_raster (
                .clk, .rst(rst || restart), .size(flags.size), .first_row(read_row), .idle(line_idle),
                .in_valid(piece_valid), .in_ready(piece_ready), .in_piece({stored.colour, stored.high, stored.low}),
                .group_valid(line_valid), .group_ready(line_ready), .group_row(line_pixel.row), .group_line(line_pixel.line),
                .group_column(line_pixel.column), .group_mask(line_pixel.mask), .group_code(line_pixel.code),
                .group_colour(line_pixel.colour)
            );

            assign line_pixel.halves = 2'b11;

            wire _unused = &{1'b0, stored};
        end else begin : triangles_alone
            assign {is_line, from_line, piece_taken, line_valid, line_pixel} = '0;
            assign line_idle = 1'b1;

            wire _unused = &{1'b0, line_ready};
        end
    end else begin : fields_alone
        assign {from_line, line_valid, line_pixel} = '0;
        assign drawn       = 1'b1;
        assign list_error  = 1'b0;
        assign walk_events = '0;
        assign {ask_valid, ask_addr, data_ready} = '0;
        assign {drawn_valid, drawn_row, drawn_line, drawn_column, drawn_mask, drawn_codes, drawn_colours} = '0;
        assign {drawn_asks, drawn_blended, behind_lane} = '0;
        wire _unused = &{1'b0, answer_valid, answer_lanes, behind, fog, ask_ready, data_valid, data, drawn_ready, line_ready};
    end

    // The colours of the sky, and its groups.
    logic            sky_valid, sky_flushed;
    logic [1:0]      sky_line;
    logic [23:0]     sky_colour;
    logic [8*16-1:0] sky_colours;
    pixel_t          sky_group;

    if (SKY) begin : with_sky
        logic sky_group_taken;

        band_sky #(.TWICE(AVERAGE && TEXTURE)) band_sky (
            .clk, .rst, .start(begins), .stride(averages && !sky_first ? stride >> 1 : stride), .twice(averages && sky_first), .sky,
            .out_valid(sky_valid), .out_ready(sky_flushed || sky_group_taken), .out_line(sky_line), .out_colour(sky_colour)
        );

        assign sky_group_taken = state == SKY_FIRST && sky_valid && group_ready;

        if (TEXTURE) begin : first
            assign sky_drawn = sky_group_taken && sky_group.row == words - 11'd1;
            assign sky_group.halves = 2'b11;
            assign sky_group.mask   = '1;
            assign sky_group.code   = '0;
            assign sky_group.colour = '0;

            for (genvar lane = 0; lane < 8; lane++) begin : lanes
                assign sky_colours[16*lane +: 16] = colour_pkg::rounded(sky_colour, colour_pkg::threshold(flags.dither, 2'(lane), sky_line));
            end

            always_ff @(posedge clk) begin
                if (sky_group_taken) begin
                    sky_group.row    <= sky_group.row + 1'b1;
                    sky_group.column <= sky_group.column == stride - 8'd1 ? '0 : sky_group.column + 1'b1;
                    sky_group.line   <= sky_group.line + 6'(sky_group.column == stride - 8'd1);
                end
                if (state != SKY_FIRST) {sky_group.row, sky_group.column, sky_group.line} <= '0;
            end
        end else begin : flushed_alone
            assign {sky_drawn, sky_colours, sky_group} = '0;
        end
    end else begin : without_sky
        assign {sky_valid, sky_line, sky_colour, sky_drawn, sky_colours, sky_group} = '0;
        wire _unused = &{1'b0, sky, sky_flushed};
    end

    // Whether groups come from the raymarcher in this clock; with neither TRIANGLES nor LINES all groups come from the raymarcher.
    logic from_field;

    assign from_field = FIELDS && (field_sink.open || !TRIANGLES && !LINES);

    logic   of_pixels;
    pixel_t pixel;

    assign of_pixels = from_field || from_line || state == SKY_FIRST || !TRIANGLES;

    always_comb begin
        pixel = line_pixel;
        if (from_field) pixel = {field_source.halves, field_source.row, field_source.line, field_source.column, field_source.mask,
                                 field_source.code, field_source.colour};

        if (state == SKY_FIRST) pixel = sky_group;

        drawn_ready      = group_ready && !of_pixels;
        line_ready       = group_ready && from_line && !from_field && state != SKY_FIRST;
        field_sink.ready = group_ready && FIELDS && field_sink.open;
        group_valid      = from_field ? field_source.valid && field_sink.open : state == SKY_FIRST ? sky_valid
                         : from_line ? line_valid : drawn_valid;
        group_halves     = of_pixels ? pixel.halves : 2'b11;
        group_row        = of_pixels ? pixel.row : drawn_row;
        group_line       = of_pixels ? pixel.line : drawn_line;
        group_column     = of_pixels ? pixel.column : drawn_column;
        group_mask       = of_pixels ? pixel.mask : drawn_mask;
        group_codes      = of_pixels ? {8{pixel.code}} : drawn_codes;
        group_colours    = state == SKY_FIRST ? sky_colours : of_pixels ? {8{pixel.colour}} : drawn_colours;
        group_asks       = drawn_asks && !of_pixels;
        // Groups of the sky are written like blended pixels: without a depth test.
        group_blended    = of_pixels ? state == SKY_FIRST : drawn_blended;
    end

    logic                    word_valid, word_ready, odd_bank;
    logic [ADDRESS_BITS-1:0] word_addr;
    logic [127:0]            word_data;
    logic [1:0]              port_ready, port_idle;

    band_buffer #(.ADDRESS_BITS(ADDRESS_BITS), .STEREO(FIELDS), .DEPTHS(DEPTHS), .BLEND(TRIANGLES && TEXTURE), .SKY(SKY), .AVERAGE(AVERAGE)) band_buffer (
        .clk, .rst, .restart, .clearing, .flushed,
        .group_valid, .group_ready, .group_row, .group_line, .group_column, .group_mask, .group_halves, .group_codes, .group_colours,
        .group_asks, .group_blended, .answer_valid, .answer_lanes, .behind_lane, .behind,
        .band_valid(state == HAND_OVER), .band_ready, .band_base(base), .band_depth_base, .band_lines(rows), .band_stride(stride),
        .band_first_line(first_row), .band_slot(flags.slot), .band_whole(all_words),
        .band_with_depth(flags.depth), .band_clear(parameters.clear), .band_compose(has_field ? field_source.compose : 2'd0),
        .band_average(averages), .band_gap(gap), .band_sky(has_sky && !sky_first), .band_dither(flags.dither),
        .sky_valid, .sky_ready(sky_flushed), .sky_line, .sky_colour,
        .word_valid, .word_ready, .word_addr, .word_data,
        .events(band_events)
    );

    assign odd_bank   = word_addr[$clog2(list_pkg::BANK_WORDS)];
    assign word_ready = port_ready[odd_bank];
    assign in_memory  = flushed && &port_idle;

    assign even_write_request.wdata_strobe = '1;
    assign odd_write_request.wdata_strobe  = '1;

    /* verilator lint_off PINCONNECTEMPTY */
    write_port #(.ADDRESS_BITS(ADDRESS_BITS)) even_port (
        .clk, .rst, .hurry(1'b1), .idle(port_idle[0]),
        .in_valid(word_valid && !odd_bank), .in_ready(port_ready[0]), .in_addr(word_addr), .in_data(word_data), .in_strobe('1),
        .cmd_valid(even_write_request.cmd_valid), .cmd_ready(even_write_answer.cmd_ready), .cmd_addr(even_write_request.cmd_addr),
        .wdata_valid(even_write_request.wdata_valid), .wdata_ready(even_write_answer.wdata_ready),
        .wdata(even_write_request.wdata), .wdata_strobe()
    );

    write_port #(.ADDRESS_BITS(ADDRESS_BITS)) odd_port (
        .clk, .rst, .hurry(1'b1), .idle(port_idle[1]),
        .in_valid(word_valid && odd_bank), .in_ready(port_ready[1]), .in_addr(word_addr), .in_data(word_data), .in_strobe('1),
        .cmd_valid(odd_write_request.cmd_valid), .cmd_ready(odd_write_answer.cmd_ready), .cmd_addr(odd_write_request.cmd_addr),
        .wdata_valid(odd_write_request.wdata_valid), .wdata_ready(odd_write_answer.wdata_ready),
        .wdata(odd_write_request.wdata), .wdata_strobe()
    );
    /* verilator lint_on PINCONNECTEMPTY */

    always_comb begin
        events = walk_events | band_events;
        events.cycles_raster = busy;
    end

    wire _unused_inputs = &{1'b0, flags, parameters, field_source};
endmodule

`default_nettype wire

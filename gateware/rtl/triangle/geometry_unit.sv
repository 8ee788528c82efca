// Computes the descriptors (triangles after the setup) and the band lists (the numbers of the descriptors in each band) of a frame from the
// mesh in memory.
//
//              ┌───────────┐   ┌──────────────┐   ┌──────────┐   ┌───────┐   ┌────────┐
//   mesh ─────▶│ mesh_walk │──▶│ vertex_cache │──▶│ classify │──▶│ setup │──▶│ binner │──▶ descriptors, lists
//              └───────────┘   └──────────────┘   └──────────┘   └───────┘   └────────┘
//                                │ fetch  ▲ projected   └─ exception ─────────────▲
//                                ▼        │                                       ▲
//   vertices ─────────────────▶ vertex_stage                                      │
//   segments ─────────────────▶ line_setup ───────────────────────────────────────┘ pieces of lines
//
// `start` (one clock, not while `busy`) begins a frame. The parameters must hold from a clock before `start` until `done` (one
// clock), when all results are in memory. When `done` is high, two errors report an incomplete frame: `mesh_error` (a chunk has no vertices
// or extends beyond the mesh's end) and `full` (not all descriptors, list entries or exceptions fit their memory). The lists of an
// incomplete frame contain only descriptors that were written. `restart` (any time) cancels the frame; the next start must wait until
// read_port is idle.
//
// A frame of several meshes needs a `start` for each mesh. With `flags.append` the results are appended to the descriptors, lists,
// exceptions, counts and `full` of the previous mesh; size, addresses and `list_shift` must be equal to those of the previous mesh. The
// number of an exception is the number of the triangle in its own mesh. After `restart`, `append` has no effect, and the lists are emptied.
//
// With LINES, the flag `lines` selects a frame of segments in memory (docs/formats/line.md, "Segments in memory"). mesh_walk reads the
// segments like the triangles of a mesh, two words for each segment, and line_setup cuts the segments into pieces, which replace
// descriptors.
//
// Without TRIANGLES, the units for triangles, from vertex_cache to setup, are not built, and each pass has the flag `lines`.
//
// With TEXTURE, the flag `textures` selects the textures of the mesh: the texture coordinates of a vertex are read in parallel with the
// vertex, and stored with it in the vertex_cache.
//
// The slowest part determines the throughput: 11 clocks per drawn triangle (33 with smooth shading or textures), 3 per culled triangle, 6
// per vertex that is not in the cache, and in the binner 6 clocks per triangle (9 with SMOOTH, 8 with TEXTURE) plus 2 clocks for each band of
// the triangle after the first. Memory: three clients of read_ports, two native write ports. `results` contains the numbers of the frame's
// triangles, descriptors and exceptions.

`default_nettype none

module geometry_unit #(
    parameter  bit          TRIANGLES    = 1'b1,
    parameter  bit          SMOOTH       = 1'b0,
    parameter  bit          TEXTURE      = 1'b0,
    parameter  bit          LINES        = 1'b0,
    parameter  bit          AVERAGE      = 1'b0,
    localparam int unsigned ADDRESS_BITS = triangle_registers_pkg::ADDRESS_BITS,
    localparam int unsigned COUNT_BITS   = triangle_registers_pkg::COUNT_BITS
) (
    input  wire                      clk,
    input  wire                      rst,
    input  wire                      restart,
    input  wire                      start,
    output logic                     busy,
    output logic                     done,
    output logic                     mesh_error,
    output logic                     full,
    input  wire triangle_registers_pkg::geometry_flags_t flags,
    input  wire triangle_registers_pkg::geometry_t parameters,
    input  wire triangle_registers_pkg::view_t view,
    // Clients of read_ports: for the mesh, the vertices, and, with TEXTURE, the texture coordinates of the vertices.
    output logic [2:0]               ask_valid,
    input  wire  [2:0]               ask_ready,
    output logic [3*ADDRESS_BITS-1:0] ask_addr,
    input  wire  [2:0]               data_valid,
    output logic [2:0]               data_ready,
    input  wire  [3*128-1:0]         data,
    output triangle_registers_pkg::write_request_t descriptors_write_request,
    input  wire triangle_registers_pkg::write_answer_t descriptors_write_answer,
    output triangle_registers_pkg::write_request_t lists_write_request,
    input  wire triangle_registers_pkg::write_answer_t lists_write_answer,
    output triangle_registers_pkg::results_t results,
    output triangle_registers_pkg::events_t events
);
    // Number of bits of a triangle's colour, normal and, with TEXTURE, texture together.
    localparam int unsigned SIDE_BITS = TEXTURE ? 72 : 64;
    localparam int unsigned LIGHT_BITS  = triangle_pkg::vertex_bits(SMOOTH, TEXTURE);
    localparam int unsigned VERTEX_BITS = SMOOTH || TEXTURE ? 68 + LIGHT_BITS : 68;
    localparam int unsigned FLIGHT_BITS = 8;

    logic [10:0] width;
    logic [9:0]  height;

    assign width  = 11'(picture_pkg::WIDTH) << flags.size;
    assign height = 10'(picture_pkg::HEIGHT) << flags.size;

    typedef enum logic [2:0] {IDLE, PREPARE, BEGIN, WALK, FINISH} state_t;
    state_t state;

    // `has_lists` is high if the lists belong to a frame that was not cancelled.
    logic clear, has_lists, walk_busy, lists_idle, lists_done, drained, hurry;
    logic [1:0] writes_idle;

    assign busy  = state != IDLE;
    assign clear = state == IDLE && start;

    always_ff @(posedge clk) begin
        done <= 1'b0;
        case (state)
            IDLE:    if (start) state <= PREPARE;
            // Waits until the binner has emptied all band lists.
            PREPARE: if (lists_idle) state <= BEGIN;
            BEGIN:   state <= WALK;
            WALK:    if (!walk_busy && drained && lists_idle) state <= FINISH;
            default: if (lists_done && !write_valid && &writes_idle) begin
                done  <= 1'b1;
                state <= IDLE;
            end
        endcase
        if (clear) has_lists <= 1'b1;
        if (rst || restart) begin
            state     <= IDLE;
            done      <= 1'b0;
            has_lists <= 1'b0;
        end
    end

    logic                    word_valid, word_ready, triangle_valid, triangle_ready, chunk;
    records_pkg::triangle_t  triangle;
    records_pkg::vertex_t    vertex;
    logic [ADDRESS_BITS-1:0] vertex_base, mesh_first;
    // Address of the first word after the mesh; number of the first vertex of the chunk.
    logic [ADDRESS_BITS:0]   mesh_past, vertex_first;

    assign mesh_first = parameters.mesh[4 +: ADDRESS_BITS];

    always_ff @(posedge clk) mesh_past <= {1'b0, mesh_first} + parameters.mesh_bytes[4 +: ADDRESS_BITS+1];

    mesh_walk #(.ADDRESS_BITS(ADDRESS_BITS)) mesh_walk (
        .clk, .rst(rst || restart), .start(state == BEGIN), .first(mesh_first), .past(mesh_past), .drained,
        .busy(walk_busy), .error(mesh_error), .chunk, .vertex_base, .vertex_first,
        .ask_valid(ask_valid[0]), .ask_ready(ask_ready[0]), .ask_addr(ask_addr[0 +: ADDRESS_BITS]),
        .data_valid(data_valid[0]), .data_ready(data_ready[0]), .data(data[0 +: 128]),
        .out_valid(word_valid), .out_ready(word_ready), .out_triangle(triangle)
    );

    // The words of a mesh are triangles or, in a pass of lines, halves of segments.
    logic             in_lines, half_ready, piece_valid, piece_ready;
    records_pkg::piece_t piece;

    assign in_lines       = LINES && (flags.lines || !TRIANGLES);
    assign triangle_valid = word_valid && !in_lines;
    assign word_ready     = in_lines ? half_ready : triangle_ready;

    if (LINES) begin : lines
        line_pkg::segment_t        segment;
        records_pkg::segment_end_t segment_end;
        logic                      has_first, segment_ready;

        assign segment_end = triangle;

        assign half_ready = !has_first || segment_ready;

        // Stores the first half of a segment; the second half is used directly from the input.
        always_ff @(posedge clk) begin
            if (in_lines && word_valid && half_ready) has_first <= !has_first;
            if (!has_first) {segment.colour, segment.a_w, segment.a_y, segment.a_x}
                <= {segment_end.side, segment_end.w, segment_end.y, segment_end.x};

            if (rst || restart || clear) has_first <= 1'b0;
        end

        assign {segment.b_w, segment.b_y, segment.b_x} = {segment_end.w, segment_end.y, segment_end.x};

        line_setup line_setup (
            .clk, .rst(rst || restart), .size(flags.size), .bias(segment_end.side),
            .in_valid(has_first && word_valid), .in_ready(segment_ready), .in_segment(segment),
            .out_valid(piece_valid), .out_ready(piece_ready), .out_piece(piece)
        );

        wire _unused = &{1'b0, segment_end};
    end else begin : triangles_alone
        assign {half_ready, piece_valid, piece} = '0;

        wire _unused = &{1'b0, piece_ready};
    end

    logic                          fetch_valid, fetch_ready, unseen, culled, descriptor_valid, descriptor_ready, exception_valid,
                                   exception_ready;
    logic [31:0]                   exception_number;
    records_pkg::descriptor_t      descriptor;
    logic [triangle_pkg::planes_bits(SMOOTH, TEXTURE)-1:0] planes;

    // Arrays that belong to the block `triangles`; Yosys does not accept their declaration inside a generate block.
    logic [2:0][VERTEX_BITS-1:0] cached;
    logic [2:0][67:0]            placed;
    logic [2:0][65:0]            regular;
    logic [2:0][LIGHT_BITS-1:0]  placed_light, regular_light;

    if (TRIANGLES) begin : triangles
        logic             projected_valid, projected_ready, placed_valid, placed_ready;
        logic [15:0]      fetch_index;
        triangle_pkg::projected_t       projected;
        logic [VERTEX_BITS-1:0] shaded;
        logic [SIDE_BITS-1:0] placed_side;

        logic                    stage_valid, stage_ready;
        logic [SIDE_BITS-1:0]    side;

        if (TEXTURE) begin : texture_side
            logic [7:0] number;

            // Textures of all meshes of a frame are numbered consecutively.
            assign number = flags.textures && triangle.texture != '0 ? triangle.texture + parameters.first_texture : '0;
            assign side   = {number, triangle.normal, triangle.colour};
        end else begin : plain_side
            assign side = {triangle.normal, triangle.colour};
        end

        /* verilator lint_off PINCONNECTEMPTY */
        vertex_cache #(.SIDE_BITS(SIDE_BITS), .VERTEX_BITS(VERTEX_BITS)) vertex_cache (
            .clk, .rst(rst || restart), .clear(chunk), .idle(),
            .in_valid(triangle_valid), .in_ready(triangle_ready),
            .in_indices(triangle.indices), .in_side(side),
            .fetch_valid, .fetch_ready, .fetch_index,
            .projected_valid, .projected_ready, .projected_vertex(shaded),
            .out_valid(placed_valid), .out_ready(placed_ready), .out_vertices(cached), .out_side(placed_side)
        );
        /* verilator lint_on PINCONNECTEMPTY */

        assign vertex = data[128 +: 128];
        assign ask_addr[ADDRESS_BITS +: ADDRESS_BITS] = vertex_base + ADDRESS_BITS'(fetch_index);

        // Reads the texture coordinates of each fetched vertex in parallel with the vertex. A word
        // contains the coordinates of two vertices.
        logic [63:0] coordinates;
        logic        has_coordinates;

        if (TEXTURE) begin : textures_built
            logic                  reads, places_ready, place_valid, half_room, half_valid, half, asks;
            logic [ADDRESS_BITS:0] place;

            // `flags.textures` is low for a mesh without textures, although other meshes of the frame may have textures.
            assign reads        = flags.textures;
            assign ask_valid[1] = fetch_valid && places_ready;
            assign fetch_ready  = ask_ready[1] && places_ready;

            fifo #(.WIDTH(ADDRESS_BITS + 1), .DEPTH(16)) element_places (
                .clk, .rst(rst || restart), .in_valid(fetch_valid && ask_ready[1] && reads), .in_ready(places_ready),
                .in_data(vertex_first + (ADDRESS_BITS+1)'(fetch_index)),
                .out_valid(place_valid), .out_ready(ask_ready[2] && half_room), .out_data(place)
            );

            assign ask_valid[2] = place_valid && half_room;
            assign asks         = ask_valid[2] && ask_ready[2];
            assign ask_addr[2*ADDRESS_BITS +: ADDRESS_BITS] = parameters.coordinates[4 +: ADDRESS_BITS] + place[ADDRESS_BITS:1];

            fifo #(.WIDTH(1), .DEPTH(32)) halves (
                .clk, .rst(rst || restart), .in_valid(asks), .in_ready(half_room), .in_data(place[0]),
                .out_valid(half_valid), .out_ready(data_valid[2] && data_ready[2]), .out_data(half)
            );

            assign has_coordinates = !reads || data_valid[2] && half_valid;
            assign data_ready[2]   = reads && half_valid && stage_valid && projected_ready;
            assign coordinates     = half ? data[256 + 64 +: 64] : data[256 +: 64];
        end else begin : no_texture
            assign ask_valid[1]    = fetch_valid;
            assign fetch_ready     = ask_ready[1];
            assign has_coordinates = 1'b1;
            assign coordinates     = '0;
            assign {ask_valid[2], ask_addr[2*ADDRESS_BITS +: ADDRESS_BITS], data_ready[2]} = '0;

            wire _unused = &{1'b0, vertex_first, coordinates, ask_ready[2], data_valid[2], data[256 +: 128]};
        end

        assign projected_valid = stage_valid && has_coordinates;
        assign stage_ready     = projected_ready && has_coordinates;

        // The middle of the picture, counted from the beginning of the quarter that is drawn.
        logic [10:0] middle_x, middle_y;

        always_comb begin
            middle_x = 11'(width[10:1]);
            middle_y = 11'(height[9:1]);
            if (AVERAGE && flags.quarter) begin
                middle_x = flags.right ? '0 : width;
                middle_y = flags.lower ? '0 : 11'(height);
            end
        end

        vertex_stage #(.AVERAGE(AVERAGE)) vertex_stage (
            .clk, .rst(rst || restart), .orthographic(flags.orthographic), .scale_shift(view.scale_shift),
            .row_u(view.row_u), .row_v(view.row_v), .row_n(view.row_n),
            .tx(view.tx), .ty(view.ty), .tz(view.tz), .near_z(view.near_z),
            .centre_x(middle_x), .centre_y(middle_y),
            .depth_mantissa(view.depth_mantissa), .depth_exponent(view.depth_exponent),
            .in_valid(data_valid[1]), .in_ready(data_ready[1]), .in_position(vertex.position),
            .out_valid(stage_valid), .out_ready(stage_ready), .out_vertex(projected)
        );

        for (genvar i = 0; i < 3; i++) begin : places
            assign placed[i] = cached[i][67:0];
        end

        if (SMOOTH) begin : light
            triangle_pkg::light_t projected_light;

            vertex_light vertex_light (
                .clk, .rst(rst || restart), .cull_back(flags.cull), .row_light(view.row_light),
                .light_colour(parameters.light_colour), .ambient(parameters.ambient), .take(data_valid[1] && data_ready[1]),
                .in_normal(vertex.normal), .in_colour(flags.recolour ? {8'd0, parameters.colour} : {vertex.fine, vertex.colour}),
                .give(projected_valid && projected_ready), .out_light(projected_light)
            );

            if (TEXTURE) begin : with_texture
                assign shaded = {coordinates, projected_light, projected};
            end else begin : light_alone
                assign shaded = {projected_light, projected};
            end
        end else if (TEXTURE) begin : texture_alone
            assign shaded = {coordinates, projected};
        end else begin : flat
            assign shaded = projected;
        end

        for (genvar i = 0; i < 3; i++) begin : lights
            if (SMOOTH || TEXTURE) begin : of_vertex
                assign placed_light[i] = cached[i][68 +: LIGHT_BITS];
            end else begin : none
                assign placed_light[i] = '0;
            end
        end

        logic                 regular_valid, regular_ready;
        logic [SIDE_BITS-1:0] regular_side;

        /* verilator lint_off PINCONNECTEMPTY */
        classify #(.SIDE_BITS(SIDE_BITS + 3 * LIGHT_BITS)) classify (
            .clk, .rst(rst || restart), .restart(clear), .width, .height, .idle(), .unseen, .count(results.triangles),
            .in_valid(placed_valid), .in_ready(placed_ready), .in_vertices(placed), .in_side({placed_light, placed_side}),
            .regular_valid, .regular_ready, .regular_vertices(regular),
            .regular_side({regular_light, regular_side}),
            .exception_valid, .exception_ready, .exception_number
        );

        logic [TEXTURE ? 7 : 0:0] texture_number;

        if (TEXTURE) begin : number
            assign texture_number = regular_side[71:64];
        end else begin : no_number
            assign texture_number = '0;
        end

        setup #(.SMOOTH(SMOOTH), .TEXTURE(TEXTURE)) setup (
            .clk, .rst(rst || restart), .width, .height, .cull_back(flags.cull), .mirror(flags.mirror), .row_light(view.row_light),
            .light_colour(parameters.light_colour), .ambient(parameters.ambient),
            .smooth(flags.smooth), .textures(flags.textures && !(SMOOTH && flags.smooth)), .linear(flags.orthographic),
            .busy(), .culled, .drawn(),
            .in_valid(regular_valid), .in_ready(regular_ready), .in_vertices(regular),
            .in_colour(flags.recolour ? parameters.colour : regular_side[15:0]), .in_normal(regular_side[63:16]),
            .in_light(regular_light), .in_texture(texture_number),
            .out_valid(descriptor_valid), .out_ready(descriptor_ready), .out_descriptor(descriptor),
            .out_planes(planes)
        );
        /* verilator lint_on PINCONNECTEMPTY */
    end else begin : lines_alone
        assign {fetch_valid, fetch_ready, unseen, culled, descriptor_valid, exception_valid} = '0;
        assign {exception_number, descriptor, planes, results.triangles} = '0;
        assign {cached, placed, regular, placed_light, regular_light} = '0;
        assign triangle_ready = 1'b0;
        assign {ask_valid[2:1], ask_addr[ADDRESS_BITS +: 2*ADDRESS_BITS], data_ready[2:1]} = '0;
        assign vertex = '0;

        wire _unused = &{1'b0, flags, view, width, height, chunk, vertex_base, vertex_first, ask_ready, data_valid, data, descriptor_ready,
                         exception_ready, cached, placed, regular, placed_light, regular_light};
    end

    logic                    binner_ready, write_valid, write_ready, write_descriptor, descriptors_ready, lists_ready;
    logic [ADDRESS_BITS-1:0] write_addr;
    logic [127:0]            write_data;
    logic [15:0]             write_strobe;

    assign descriptor_ready = binner_ready && !in_lines;
    assign piece_ready      = binner_ready && in_lines;

    binner #(.ADDRESS_BITS(ADDRESS_BITS), .COUNT_BITS(COUNT_BITS), .SMOOTH(SMOOTH), .TEXTURE(TEXTURE), .LINES(LINES)) binner (
        .clk, .rst(rst || restart), .restart(clear && !(flags.append && has_lists)), .finish(state == FINISH),
        .done(lists_done), .idle(lists_idle), .full,
        .size(flags.size), .descriptor_base(parameters.descriptors[4 +: ADDRESS_BITS]),
        .descriptor_limit(parameters.descriptor_limit), .list_base(parameters.lists[4 +: ADDRESS_BITS]),
        .list_shift(parameters.list_shift), .exception_base(parameters.exceptions[4 +: ADDRESS_BITS]),
        .exception_limit(parameters.exception_limit),
        .descriptors(results.descriptor_count), .exceptions(results.exception_count),
        .in_valid(in_lines ? piece_valid : descriptor_valid), .in_ready(binner_ready), .in_descriptor(descriptor),
        .in_planes(planes), .in_line(in_lines), .in_piece(piece),
        .exception_valid, .exception_ready, .exception_number,
        .write_valid, .write_ready, .write_addr, .write_data, .write_strobe, .write_descriptor
    );

    assign hurry       = state == FINISH || state == IDLE;
    assign write_ready = write_descriptor ? descriptors_ready : lists_ready;

    // Descriptors are written to consecutive addresses, but words of lists are not. Descriptors and lists have separate ports, so that the
    // port of the descriptors seldom switches between memory banks.
    assign descriptors_write_request.wdata_strobe = '1;

    /* verilator lint_off PINCONNECTEMPTY */
    write_port #(.ADDRESS_BITS(ADDRESS_BITS)) descriptors_port (
        .clk, .rst, .hurry, .idle(writes_idle[0]),
        .in_valid(write_valid && write_descriptor), .in_ready(descriptors_ready), .in_addr(write_addr), .in_data(write_data),
        .in_strobe(write_strobe),
        .cmd_valid(descriptors_write_request.cmd_valid), .cmd_ready(descriptors_write_answer.cmd_ready),
        .cmd_addr(descriptors_write_request.cmd_addr), .wdata_valid(descriptors_write_request.wdata_valid),
        .wdata_ready(descriptors_write_answer.wdata_ready), .wdata(descriptors_write_request.wdata), .wdata_strobe()
    );
    /* verilator lint_on PINCONNECTEMPTY */

    write_port #(.ADDRESS_BITS(ADDRESS_BITS)) lists_port (
        .clk, .rst, .hurry, .idle(writes_idle[1]),
        .in_valid(write_valid && !write_descriptor), .in_ready(lists_ready), .in_addr(write_addr), .in_data(write_data),
        .in_strobe(write_strobe),
        .cmd_valid(lists_write_request.cmd_valid), .cmd_ready(lists_write_answer.cmd_ready),
        .cmd_addr(lists_write_request.cmd_addr), .wdata_valid(lists_write_request.wdata_valid),
        .wdata_ready(lists_write_answer.wdata_ready), .wdata(lists_write_request.wdata),
        .wdata_strobe(lists_write_request.wdata_strobe)
    );

    // Number of triangles that have left mesh_walk and have not yet been dropped or accepted by the binner.
    logic [FLIGHT_BITS-1:0] flight;
    logic                   came, was_unseen, was_culled, was_kept, was_exception;

    assign drained = flight == '0 && !came && !word_valid;

    always_ff @(posedge clk) begin
        came          <= triangle_valid && triangle_ready;
        was_unseen    <= unseen;
        was_culled    <= culled;
        was_kept      <= descriptor_valid && descriptor_ready;
        was_exception <= exception_valid && exception_ready;

        flight       <= flight + FLIGHT_BITS'(came) - FLIGHT_BITS'(was_unseen) - FLIGHT_BITS'(was_culled)
                      - FLIGHT_BITS'(was_kept) - FLIGHT_BITS'(was_exception);
        results.unseen <= results.unseen + 32'(was_unseen);
        results.culled <= results.culled + 32'(was_culled);

        if (clear) {results.unseen, results.culled} <= '0;
        if (rst || restart) begin
            {came, was_unseen, was_culled, was_kept, was_exception} <= '0;
            flight <= '0;
        end
        if (rst) {results.unseen, results.culled} <= '0;
    end

    always_comb begin
        events = '0;
        events.cycles_geometry = busy;
        events.vertices        = fetch_valid && fetch_ready;
    end

    wire _unused = &{1'b0, triangle, vertex, parameters};
endmodule

`default_nettype wire

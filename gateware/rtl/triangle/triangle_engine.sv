// The triangle engine: draws a mesh in memory into a frame in memory, in two passes. The passes of two frames may run at the same time.
//
//              ┌───────────────┐                        ┌─────────────┐
//   mesh ─────▶│ geometry_unit │──▶ descriptors, lists ─▶│ raster_unit │──▶ frame, depth
//              └───────────────┘                        └─────────────┘
//                                firmware's lists ──────────▲
//
// Native read ports of the memory serve triangles, vertices, the raster unit and, with TEXTURE, texels. LiteDRAM only lets a port switch to
// another memory bank when the previous bank is idle, four clocks later, so each of these streams has its own port. There are four write
// ports: one for descriptors, one for lists, one for the frame's words in even memory banks, and one for its words in odd banks. `cancel`
// (one clock, at any time) ends both passes. After `cancel`, `status.ready` rises when no read is outstanding, memory has taken all words,
// and the band buffer is clear; then either unit may start. geometry_unit and raster_unit explain their parameters and results. `events`
// holds the increment of each counter, some clocks late.
//
// SMOOTH builds smooth shading, which the flag `smooth` of the geometry pass enables for a frame: the light of the vertices is
// interpolated with perspective correction, which takes a division per pixel (docs/formats/triangle.md, "Smooth shading"). Descriptors then
// have twice the words.
//
// TEXTURE builds textures: descriptors have two more words, a second client of the vertex port reads texture coordinates, and a fourth
// read port reads textures. TEXTURE and SMOOTH exclude each other.
//
// SKY builds the sky behind triangles (band_sky), for frames with the flag `sky` of the raster pass; FOG builds the fog on triangles
// (group_fog), for frames with its flag `fog`.
//
// AVERAGE builds pictures with four samples a pixel, for frames with the flag `average` of the raster pass, and the flag `quarter` of both
// passes.
//
// LINES builds the line engine: the flag `lines` of the geometry pass selects a frame of segments instead of a mesh.
//
// FIELDS builds the link to a raymarcher.
//
// Without TRIANGLES, the parts of both units that draw triangles and the port of the vertices are not built: a geometry pass must have the
// flag `lines`. Without GEOMETRY, the geometry unit and its ports are not built: frames are drawn from the firmware's lists, and
// `geometry_start` must stay low; LINES needs GEOMETRY. With neither TRIANGLES nor LINES, the engine draws only the pixels of a raymarcher:
// GEOMETRY is then 0, and the port of the lists is not built. Without DEPTHS, for builds without TRIANGLES, there is no depth test: a later
// pixel always replaces an earlier one, and depths in memory are 0.

`default_nettype none

module triangle_engine #(
    parameter bit TRIANGLES = 1'b1,
    parameter bit SMOOTH    = 1'b0,
    parameter bit TEXTURE   = 1'b0,
    parameter bit SKY       = 1'b0,
    parameter bit FOG       = 1'b0,
    parameter bit AVERAGE   = 1'b0,
    parameter bit FIELDS    = 1'b0,
    parameter bit LINES     = 1'b0,
    parameter bit GEOMETRY  = TRIANGLES || LINES,
    parameter bit DEPTHS    = 1'b1
) (
    input  wire  clk,
    input  wire  rst,
    input  wire  cancel,
    output triangle_registers_pkg::status_t status,
    output triangle_registers_pkg::events_t events,
    // Geometry.
    input  wire  geometry_start,
    input  wire triangle_registers_pkg::geometry_flags_t geometry_flags,
    input  wire triangle_registers_pkg::geometry_t geometry,
    input  wire triangle_registers_pkg::view_t view,
    output triangle_registers_pkg::results_t results,
    // Raster.
    input  wire  raster_start,
    input  wire triangle_registers_pkg::raster_flags_t raster_flags,
    input  wire triangle_registers_pkg::raster_t raster,
    input  wire triangle_registers_pkg::sky_t sky,
    input  wire triangle_registers_pkg::fog_t fog,
    // Link to an optional raymarcher outside of the triangle engine, explained in raster_unit.
    input  wire triangle_registers_pkg::field_source_t field_source,
    output triangle_registers_pkg::field_sink_t field_sink,
    // Memory.
    output triangle_registers_pkg::read_request_t mesh_read_request,
    input  wire triangle_registers_pkg::read_answer_t mesh_read_answer,
    output triangle_registers_pkg::read_request_t vertex_read_request,
    input  wire triangle_registers_pkg::read_answer_t vertex_read_answer,
    output triangle_registers_pkg::read_request_t raster_read_request,
    input  wire triangle_registers_pkg::read_answer_t raster_read_answer,
    output triangle_registers_pkg::read_request_t texture_read_request,
    input  wire triangle_registers_pkg::read_answer_t texture_read_answer,
    output triangle_registers_pkg::write_request_t descriptors_write_request,
    input  wire triangle_registers_pkg::write_answer_t descriptors_write_answer,
    output triangle_registers_pkg::write_request_t lists_write_request,
    input  wire triangle_registers_pkg::write_answer_t lists_write_answer,
    output triangle_registers_pkg::write_request_t frame_even_write_request,
    input  wire triangle_registers_pkg::write_answer_t frame_even_write_answer,
    output triangle_registers_pkg::write_request_t frame_odd_write_request,
    input  wire triangle_registers_pkg::write_answer_t frame_odd_write_answer
);
    localparam int unsigned ADDRESS_BITS   = triangle_registers_pkg::ADDRESS_BITS;
    localparam int unsigned RASTER_CLIENTS = 4;
    // Three clients of the geometry pass read the mesh, the vertices and the texture coordinates.
    localparam int unsigned CLIENTS        = 3 + RASTER_CLIENTS;
    localparam int unsigned VERTEX_CLIENTS = TEXTURE ? 2 : 1;

    logic [CLIENTS-1:0]              ask_valid, ask_ready, data_valid, data_ready;
    logic [CLIENTS*ADDRESS_BITS-1:0] ask_addr;
    logic [CLIENTS*128-1:0]          data;
    logic [3:0]                      ports_idle;
    logic                            dropping, drop, raster_ready;

    assign drop = cancel || dropping;
    assign status.ready = !dropping && raster_ready;

    always_ff @(posedge clk) begin
        if (&ports_idle) dropping <= 1'b0;
        if (cancel)     dropping <= 1'b1;
        if (rst)       dropping <= 1'b0;
    end

    triangle_registers_pkg::events_t geometry_events, raster_events, port_events;

    if (GEOMETRY) begin : geometry_pass
        read_port #(.CLIENTS(1), .ADDRESS_BITS(ADDRESS_BITS)) mesh_read (
            .clk, .rst, .drop, .idle(ports_idle[0]),
            .ask_valid(ask_valid[0]), .ask_ready(ask_ready[0]), .ask_addr(ask_addr[1*ADDRESS_BITS-1:0]),
            .data_valid(data_valid[0]), .data_ready(data_ready[0]), .data(data[1*128-1:0]),
            .cmd_valid(mesh_read_request.cmd_valid), .cmd_ready(mesh_read_answer.cmd_ready), .cmd_addr(mesh_read_request.cmd_addr),
            .rdata_valid(mesh_read_answer.rdata_valid), .rdata(mesh_read_answer.rdata)
        );

        geometry_unit #(.TRIANGLES(TRIANGLES), .SMOOTH(SMOOTH), .TEXTURE(TEXTURE), .LINES(LINES), .AVERAGE(AVERAGE)) geometry_unit (
            .clk, .rst, .restart(cancel), .start(geometry_start), .busy(status.geometry_busy), .done(status.geometry_done),
            .mesh_error(status.mesh_error), .full(status.full), .flags(geometry_flags), .parameters(geometry), .view,
            .ask_valid(ask_valid[2:0]), .ask_ready(ask_ready[2:0]), .ask_addr(ask_addr[3*ADDRESS_BITS-1:0]),
            .data_valid(data_valid[2:0]), .data_ready(data_ready[2:0]), .data(data[3*128-1:0]),
            .descriptors_write_request, .descriptors_write_answer, .lists_write_request, .lists_write_answer,
            .results, .events(geometry_events)
        );
    end else begin : raster_pass_alone
        assign mesh_read_request = '0;
        assign {descriptors_write_request, lists_write_request} = '0;
        assign {ask_ready[0], data_valid[0], data[1*128-1:0]} = '0;
        assign {ask_valid[2:0], ask_addr[3*ADDRESS_BITS-1:0], data_ready[2:0]} = '0;
        assign {status.geometry_busy, status.geometry_done, status.mesh_error, status.full} = '0;
        assign {results, geometry_events} = '0;
        assign ports_idle[0] = 1'b1;
        wire _unused = &{1'b0, geometry_start, geometry_flags, geometry, view, drop, ask_valid[0], ask_ready[2:0],
                         ask_addr[1*ADDRESS_BITS-1:0], data_valid[2:0], data_ready[0], data[3*128-1:0], mesh_read_answer};
    end

    if (GEOMETRY && TRIANGLES) begin : vertices
        read_port #(.CLIENTS(VERTEX_CLIENTS), .ADDRESS_BITS(ADDRESS_BITS)) vertex_read (
            .clk, .rst, .drop, .idle(ports_idle[1]),
            .ask_valid(ask_valid[1 +: VERTEX_CLIENTS]), .ask_ready(ask_ready[1 +: VERTEX_CLIENTS]),
            .ask_addr(ask_addr[ADDRESS_BITS +: VERTEX_CLIENTS*ADDRESS_BITS]), .data_valid(data_valid[1 +: VERTEX_CLIENTS]),
            .data_ready(data_ready[1 +: VERTEX_CLIENTS]), .data(data[128 +: VERTEX_CLIENTS*128]),
            .cmd_valid(vertex_read_request.cmd_valid), .cmd_ready(vertex_read_answer.cmd_ready), .cmd_addr(vertex_read_request.cmd_addr),
            .rdata_valid(vertex_read_answer.rdata_valid), .rdata(vertex_read_answer.rdata)
        );
    end else begin : no_vertices
        assign vertex_read_request = '0;
        assign {ask_ready[1], data_valid[1], data[2*128-1:1*128]} = '0;
        assign ports_idle[1] = 1'b1;
        wire _unused = &{1'b0, vertex_read_answer, ask_valid[1], ask_addr[2*ADDRESS_BITS-1:1*ADDRESS_BITS], data_ready[1]};
    end

    if (!TEXTURE || !GEOMETRY || !TRIANGLES) begin : no_coordinates
        assign {ask_ready[2], data_valid[2], data[3*128-1:2*128]} = '0;
        wire _unused = &{1'b0, ask_valid[2], ask_addr[3*ADDRESS_BITS-1:2*ADDRESS_BITS], data_ready[2]};
    end

    if (TRIANGLES || LINES) begin : descriptors
        // The FIFOs of list words and of descriptor words are in block RAM, which is less scarce in the FPGA than LUTs.
        read_port #(.CLIENTS(3), .ADDRESS_BITS(ADDRESS_BITS), .BLOCK(3'b110)) raster_read (
            .clk, .rst, .drop, .idle(ports_idle[2]),
            .ask_valid(ask_valid[5:3]), .ask_ready(ask_ready[5:3]), .ask_addr(ask_addr[6*ADDRESS_BITS-1:3*ADDRESS_BITS]),
            .data_valid(data_valid[5:3]), .data_ready(data_ready[5:3]), .data(data[6*128-1:3*128]),
            .cmd_valid(raster_read_request.cmd_valid), .cmd_ready(raster_read_answer.cmd_ready), .cmd_addr(raster_read_request.cmd_addr),
            .rdata_valid(raster_read_answer.rdata_valid), .rdata(raster_read_answer.rdata)
        );
    end else begin : fields_alone
        assign raster_read_request = '0;
        assign {ask_ready[5:3], data_valid[5:3], data[6*128-1:3*128]} = '0;
        assign ports_idle[2] = 1'b1;
        wire _unused = &{1'b0, drop, raster_read_answer, ask_valid[5:3], ask_addr[6*ADDRESS_BITS-1:3*ADDRESS_BITS], data_ready[5:3]};
    end

    // Texels have a separate port: the sampler's queue hides the latency of memory, but not an additional wait for reads of lists and
    // descriptors.
    if (TEXTURE && (TRIANGLES || LINES)) begin : texels
        read_port #(.CLIENTS(1), .ADDRESS_BITS(ADDRESS_BITS)) texture_read (
            .clk, .rst, .drop, .idle(ports_idle[3]),
            .ask_valid(ask_valid[6]), .ask_ready(ask_ready[6]), .ask_addr(ask_addr[7*ADDRESS_BITS-1:6*ADDRESS_BITS]),
            .data_valid(data_valid[6]), .data_ready(data_ready[6]), .data(data[7*128-1:6*128]),
            .cmd_valid(texture_read_request.cmd_valid), .cmd_ready(texture_read_answer.cmd_ready),
            .cmd_addr(texture_read_request.cmd_addr), .rdata_valid(texture_read_answer.rdata_valid), .rdata(texture_read_answer.rdata)
        );
    end else begin : no_texels
        assign texture_read_request = '0;
        assign {ask_ready[6], data_valid[6], data[7*128-1:6*128]} = '0;
        assign ports_idle[3] = 1'b1;
        wire _unused = &{1'b0, texture_read_answer, ask_valid[6], ask_addr[7*ADDRESS_BITS-1:6*ADDRESS_BITS], data_ready[6]};
    end

    raster_unit #(.TRIANGLES(TRIANGLES), .SMOOTH(SMOOTH), .TEXTURE(TEXTURE), .SKY(SKY), .FOG(FOG), .AVERAGE(AVERAGE), .FIELDS(FIELDS), .LINES(LINES),
                  .DEPTHS(DEPTHS)) raster_unit (
        .clk, .rst, .restart(cancel), .ready(raster_ready), .start(raster_start), .busy(status.raster_busy),
        .done(status.raster_done), .list_error(status.list_error), .flags(raster_flags), .parameters(raster), .sky, .fog,
        .field_source, .field_sink,
        .ask_valid(ask_valid[6:3]), .ask_ready(ask_ready[6:3]), .ask_addr(ask_addr[7*ADDRESS_BITS-1:3*ADDRESS_BITS]),
        .data_valid(data_valid[6:3]), .data_ready(data_ready[6:3]), .data(data[7*128-1:3*128]),
        .even_write_request(frame_even_write_request), .even_write_answer(frame_even_write_answer),
        .odd_write_request(frame_odd_write_request), .odd_write_answer(frame_odd_write_answer),
        .events(raster_events)
    );

    // LiteDRAM answers one read port at a time and takes data from one write port at a time, so `items_in` and `items_out` increase by at
    // most 1 per clock.
    logic [3:0] stalled_reads;
    logic [1:0] stalled_lists, stalled_frame;

    // These signals are registered, because the ready signal of a command ends a long path in LiteDRAM.
    always_ff @(posedge clk) begin
        stalled_reads <= {mesh_read_request.cmd_valid && !mesh_read_answer.cmd_ready,
                          vertex_read_request.cmd_valid && !vertex_read_answer.cmd_ready,
                          raster_read_request.cmd_valid && !raster_read_answer.cmd_ready,
                          texture_read_request.cmd_valid && !texture_read_answer.cmd_ready};
        stalled_lists <= {descriptors_write_request.cmd_valid && !descriptors_write_answer.cmd_ready,
                          lists_write_request.cmd_valid && !lists_write_answer.cmd_ready};
        stalled_frame <= {frame_even_write_request.cmd_valid && !frame_even_write_answer.cmd_ready,
                          frame_odd_write_request.cmd_valid && !frame_odd_write_answer.cmd_ready};
    end

    always_comb begin
        port_events = '0;
        port_events.stalled_reads = stalled_reads != '0;
        port_events.stalled_lists = stalled_lists != '0;
        port_events.stalled_frame = stalled_frame != '0;
        port_events.cycles_stalled = port_events.stalled_reads || port_events.stalled_lists || port_events.stalled_frame;
        port_events.items_in  = mesh_read_answer.rdata_valid || vertex_read_answer.rdata_valid || raster_read_answer.rdata_valid
                             || texture_read_answer.rdata_valid;
        port_events.items_out = descriptors_write_request.wdata_valid && descriptors_write_answer.wdata_ready
                             || lists_write_request.wdata_valid && lists_write_answer.wdata_ready
                             || frame_even_write_request.wdata_valid && frame_even_write_answer.wdata_ready
                             || frame_odd_write_request.wdata_valid && frame_odd_write_answer.wdata_ready;
        port_events.cycles_busy = status.geometry_busy || status.raster_busy;
    end

    // The events are registered, because the paths of these conditions go through both units.
    always_ff @(posedge clk) events <= geometry_events | raster_events | port_events;
endmodule

`default_nettype wire

// The triangle engine: from a mesh in memory to a frame in memory, in two passes that may run at the same time, for two frames.
//
//              ┌───────────────┐                        ┌─────────────┐
//   mesh ─────▶│ geometry_unit │──▶ descriptors, lists ─▶│ raster_unit │──▶ frame, depth
//              └───────────────┘                        └─────────────┘
//                                firmware's lists ──────────▲
//
// Reads go through three native read ports of the memory: triangles, vertices, and what the raster reads. LiteDRAM lets a
// port turn to another bank only when the bank before has done all its work, which takes four clocks; streams on ports of
// their own do not turn for each other. Descriptors, lists, and the frame's words in even and in odd banks have write ports. `cancel` (one clock, at any
// time) gives both frames up; `ready` says that the memory has answered everything and the band buffer is clear, so that
// either unit may start. What the units' parameters and results mean stands in their own files.
//
// SMOOTH builds smooth shading, which a frame then has or not, by `smooth` of its geometry: light of the vertices, interpolated
// over the depth and divided at each pixel (docs/formats.md, "Smooth shading"). Descriptors have twice the words then.

`default_nettype none

module triangle_engine #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned COUNT_BITS   = 20,
    parameter bit          SMOOTH       = 1'b0,
    parameter bit          FIELDS       = 1'b0
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       cancel,
    output logic                      ready,
    // Geometry.
    input  wire                       geometry_start,
    output logic                      geometry_busy,
    output logic                      geometry_done,
    output logic                      mesh_error,
    output logic                      full,
    input  wire  [ADDRESS_BITS-1:0]   mesh_first,
    input  wire  [ADDRESS_BITS-1:0]   mesh_last,
    input  wire  [ADDRESS_BITS-1:0]   geometry_descriptors,
    input  wire  [COUNT_BITS-1:0]     descriptor_limit,
    input  wire  [ADDRESS_BITS-1:0]   geometry_lists,
    input  wire  [4:0]                list_shift,
    input  wire  [ADDRESS_BITS-1:0]   exception_base,
    input  wire  [COUNT_BITS-1:0]     exception_limit,
    input  wire  [1:0]                geometry_size,
    input  wire                       cull_back,
    input  wire                       smooth,
    input  wire  [4:0]                scale_shift,
    input  wire  [2:0][24:0]          row_u,
    input  wire  [2:0][24:0]          row_v,
    input  wire  [2:0][24:0]          row_n,
    input  wire  signed [43:0]        tx,
    input  wire  signed [43:0]        ty,
    input  wire  signed [43:0]        tz,
    input  wire  [38:0]               near_z,
    input  wire  [16:0]               depth_mantissa,
    input  wire  signed [3:0]         depth_exponent,
    output logic [31:0]               triangles,
    output logic [31:0]               unseen_count,
    output logic [31:0]               culled_count,
    output logic [COUNT_BITS-1:0]     descriptors,
    output logic [COUNT_BITS-1:0]     exceptions,
    output logic [31:0]               geometry_clocks,
    output logic [31:0]               vertices,
    // Raster.
    input  wire                       raster_start,
    output logic                      raster_busy,
    output logic                      raster_done,
    input  wire  [1:0]                raster_size,
    input  wire  [ADDRESS_BITS-1:0]   frame_base,
    input  wire  [ADDRESS_BITS-1:0]   depth_base,
    input  wire                       with_depth,
    input  wire  [15:0]               clear,
    // Which of the two frame buffers, and that nothing is known of what it holds: see raster_unit.
    input  wire                       frame_slot,
    input  wire                       whole,
    input  wire  [1:0]                present,
    input  wire  [2*ADDRESS_BITS-1:0] raster_lists,
    input  wire  [2*ADDRESS_BITS-1:0] raster_descriptors,
    input  wire  [2*COUNT_BITS-1:0]   raster_counts,
    output logic                      list_error,
    output logic [31:0]               raster_clocks,
    output logic [31:0]               clocks_walking,
    output logic [31:0]               clocks_empty,
    output logic [31:0]               groups_in,
    output logic [31:0]               pixels_covered,
    output logic [31:0]               pixels_drawn,
    output logic [31:0]               clocks_held,
    output logic [31:0]               clocks_memory,
    output logic [31:0]               clocks_flush,
    // A field of a raymarcher beside the engine: see raster_unit.
    input  wire                       field,
    input  wire  [1:0]                compose,
    output logic                      field_start,
    output logic                      field_open,
    input  wire                       field_done,
    output logic                      field_next,
    input  wire                       field_valid,
    output logic                      field_ready,
    input  wire  [1:0]                field_halves,
    input  wire  [10:0]               field_row,
    input  wire  [5:0]                field_line,
    input  wire  [7:0]                field_column,
    input  wire  [7:0]                field_mask,
    input  wire  [17:0]               field_code,
    input  wire  [15:0]               field_colour,
    // Memory.
    output logic                       mesh_read_cmd_valid,
    input  wire                        mesh_read_cmd_ready,
    output logic  [ADDRESS_BITS-1:0]   mesh_read_cmd_addr,
    input  wire                        mesh_read_rdata_valid,
    input  wire   [127:0]              mesh_read_rdata,
    output logic                       vertex_read_cmd_valid,
    input  wire                        vertex_read_cmd_ready,
    output logic  [ADDRESS_BITS-1:0]   vertex_read_cmd_addr,
    input  wire                        vertex_read_rdata_valid,
    input  wire   [127:0]              vertex_read_rdata,
    output logic                       raster_read_cmd_valid,
    input  wire                        raster_read_cmd_ready,
    output logic  [ADDRESS_BITS-1:0]   raster_read_cmd_addr,
    input  wire                        raster_read_rdata_valid,
    input  wire   [127:0]              raster_read_rdata,
    output logic                      descriptors_cmd_valid,
    input  wire                       descriptors_cmd_ready,
    output logic [ADDRESS_BITS-1:0]   descriptors_cmd_addr,
    output logic                      descriptors_wdata_valid,
    input  wire                       descriptors_wdata_ready,
    output logic [127:0]              descriptors_wdata,
    output logic [15:0]               descriptors_wdata_strobe,
    output logic                      lists_cmd_valid,
    input  wire                       lists_cmd_ready,
    output logic [ADDRESS_BITS-1:0]   lists_cmd_addr,
    output logic                      lists_wdata_valid,
    input  wire                       lists_wdata_ready,
    output logic [127:0]              lists_wdata,
    output logic [15:0]               lists_wdata_strobe,
    output logic                      frame_even_cmd_valid,
    input  wire                       frame_even_cmd_ready,
    output logic [ADDRESS_BITS-1:0]   frame_even_cmd_addr,
    output logic                      frame_even_wdata_valid,
    input  wire                       frame_even_wdata_ready,
    output logic [127:0]              frame_even_wdata,
    output logic [15:0]               frame_even_wdata_strobe,
    output logic                      frame_odd_cmd_valid,
    input  wire                       frame_odd_cmd_ready,
    output logic [ADDRESS_BITS-1:0]   frame_odd_cmd_addr,
    output logic                      frame_odd_wdata_valid,
    input  wire                       frame_odd_wdata_ready,
    output logic [127:0]              frame_odd_wdata,
    output logic [15:0]               frame_odd_wdata_strobe
);
    localparam int unsigned RASTER_CLIENTS = 3;
    localparam int unsigned CLIENTS        = 2 + RASTER_CLIENTS;

    logic [CLIENTS-1:0]              ask_valid, ask_ready, data_valid, data_ready;
    logic [CLIENTS*ADDRESS_BITS-1:0] ask_addr;
    logic [CLIENTS*128-1:0]          data;
    logic [2:0]                      ports_idle;
    logic                            dropping, drop, raster_ready;

    assign drop = cancel || dropping;
    assign ready = !dropping && raster_ready;
    assign frame_even_wdata_strobe  = '1;
    assign frame_odd_wdata_strobe   = '1;
    assign descriptors_wdata_strobe = '1;

    always_ff @(posedge clk) begin
        if (&ports_idle) dropping <= 1'b0;
        if (cancel)     dropping <= 1'b1;
        if (rst)       dropping <= 1'b0;
    end

    read_port #(.CLIENTS(1), .ADDRESS_BITS(ADDRESS_BITS)) mesh_read (
        .clk, .rst, .drop, .idle(ports_idle[0]),
        .ask_valid(ask_valid[0]), .ask_ready(ask_ready[0]), .ask_addr(ask_addr[1*ADDRESS_BITS-1:0]),
        .data_valid(data_valid[0]), .data_ready(data_ready[0]), .data(data[1*128-1:0]),
        .cmd_valid(mesh_read_cmd_valid), .cmd_ready(mesh_read_cmd_ready), .cmd_addr(mesh_read_cmd_addr),
        .rdata_valid(mesh_read_rdata_valid), .rdata(mesh_read_rdata)
    );

    read_port #(.CLIENTS(1), .ADDRESS_BITS(ADDRESS_BITS)) vertex_read (
        .clk, .rst, .drop, .idle(ports_idle[1]),
        .ask_valid(ask_valid[1]), .ask_ready(ask_ready[1]), .ask_addr(ask_addr[2*ADDRESS_BITS-1:1*ADDRESS_BITS]),
        .data_valid(data_valid[1]), .data_ready(data_ready[1]), .data(data[2*128-1:1*128]),
        .cmd_valid(vertex_read_cmd_valid), .cmd_ready(vertex_read_cmd_ready), .cmd_addr(vertex_read_cmd_addr),
        .rdata_valid(vertex_read_rdata_valid), .rdata(vertex_read_rdata)
    );

    read_port #(.CLIENTS(RASTER_CLIENTS), .ADDRESS_BITS(ADDRESS_BITS)) raster_read (
        .clk, .rst, .drop, .idle(ports_idle[2]),
        .ask_valid(ask_valid[4:2]), .ask_ready(ask_ready[4:2]), .ask_addr(ask_addr[5*ADDRESS_BITS-1:2*ADDRESS_BITS]),
        .data_valid(data_valid[4:2]), .data_ready(data_ready[4:2]), .data(data[5*128-1:2*128]),
        .cmd_valid(raster_read_cmd_valid), .cmd_ready(raster_read_cmd_ready), .cmd_addr(raster_read_cmd_addr),
        .rdata_valid(raster_read_rdata_valid), .rdata(raster_read_rdata)
    );

    geometry_unit #(.ADDRESS_BITS(ADDRESS_BITS), .COUNT_BITS(COUNT_BITS), .SMOOTH(SMOOTH)) geometry (
        .clk, .rst, .restart(cancel), .start(geometry_start), .busy(geometry_busy), .done(geometry_done), .mesh_error, .full,
        .mesh_first, .mesh_last, .descriptor_base(geometry_descriptors), .descriptor_limit, .list_base(geometry_lists),
        .list_shift, .exception_base, .exception_limit, .size(geometry_size), .cull_back, .smooth, .scale_shift,
        .row_u, .row_v, .row_n, .tx, .ty, .tz, .near_z, .depth_mantissa, .depth_exponent,
        .ask_valid(ask_valid[1:0]), .ask_ready(ask_ready[1:0]), .ask_addr(ask_addr[2*ADDRESS_BITS-1:0]),
        .data_valid(data_valid[1:0]), .data_ready(data_ready[1:0]), .data(data[2*128-1:0]),
        .descriptors_cmd_valid, .descriptors_cmd_ready, .descriptors_cmd_addr,
        .descriptors_wdata_valid, .descriptors_wdata_ready, .descriptors_wdata,
        .lists_cmd_valid, .lists_cmd_ready, .lists_cmd_addr,
        .lists_wdata_valid, .lists_wdata_ready, .lists_wdata, .lists_wdata_strobe,
        .triangles, .unseen_count, .culled_count, .descriptors, .exceptions, .clocks_busy(geometry_clocks), .vertices
    );

    raster_unit #(.ADDRESS_BITS(ADDRESS_BITS), .COUNT_BITS(COUNT_BITS), .SMOOTH(SMOOTH), .FIELDS(FIELDS)) raster (
        .clk, .rst, .restart(cancel), .ready(raster_ready), .start(raster_start), .busy(raster_busy), .done(raster_done),
        .size(raster_size), .frame_base, .depth_base, .with_depth, .clear, .frame_slot, .whole, .present,
        .list_base(raster_lists), .descriptor_base(raster_descriptors), .counts(raster_counts), .list_shift, .list_error,
        .field, .compose, .field_start, .field_open, .field_done, .field_next, .field_valid, .field_ready, .field_halves,
        .field_row, .field_line, .field_column, .field_mask, .field_code, .field_colour,
        .ask_valid(ask_valid[4:2]), .ask_ready(ask_ready[4:2]), .ask_addr(ask_addr[5*ADDRESS_BITS-1:2*ADDRESS_BITS]),
        .data_valid(data_valid[4:2]), .data_ready(data_ready[4:2]), .data(data[5*128-1:2*128]),
        .cmd_valid({frame_odd_cmd_valid, frame_even_cmd_valid}), .cmd_ready({frame_odd_cmd_ready, frame_even_cmd_ready}),
        .cmd_addr({frame_odd_cmd_addr, frame_even_cmd_addr}),
        .wdata_valid({frame_odd_wdata_valid, frame_even_wdata_valid}),
        .wdata_ready({frame_odd_wdata_ready, frame_even_wdata_ready}), .wdata({frame_odd_wdata, frame_even_wdata}),
        .clocks_busy(raster_clocks), .clocks_walking, .clocks_empty, .groups_in, .pixels_covered, .pixels_drawn, .clocks_held, .clocks_memory, .clocks_flush
    );
endmodule

`default_nettype wire

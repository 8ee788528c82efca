// Draws the part of a triangle that is in a band: descriptors in, groups of eight pixels out.
//
//               ┌────────────┐     ┌────────┐     ┌───────┐     ┌─────────────┐
//   triangle ──▶│ band_entry │────▶│ walker │────▶│ lanes │────▶│ skid_buffer │──▶ group
//               └────────────┘     └────────┘     └───────┘     └─────────────┘
//
// A group is {line = y - y0, column = x / 8, row address in the band = line * stride + column, mask, eight depth codes u18, eight
// colours RGB565}, lane 0 (the leftmost) in the lowest bits, mask never 0. A triangle gives each of its groups once; triangles
// keep their order.
//
// Streams are valid/ready with a register between any two readies. Latency 18 clocks from a descriptor to its first group.
// Throughput: a group of the walk a clock, at most a triangle in 12 clocks. The band's first row `y0`, its `rows` and its
// `stride` (groups in a line: 40, 80 or 160) hold while not `idle`, which is low from the clock after a descriptor was taken until its last
// group was taken. For counters: `walking` in clocks in which the walker is at a group, `candidate` in those of them in
// which it goes to the lanes, `stalled` in clocks in which a group waits to be taken.

`default_nettype none

module triangle_raster (
    input  wire                            clk,
    input  wire                            rst,
    input  wire  [9:0]                     y0,
    input  wire  [5:0]                     rows,
    input  wire  [7:0]                     stride,
    output logic                           idle,
    output logic                           walking,
    output logic                           candidate,
    output logic                           stalled,
    // Descriptors.
    input  wire                            triangle_valid,
    output logic                           triangle_ready,
    input  wire triangle_pkg::descriptor_t triangle_descriptor,
    // Groups.
    output logic                           group_valid,
    input  wire                            group_ready,
    output logic [10:0]                    group_row,
    output logic [5:0]                     group_line,
    output logic [7:0]                     group_column,
    output logic [7:0]                     group_mask,
    output logic [8*18-1:0]                group_codes,
    output logic [8*16-1:0]                group_colours
);
    logic                   entry_idle, walker_idle, lanes_idle;
    logic                   placed_valid, placed_ready;
    raster_pkg::placed_t    placed;
    logic                   walked_valid, walked_ready;
    raster_pkg::candidate_t walked;

    assign idle      = entry_idle && walker_idle && lanes_idle && !group_valid;
    assign candidate = walked_valid && walked_ready;
    assign stalled   = group_valid && !group_ready;

    band_entry band_entry (
        .clk, .rst, .y0, .rows, .idle(entry_idle),
        .in_valid(triangle_valid), .in_ready(triangle_ready), .in_descriptor(triangle_descriptor),
        .out_valid(placed_valid), .out_ready(placed_ready), .out_triangle(placed)
    );

    walker walker (
        .clk, .rst, .idle(walker_idle), .walking,
        .in_valid(placed_valid), .in_ready(placed_ready), .in_triangle(placed),
        .out_valid(walked_valid), .out_ready(walked_ready), .out_group(walked)
    );

    typedef struct packed {
        logic [10:0]      row;
        logic [5:0]       line;
        logic [7:0]       column;
        logic [7:0]       mask;
        logic [7:0][17:0] codes;
        logic [15:0]      colour;
    } group_t;

    group_t made, group;
    logic   made_valid, made_ready;

    lanes lanes (
        .clk, .rst, .stride, .idle(lanes_idle),
        .in_valid(walked_valid), .in_ready(walked_ready), .in_group(walked),
        .out_valid(made_valid), .out_ready(made_ready), .out_row(made.row), .out_line(made.line), .out_column(made.column),
        .out_mask(made.mask),
        .out_codes(made.codes), .out_colour(made.colour)
    );

    skid_buffer #(.WIDTH($bits(made))) skid_buffer (
        .clk, .rst, .in_valid(made_valid), .in_ready(made_ready), .in_data(made),
        .out_valid(group_valid), .out_ready(group_ready), .out_data(group)
    );

    assign group_row     = group.row;
    assign group_line    = group.line;
    assign group_column  = group.column;
    assign group_mask    = group.mask;
    assign group_codes   = group.codes;
    assign group_colours = {8{group.colour}};
endmodule

`default_nettype wire

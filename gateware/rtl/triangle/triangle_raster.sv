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
// Streams are valid/ready with a register between any two readies. Latency 19 clocks from a descriptor to its first group.
// Throughput: a group of the walk a clock, at most a triangle in 8 clocks. A band's first row `triangle_y0` comes with each of
// its triangles, and so does `triangle_odd`, which tells it from the bands before and after: triangles of the next band may
// come and are prepared, but wait until `odd`, that of the band that is drawn, is theirs. `idle` is high when nothing of that
// band is inside, and low from the clock after its descriptor was taken until its last group was taken. `rows` of a band and
// `stride` (groups in a line: 40, 80 or 160) hold while triangles are inside. For counters: `walking` in clocks in which the
// walker is at a group, `candidate` in those of them in which it goes to the lanes, `stalled` in clocks in which a group waits to
// be taken.

`default_nettype none

module triangle_raster (
    input  wire                            clk,
    input  wire                            rst,
    input  wire                            odd,
    input  wire  [5:0]                     rows,
    input  wire  [7:0]                     stride,
    output logic                           idle,
    output logic                           walking,
    output logic                           candidate,
    output logic                           stalled,
    // Descriptors.
    input  wire                            triangle_valid,
    output logic                           triangle_ready,
    input  wire  [9:0]                     triangle_y0,
    input  wire                            triangle_odd,
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
    logic                   walker_idle, lanes_idle, waits;
    logic [1:0]             holds;
    logic                   placed_valid, placed_ready, placed_odd;
    raster_pkg::placed_t    placed;
    logic                   walked_valid, walked_ready;
    raster_pkg::candidate_t walked;

    assign waits     = placed_odd != odd;
    assign idle      = !holds[odd] && walker_idle && lanes_idle && !group_valid;
    assign candidate = walked_valid && walked_ready;
    assign stalled   = group_valid && !group_ready;

    band_entry band_entry (
        .clk, .rst, .rows, .holds,
        .in_valid(triangle_valid), .in_ready(triangle_ready), .in_y0(triangle_y0), .in_odd(triangle_odd),
        .in_descriptor(triangle_descriptor),
        .out_valid(placed_valid), .out_ready(placed_ready && !waits), .out_odd(placed_odd), .out_triangle(placed)
    );

    walker walker (
        .clk, .rst, .idle(walker_idle), .walking,
        .in_valid(placed_valid && !waits), .in_ready(placed_ready), .in_triangle(placed),
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

// Smooth shading: computes the colours of the pixels of a group, one after the other.
//
//            ┌─ pipeline_fifo: groups ───────────────────────────────────────────────┐
//   group ──▶┤                                                                       ├──▶ group with eight colours
//            └─ fifo: light ─▶ pixel: light, depth ─▶ pixel_colour ─▶ round ─▶ fifo ─┘
//                                  ▲      │ + step_x
//                                  └──────┘
//
// The colours of smooth triangles are rounded to RGB565; with `dither`, the threshold depends on the position of the pixel. `in_line` has
// the lowest bits of the number of the picture's line. With FRACTIONS, these colours are not rounded yet, and all colours have the format
// of the input of colour_pkg::rounded.
//
// A group of a flat triangle takes one clock. A group of a smooth triangle takes one clock per pixel, from the first pixel (the fifth if
// the first four are not covered) to the last covered pixel: about five clocks on average, and at most eight. Three multipliers therefore
// suffice for the divisions; one group per clock would need 24.
//
// The source of the groups is a pipeline that cannot be stopped. The pipeline sends groups only while `room` is high; a group arrives
// FLIGHT clocks after it is sent (see pipeline_fifo). Latency 2 clocks for a flat group, 14 clocks plus one per pixel for a smooth group;
// groups stay in order. Output: a valid/ready stream. `idle` is high while no group is inside.

`default_nettype none

module smooth_shader #(
    parameter int unsigned GROUP_BITS = 8,
    parameter int unsigned FLIGHT     = 5,
    // Depth of each FIFO, a power of two.
    parameter int unsigned GROUPS     = 16,
    parameter bit          FRACTIONS  = 1'b0,
    // Latency of pixel_colour in clocks.
    parameter int unsigned LATENCY    = 8,
    localparam int unsigned COLOUR_BITS = FRACTIONS ? 24 : 16
) (
    input  wire                   clk,
    input  wire                   rst,
    input  wire                   dither,          // constant while groups are inside
    output logic                  idle,
    output logic                  room,
    input  wire                   in_valid,
    input  wire  [GROUP_BITS-1:0] in_group,
    input  wire  [7:0]            in_mask,
    input  wire  [1:0]            in_line,
    input  wire  [15:0]           in_colour,       // of a flat triangle
    input  wire                   in_smooth,
    input  wire  [31:0]           in_depth,        // of the first pixel, with half a depth code added
    input  wire  [31:0]           in_depth_step_x,
    input  wire  [2:0][31:0]      in_light,        // of the first pixel, red in the lowest bits
    input  wire  [2:0][31:0]      in_light_step_x,
    output logic                  out_valid,
    input  wire                   out_ready,
    output logic [GROUP_BITS-1:0] out_group,
    output logic [7:0][COLOUR_BITS-1:0] out_colours
);
    // Groups that wait for their colours.
    logic             group_valid, group_smooth, group_gone, colours_valid;
    logic [15:0]      group_colour;
    logic [7:0][COLOUR_BITS-1:0] smooth_colours;
    logic [COLOUR_BITS-1:0]      flat_colour;

    pipeline_fifo #(.WIDTH(GROUP_BITS + 17), .DEPTH(GROUPS), .FLIGHT(FLIGHT)) groups (
        .clk, .rst, .idle, .room, .in_valid, .in_data({in_smooth, in_colour, in_group}),
        .out_valid(group_valid), .out_ready(group_gone), .out_data({group_smooth, group_colour, out_group})
    );

    assign out_valid   = group_valid && (!group_smooth || colours_valid);
    assign group_gone  = out_ready && (!group_smooth || colours_valid);
    assign out_colours = group_smooth ? smooth_colours : {8{flat_colour}};

    // Four accumulators: the depth, then red, green and blue. This FIFO holds a subset of the groups in the FIFO of groups, so it is never
    // full unless the FIFO of groups is full.
    logic             light_valid, light_room, takes, is_first, is_last, upper;
    logic [2:0]       lane, last_lane;
    logic [1:0]       first_line, line, line_place;
    logic [3:0][31:0] starts, steps, values;

    fifo #(.WIDTH(2 + 3 + 1 + 8 * 32), .DEPTH(GROUPS)) light (
        .clk, .rst, .in_valid(in_valid && in_smooth), .in_ready(light_room),
        .in_data({in_line, last_covered(in_mask), in_mask[3:0] == '0, in_light_step_x, in_depth_step_x, in_light, in_depth}),
        .out_valid(light_valid), .out_ready(takes && is_last), .out_data({first_line, last_lane, upper, steps, starts})
    );

    function automatic logic [2:0] last_covered(input logic [7:0] mask);
        last_covered = '0;
        for (int i = 0; i < 8; i++) if (mask[i]) last_covered = 3'(i);
    endfunction

    // The pixel in lane `next_lane` enters the pipeline.
    logic [2:0] next_lane;

    assign takes     = light_valid;
    assign next_lane = is_first ? {upper, 2'd0} : lane + 1'b1;
    assign is_last   = next_lane == last_lane;

    always_ff @(posedge clk) begin
        if (takes) begin
            is_first <= is_last;
            lane     <= next_lane;
            line     <= first_line;
            for (int k = 0; k < 4; k++)
                values[k] <= is_first ? starts[k] + (upper ? steps[k] << 2 : '0) : values[k] + steps[k];
        end
        if (rst) is_first <= 1'b1;
    end

    // The position of a pixel in its group travels with the pixel through pixel_colour.
    logic [LATENCY:0] valid;
    logic             ends_1, ends, finished, colours_room;
    logic [2:0]       place;
    logic [2:0][7:0]  colour;
    logic [COLOUR_BITS-1:0]      rounded;
    logic [7:0][COLOUR_BITS-1:0] collected;

    pixel_colour pixel_colour (.clk, .dither, .depth(values[0]), .light(values[3:1]), .colour);

    delay #(.WIDTH(6), .CLOCKS(LATENCY)) place_delay (
        .clk, .enable(1'b1), .in({ends_1, line, lane}), .out({ends, line_place, place})
    );

    if (FRACTIONS) begin : exact
        assign flat_colour = colour_pkg::fractions(group_colour);
        assign rounded     = colour;
        wire _unused = &{1'b0, line_place};
    end else begin : rounding
        assign flat_colour = group_colour;
        assign rounded     = colour_pkg::rounded(colour, colour_pkg::threshold(dither, place[1:0], line_place));
    end

    always_ff @(posedge clk) begin
        valid    <= {valid[LATENCY-1:0], takes};
        ends_1   <= is_last;
        finished <= valid[LATENCY] && ends;
        if (rst) begin
            valid    <= '0;
            finished <= 1'b0;
        end
    end

    always_ff @(posedge clk) begin
        for (int i = 0; i < 8; i++)
            if (place == 3'(i)) collected[i] <= rounded;
    end

    // This FIFO only holds colours of groups that are in the FIFO of groups, so it is never full.
    fifo #(.WIDTH(8 * COLOUR_BITS), .DEPTH(GROUPS)) finished_colours (
        .clk, .rst, .in_valid(finished), .in_ready(colours_room), .in_data(collected),
        .out_valid(colours_valid), .out_ready(out_ready && group_valid && group_smooth), .out_data(smooth_colours)
    );

    wire _unused = &{1'b0, light_room, colours_room};
endmodule

`default_nettype wire

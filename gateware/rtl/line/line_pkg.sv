// Types of the values that the modules of the line engine exchange. docs/formats/line.md, "Lines", explains the number formats.

`default_nettype none

package line_pkg;
    // A segment from the end point a to the end point b: x and y in pixels, s12.8; w is the depth code before its rounding, u18.6.
    typedef struct packed {
        logic [15:0] colour;
        logic [23:0] b_w;
        logic [19:0] b_y;
        logic [19:0] b_x;
        logic [23:0] a_w;
        logic [19:0] a_y;
        logic [19:0] a_x;
    } segment_t;

    // A piece: the part of a line in one band and in the picture, given by its first pixel. It ends with the line, or where the
    // line leaves the band or the picture.
    typedef struct packed {
        logic [15:0] colour;
        logic [33:0] depth_step;   // increment of the depth for one pixel, s20.14
        logic [33:0] depth;        // depth accumulator of the first pixel, with the bias and half a depth code, s20.14
        logic [20:0] fall;         // increment of the error for one pixel with a step along the minor axis: minor - major
        logic [19:0] minor;        // increment of the error for one pixel without such a step
        logic [20:0] error;        // error of the second pixel; from 0 on, the way to it has a step along the minor axis
        logic [11:0] count;        // pixels up to the end of the line
        logic [9:0]  row;          // of the first pixel
        logic [10:0] column;
        logic        up;           // towards lower rows
        logic        left;         // towards lower columns
        logic        x_major;      // a pixel in each column; otherwise in each row
    } piece_t;

    // A piece in memory, in the place of a triangle_pkg::descriptor_t. Its mark is at the highest bits of `group_start`, which in a
    // triangle are at most 2, because no picture has 192 groups. Places that the piece does not need repeat bits of it.
    typedef struct packed {
        logic [15:0]  colour;
        logic [1:0]   mark;
        logic [7:0]   zeros;
        logic [37:0]  high;        // bits 165 to 128 of the piece
        logic [63:0]  repeats_low;
        logic [127:0] low;         // bits 127 to 0 of the piece
        logic [127:0] repeats;
    } stored_t;

    /* verilator lint_off UNUSEDPARAM */
    localparam logic [1:0] MARK = 2'd3;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

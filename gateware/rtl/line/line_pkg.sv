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
endpackage

`default_nettype wire

// Types between the parts of triangle_raster.

`default_nettype none

package raster_pkg;
    // A triangle at the row where it enters the band, in its start group. An edge function is linear, so within a group of
    // eight lanes it is largest at one end: in lane 7 if it rises to the right, else in lane 0. The lane beside the other end,
    // lane -1 if the edge rises and else lane 8, shows whether the edge passes anywhere in the next group on that side.
    typedef struct packed {
        logic [2:0][33:0] best;         // E' at the lane where it is largest
        logic [2:0][33:0] beside;       // E' at the lane beside
        logic [31:0]      depth;        // accumulator at lane 0, with half a code added
        logic [2:0][20:0] step_x;
        logic [2:0][20:0] step_y;
        logic [31:0]      depth_step_x;
        logic [31:0]      depth_step_y;
        logic [2:0][19:0] slope;        // |step_x|
        logic [2:0]       rises;        // step_x > 0
        logic [2:0]       falls;        // step_x < 0
        logic [5:0]       line;         // the row, from the band's first one
        logic [5:0]       rows;         // in the band, at least 1
        logic [7:0]       group_left;
        logic [7:0]       group_right;
        logic [7:0]       group_start;
        logic [15:0]      colour;
    } placed_t;

    // A group of eight pixels in which every edge passes in at least one lane: every `best` is at least 0.
    typedef struct packed {
        logic [5:0]       line;
        logic [7:0]       group;
        logic [2:0][32:0] best;
        logic [2:0][19:0] slope;
        logic [2:0]       rises;
        logic [31:0]      depth;
        logic [31:0]      depth_step_x;
        logic [15:0]      colour;
    } candidate_t;
endpackage

`default_nettype wire

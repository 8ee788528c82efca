// Types of the values that the modules inside triangle_raster exchange.

`default_nettype none

package raster_pkg;
    // A triangle at the row where it enters the band, in its start group. A group is eight neighbouring pixels of a row, lanes
    // 0 (left) to 7. E' is the value of an edge function (docs/formats/triangle.md, "Triangle setup"); an edge passes in a lane if its E'
    // is at least 0 in this lane. E' is linear, so within a group its largest value, `best`, is in lane 7 if the edge rises to the right,
    // and in lane 0 otherwise. `beside` is E' one lane outside of the opposite end of the group, in lane -1 if the edge rises, and in lane
    // 8 otherwise. The sign of `beside` shows whether the edge passes anywhere in the next group on that side.
    typedef struct packed {
        logic [2:0][33:0] best;         // E' in the lane where it is largest
        logic [2:0]       beside_fails; // E' < 0 in lane -1 or lane 8, as explained above
        logic [2:0][19:0] slope;        // |step_x|
        logic [2:0][20:0] step_y;
        logic [2:0]       rises;        // step_x > 0
        logic [2:0]       falls;        // step_x < 0
        logic [5:0]       rows;         // number of the triangle's rows in the band, at least 1
        logic [7:0]       group_left;
        logic [7:0]       group_right;
        logic [7:0]       group_start;
    } placed_t;

    // The fields of the same triangle that do not affect the walk. These fields are valid one clock later.
    typedef struct packed {
        logic [31:0] depth;        // depth accumulator in lane 0, with half a depth code added
        logic [31:0] depth_step_x;
        logic [31:0] depth_step_y;
        logic [5:0]  line;         // number of the row, counted from the first row of the band
        logic [15:0] colour;
    } placed_late_t;

    // The walker's next group: the group to the left or to the right, the first group of the next row, or the first group of the next
    // triangle.
    typedef enum logic [1:0] {DOWN, LOAD, LEFT, RIGHT} move_t;

    // A group of eight pixels that the triangle may cover, because every edge passes in at least one of its lanes (every `best` is at least
    // 0). The fields have the same meanings as the fields of placed_t, at this group.
    typedef struct packed {
        logic [7:0]       group;
        logic [2:0][32:0] best;
        logic [2:0][19:0] slope;
        logic [2:0]       rises;
    } candidate_t;

    // The other fields of the same group. These fields are valid one clock later.
    typedef struct packed {
        logic [5:0]  line;
        logic [31:0] depth;
        logic [31:0] depth_step_x;
        logic [31:0] depth_step_y;
        logic [15:0] colour;
    } late_t;

    // Number of clocks from the other late fields to the planes of light. With this delay the light of a group is valid in the same clock
    // as the mask from `lanes`.
    localparam int unsigned LIGHT_LATER = 3;
endpackage

`default_nettype wire

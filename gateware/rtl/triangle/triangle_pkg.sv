// Types of the values that the modules of the triangle engine exchange. docs/formats/triangle.md explains the number formats.

`default_nettype none

package triangle_pkg;
    // A vertex on the screen: x and y in pixels, s12.8; w is the depth code before its rounding, u18.6.
    typedef struct packed {
        logic [23:0] w;
        logic [20:0] y;
        logic [20:0] x;
    } screen_vertex_t;

    // A vertex after the vertex stage. `behind` marks a vertex behind the near plane, and its `place` is 0. `beyond` marks a
    // vertex outside the guard band; its `place` is saturated, and only shows beyond which sides of the picture the vertex is.
    typedef struct packed {
        logic           behind;
        logic           beyond;
        screen_vertex_t place;
    } projected_t;

    // Increments of an edge function E' (docs/formats/triangle.md, "Triangle setup", step 5) over one pixel down (y) and over one pixel
    // to the right (x), s21.
    typedef struct packed {
        logic [20:0] y;
        logic [20:0] x;
    } steps_t;

    // A triangle after the setup, 384 bits, as stored in memory: three words of 128 bits, the lowest first. A group is 8
    // columns of a row. `start` and `depth_start` are the values of E' and of the depth at the first column of group_start in
    // row `top`. The steps are an array of vectors, not of steps_t, because Yosys reads an array of structs as a narrower type,
    // without a message.
    typedef struct packed {
        logic [15:0]      colour;       // RGB565, lit
        logic [7:0]       group_start;  // the group of the topmost vertex, clamped to the bounds
        logic [7:0]       group_right;  // the last group within the bounds
        logic [7:0]       group_left;   // the first group within the bounds
        logic [9:0]       bottom;       // number of the last row plus 1
        logic [9:0]       top;          // the first row
        logic [2:0][41:0] steps;        // increments of E', a steps_t for each edge
        logic [31:0]      depth_step_y; // 18.14, modulo 2^32
        logic [31:0]      depth_step_x;
        logic [31:0]      depth_start;
        logic [2:0][33:0] start;        // E' of each edge, s34
    } descriptor_t;

    // Light of a vertex with smooth shading: whether it belongs to back faces, and the shaded colour L of each channel
    // (docs/formats/triangle.md, "Smooth shading"), red and blue in units of 2^-13, green in units of 2^-14. Builds without smooth
    // shading replace this type and each of the following types by one bit, 0.
    typedef struct packed {
        logic        back;
        logic [12:0] red;
        logic [13:0] green;
        logic [12:0] blue;
    } light_t;

    // A plane of light, the linear function that interpolates one colour channel on the screen: its accumulator at
    // the triangle's start, and the increments of the accumulator for one pixel right and one pixel down, in the
    // format of the depth.
    typedef struct packed {
        logic [31:0] step_y;
        logic [31:0] step_x;
        logic [31:0] start;
    } plane_t;

    // The planes of light of a triangle, red in the lowest bits. They follow the descriptor_t in memory. Without `smooth` the
    // triangle has one colour.
    typedef struct packed {
        logic             smooth;
        logic [2:0][95:0] light; // a plane_t each
    } planes_t;
endpackage

`default_nettype wire

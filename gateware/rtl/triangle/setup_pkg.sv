// Type of the triangles that the module `cull` passes to the later stages of the triangle setup.

`default_nettype none

package setup_pkg;
    // A triangle that is accepted for drawing: its area is not 0, and its vertices are ordered clockwise on the screen. x10 is the
    // difference x1 − x0 of vertices 1 and 0, and so on. x02 and y01 are the negated differences of docs/formats/triangle.md, so that sums
    // of products need no subtraction.
    typedef struct packed {
        logic             front;
        logic [2:0][15:0] normal;      // s2.14
        logic [15:0]      colour;      // RGB565
        logic [9:0]       top;         // as in descriptor_t
        logic [9:0]       bottom;
        logic [7:0]       group_left;
        logic [7:0]       group_right;
        logic [7:0]       group_start;
        logic [39:0]      area;        // twice the area, a in docs/formats/triangle.md
        logic [24:0]      not_w20;     // complement of w20
        logic [24:0]      not_w10;
        logic [20:0]      y20;
        logic [20:0]      x02;
        logic [20:0]      y01;
        logic [20:0]      x10;
        logic [23:0]      w0;
        logic [20:0]      y0;
        logic [20:0]      x0;
    } oriented_t;
endpackage

`default_nettype wire

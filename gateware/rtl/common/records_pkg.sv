// Generated from gateware/glint_soc/records.py by `cargo xtask pac`. Do not edit.
// Records in memory. docs/formats/records.md explains the fields.

`default_nettype none

package records_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Value of the field `mark` of a stored_piece_t.
    localparam logic [1:0] PIECE_MARK = 2'd3;

    // Header of a chunk of a mesh.
    typedef struct packed {
        logic [1:0][31:0] reserved_64;
        logic [31:0] triangles;
        logic [31:0] vertices;
    } chunk_t;

    // Vertex of a mesh.
    typedef struct packed {
        logic [7:0] reserved_120;
        logic [7:0] fine;
        logic [15:0] colour;
        logic [2:0][15:0] normal;
        logic [2:0][15:0] position;
    } vertex_t;

    // Triangle of a mesh.
    typedef struct packed {
        logic [7:0] reserved_120;
        logic [7:0] texture;
        logic [2:0][15:0] normal;
        logic [15:0] colour;
        logic [2:0][15:0] indices;
    } triangle_t;

    // Header of a texture.
    typedef struct packed {
        logic [8:0][7:0] reserved_184;
        logic [7:0] blend;
        logic [15:0] key;
        logic [7:0] cut_out;
        logic [7:0] filter;
        logic [1:0][7:0] wrap;
        logic [7:0] format;
        logic [7:0] levels;
        logic [7:0] height_log2;
        logic [7:0] width_log2;
        logic [31:0] checksum;
        logic [31:0] length;
        logic [3:0][7:0] magic;
    } texture_header_t;

    // End point of a segment.
    typedef struct packed {
        logic [15:0] reserved_112;
        logic [15:0] side;
        logic [7:0] reserved_88;
        logic [23:0] w;
        logic [11:0] reserved_52;
        logic [19:0] y;
        logic [11:0] reserved_20;
        logic [19:0] x;
    } segment_end_t;

    // Increments of an edge function.
    typedef struct packed {
        logic [20:0] y;
        logic [20:0] x;
    } steps_t;

    // Triangle after the setup, three words of 16 bytes.
    typedef struct packed {
        logic [15:0] colour;
        logic [7:0] group_start;
        logic [7:0] group_right;
        logic [7:0] group_left;
        logic [9:0] bottom;
        logic [9:0] top;
        logic [2:0][41:0] steps;
        logic [31:0] depth_step_y;
        logic [31:0] depth_step_x;
        logic [31:0] depth_start;
        logic [2:0][33:0] start;
    } descriptor_t;

    // Plane of a depth or of a channel of light.
    typedef struct packed {
        logic [31:0] step_y;
        logic [31:0] step_x;
        logic [31:0] start;
    } plane_t;

    // Planes of light of a triangle, in the three words after its descriptor.
    typedef struct packed {
        logic smooth;
        logic [2:0][95:0] light;
    } planes_t;

    // Texture of a triangle, in the two words after its descriptor.
    typedef struct packed {
        logic linear;
        logic [7:0] texture;
        logic [1:0][3:0] periods;
        logic [1:0][3:0] range;
        logic [2:0][7:0] light;
        logic [1:0][95:0] planes;
    } texture_planes_t;

    // Piece of a line.
    typedef struct packed {
        logic [15:0] colour;
        logic [33:0] depth_step;
        logic [33:0] depth;
        logic [20:0] fall;
        logic [19:0] minor;
        logic [20:0] error;
        logic [11:0] count;
        logic [9:0] row;
        logic [10:0] column;
        logic up;
        logic left;
        logic x_major;
    } piece_t;

    // Piece in memory, in the place of a descriptor.
    typedef struct packed {
        logic [15:0] colour;
        logic [1:0] mark;
        logic [7:0] reserved_358;
        logic [37:0] high;
        logic [63:0] repeats_low;
        logic [127:0] low;
        logic [127:0] repeats;
    } stored_piece_t;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

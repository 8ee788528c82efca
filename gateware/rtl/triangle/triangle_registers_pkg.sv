// Generated from gateware/glint_soc/triangle.py by `cargo xtask pac`. Do not edit.
// Constants and types of the block's ports. docs/registers.md describes the registers.

`default_nettype none

package triangle_registers_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    localparam int unsigned ADDRESS_BITS = 23;
    localparam int unsigned COUNT_BITS = 20;

    // Results of a pass.
    localparam logic [3:0] ERROR_NONE = 4'd0;
    localparam logic [3:0] ERROR_SIZE = 4'd1;
    localparam logic [3:0] ERROR_ADDRESS = 4'd2;
    localparam logic [3:0] ERROR_BUSY = 4'd3;
    localparam logic [3:0] ERROR_MESH = 4'd4;
    localparam logic [3:0] ERROR_FULL = 4'd5;
    localparam logic [3:0] ERROR_LIST = 4'd6;
    localparam logic [3:0] ERROR_CANCELLED = 4'd7;
    localparam logic [3:0] ERROR_TRIANGLES = 4'd8;
    localparam logic [3:0] ERROR_LINES = 4'd9;
    localparam logic [3:0] ERROR_GEOMETRY = 4'd10;

    // Flags of a geometry pass.
    typedef struct packed {
        logic [1:0] size;
        logic cull;
        logic smooth;
        logic append;
        logic mirror;
        logic recolour;
        logic lines;
        logic orthographic;
        logic textures;
        logic quarter;
        logic right;
        logic lower;
    } geometry_flags_t;

    // Parameters of the geometry pass. Memory regions are given by byte addresses.
    typedef struct packed {
        logic [31:0] mesh;
        logic [31:0] mesh_bytes;
        logic [31:0] descriptors;
        logic [19:0] descriptor_limit;
        logic [31:0] lists;
        logic [4:0] list_shift;
        logic [31:0] exceptions;
        logic [19:0] exception_limit;
        logic [2:0][8:0] light_colour;
        logic [2:0][8:0] ambient;
        logic [15:0] colour;
        logic [31:0] coordinates;
        logic [7:0] first_texture;
    } geometry_t;

    // Camera and light of the geometry pass: docs/formats/camera.md, "Frame constants".
    typedef struct packed {
        logic [4:0] scale_shift;
        logic [2:0][24:0] row_u;
        logic [2:0][24:0] row_v;
        logic [2:0][24:0] row_n;
        logic [43:0] tx;
        logic [43:0] ty;
        logic [43:0] tz;
        logic [38:0] near_z;
        logic [16:0] depth_mantissa;
        logic [3:0] depth_exponent;
        logic [2:0][24:0] row_light;
    } view_t;

    // Flags of a raster pass.
    typedef struct packed {
        logic [1:0] size;
        logic first;
        logic second;
        logic depth;
        logic slot;
        logic whole;
        logic sky;
        logic sky_first;
        logic fog;
        logic dither;
        logic average;
        logic quarter;
        logic right;
        logic lower;
    } raster_flags_t;

    // Parameters of the raster pass. Memory regions are given by byte addresses.
    typedef struct packed {
        logic [31:0] frame;
        logic [31:0] depth;
        logic [15:0] clear;
        logic [4:0] list_shift;
        logic [1:0][31:0] lists;
        logic [1:0][31:0] descriptors;
        logic [1:0][19:0] count;
        logic [31:0] textures;
    } raster_t;

    // The sky: heights, s8.23, and colours, {blue, green, red} (docs/formats/triangle.md, "Sky").
    typedef struct packed {
        logic [31:0] above;
        logic [31:0] across;
        logic [31:0] down;
        logic [23:0] zenith;
        logic [23:0] horizon;
        logic [23:0] nadir;
    } sky_t;

    // The fog: an offset of logarithms, s13, and a colour, {blue, green, red} (docs/formats/triangle.md, "Fog").
    typedef struct packed {
        logic [12:0] offset;
        logic [23:0] colour;
    } fog_t;

    // Results of the geometry pass.
    typedef struct packed {
        logic [31:0] triangles;
        logic [31:0] unseen;
        logic [31:0] culled;
        logic [19:0] descriptor_count;
        logic [19:0] exception_count;
    } results_t;

    // State of the engine. `geometry_done` and `raster_done` are high for one clock; the errors are valid in that clock.
    typedef struct packed {
        logic ready;
        logic geometry_busy;
        logic geometry_done;
        logic mesh_error;
        logic full;
        logic raster_busy;
        logic raster_done;
        logic list_error;
    } status_t;

    // Increment of each counter in this clock.
    typedef struct packed {
        logic cycles_busy;
        logic cycles_stalled;
        logic stalled_reads;
        logic stalled_lists;
        logic stalled_frame;
        logic items_in;
        logic items_out;
        logic cycles_geometry;
        logic vertices;
        logic cycles_raster;
        logic cycles_walking;
        logic cycles_empty;
        logic groups;
        logic [3:0] pixels_covered;
        logic [3:0] pixels_drawn;
        logic cycles_held;
        logic cycles_memory;
        logic cycles_flush;
    } events_t;

    // Link from a raymarcher to the engine.
    typedef struct packed {
        logic enable;
        logic [1:0] compose;
        logic done;
        logic valid;
        logic [1:0] halves;
        logic [10:0] row;
        logic [5:0] line;
        logic [7:0] column;
        logic [7:0] mask;
        logic [17:0] code;
        logic [15:0] colour;
    } field_source_t;

    // Link from the engine to a raymarcher.
    typedef struct packed {
        logic start;
        logic open;
        logic next;
        logic ready;
    } field_sink_t;

    // A read port of the memory: signals to the memory.
    typedef struct packed {
        logic cmd_valid;
        logic [22:0] cmd_addr;
    } read_request_t;

    // A read port of the memory: signals from the memory.
    typedef struct packed {
        logic cmd_ready;
        logic rdata_valid;
        logic [127:0] rdata;
    } read_answer_t;

    // A write port of the memory: signals to the memory.
    typedef struct packed {
        logic cmd_valid;
        logic [22:0] cmd_addr;
        logic wdata_valid;
        logic [127:0] wdata;
        logic [15:0] wdata_strobe;
    } write_request_t;

    // A write port of the memory: signals from the memory.
    typedef struct packed {
        logic cmd_ready;
        logic wdata_ready;
    } write_answer_t;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

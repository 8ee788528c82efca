// Generated from gateware/glint_soc/gesture.py by `cargo xtask pac`. Do not edit.
// Constants and types of the block's ports. docs/registers.md describes the registers.

`default_nettype none

package gesture_registers_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Channels of a pixel, 8 bits each.
    localparam logic [2:0] CHANNEL_RED = 3'd0;
    localparam logic [2:0] CHANNEL_GREEN = 3'd1;
    localparam logic [2:0] CHANNEL_BLUE = 3'd2;
    localparam logic [2:0] CHANNEL_LUMA = 3'd3;
    localparam logic [2:0] CHANNEL_CR = 3'd4;
    localparam logic [2:0] CHANNEL_CB = 3'd5;

    // Faults of a frame.
    localparam logic [2:0] FAULT_NONE = 3'd0;
    localparam logic [2:0] FAULT_PIXELS = 3'd1;
    localparam logic [2:0] FAULT_BYTE = 3'd2;
    localparam logic [2:0] FAULT_LINES = 3'd3;
    localparam logic [2:0] FAULT_CUT = 3'd4;
    localparam logic [2:0] FAULT_LOST = 3'd5;
    localparam logic [2:0] FAULT_STOPPED = 3'd6;

    // First and last column, or first and last line, of a box or region.
    typedef struct packed {
        logic [10:0] first;
        logic [10:0] last;
    } span_t;

    // Window of a channel.
    typedef struct packed {
        logic [2:0] channel;
        logic [7:0] lower;
        logic [7:0] upper;
    } window_t;

    // Properties of the image sensor's pins: polarities, byte order and clock edge.
    typedef struct packed {
        logic vsync_low;
        logic href_low;
        logic swap;
        logic falling;
    } pins_t;

    // Settings of a frame.
    typedef struct packed {
        logic [10:0] width;
        logic [9:0] height;
        window_t window_a;
        window_t window_b;
        span_t region_x;
        span_t region_y;
        logic [3:0] least_run;
    } frame_settings_t;

    // State of the engine and levels of its wires. `pixels` counts the pixels of the last line, `lines` the lines of the last
    // frame.
    typedef struct packed {
        logic running;
        logic waiting;
        logic vsync;
        logic href;
        logic scl;
        logic sda;
        logic [2:0] fault;
        logic [10:0] pixels;
        logic [10:0] lines;
    } status_t;

    // Results of a whole frame.
    typedef struct packed {
        logic [19:0] count;
        logic [29:0] sum_x;
        logic [28:0] sum_y;
        span_t box_x;
        span_t box_y;
        logic [39:0] sum_xx;
        logic [39:0] sum_xy;
        logic [39:0] sum_yy;
    } results_t;

    // Request for a small picture, and the read position in the picture. `start`, `set` and `move` are high for one clock.
    typedef struct packed {
        logic [2:0] step;
        logic colour;
        logic start;
        logic set;
        logic [10:0] place;
        logic move;
    } snapshot_t;

    // State of the small picture, and its word at the read position.
    typedef struct packed {
        logic [11:0] words;
        logic ready;
        logic [15:0] sequence_number;
        logic [15:0] word;
    } snapshot_state_t;

    // Increment of each counter in this clock.
    typedef struct packed {
        logic frames;
        logic frames_dropped;
        logic lines_malformed;
    } events_t;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

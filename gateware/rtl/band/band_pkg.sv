// Generated from gateware/glint_soc/constants.py by `cargo xtask pac`. Do not edit.
// Bands of a picture. A band has at most 15,360 pixels; a row of the band buffer holds eight pixels.

`default_nettype none

package band_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Number of the last band; numbers of a band's lines, of groups of eight pixels in a line, and of rows in the band buffer.
    typedef struct packed {
        logic [5:0]  last_band;
        logic [5:0]  lines;
        logic [7:0]  stride;
        logic [10:0] rows;
    } cut_t;

    // Division of a picture into bands, for the sizes 320x180, 640x360, 1280x720.
    function automatic cut_t cut(input logic [1:0] size);
        case (size)
            2'd0:    cut = {6'd3, 6'd45, 8'd40, 11'd1800};
            2'd1:    cut = {6'd14, 6'd24, 8'd80, 11'd1920};
            default: cut = {6'd59, 6'd12, 8'd160, 11'd1920};
        endcase
    endfunction

    // Number of lines of a band.
    function automatic int unsigned lines(input logic [1:0] size);
        case (size)
            2'd0:    lines = 45;
            2'd1:    lines = 24;
            default: lines = 12;
        endcase
    endfunction

    // Number of bands of a picture.
    function automatic logic [5:0] bands(input logic [1:0] size);
        case (size)
            2'd0:    bands = 6'd4;
            2'd1:    bands = 6'd15;
            default: bands = 6'd60;
        endcase
    endfunction
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

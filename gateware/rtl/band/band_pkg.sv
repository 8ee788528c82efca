// How a picture is cut into bands: at most 15,360 pixels each, a row of the band buffer for eight of them.

`default_nettype none

package band_pkg;
    // Bands, less one; lines and columns of eight of a band; its rows.
    typedef struct packed {
        logic [5:0]  last_band;
        logic [5:0]  lines;
        logic [7:0]  stride;
        logic [10:0] rows;
    } cut_t;

    // By size: 320x180, 640x360, 1280x720.
    function automatic cut_t cut(input logic [1:0] size);
        case (size)
            2'd0:    cut = {6'd3,  6'd45, 8'd40,  11'd1800};
            2'd1:    cut = {6'd14, 6'd24, 8'd80,  11'd1920};
            default: cut = {6'd59, 6'd12, 8'd160, 11'd1920};
        endcase
    endfunction
endpackage

`default_nettype wire

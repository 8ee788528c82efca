// Samples the bytes of an image sensor at its pins, in the domain of the sensor's clock, and converts them to tokens: a pixel of two
// bytes, the end of a line, the end of a frame.
//
//   pins ─▶ risen, fallen ─▶ sample ─▶ pairs of bytes ─▶ token
//
// A byte is valid while HREF is active and VSYNC is not. VSYNC is active between two frames: its start ends the frame and an unfinished
// line. The first byte of a line is the first byte of a pixel. A token is valid for one clock; if it is not accepted, `lost` is set in the
// next accepted token. The settings may come from any domain, because software only changes them while the engine is off. `beat` changes
// its level every 8 clocks of `pclk`, which shows that this clock runs.
//
// Latency 3 clocks of `pclk` from the last byte of a pixel to its token. No reset is needed, because the end of a frame restores the
// initial state.

`default_nettype none

module camera_capture (
    input  wire                        pclk,
    input  wire                        vsync,
    input  wire                        href,
    input  wire  [7:0]                 data,
    input  wire                        vsync_low,
    input  wire                        href_low,
    input  wire                        swap,
    input  wire                        falling,
    output logic                       beat,
    output logic                       token_valid,
    input  wire                        token_ready,
    output gesture_pkg::token_t        token
);
    logic own_vsync_low, own_href_low, own_swap, own_falling;
    cdc_level cross_vsync   (.clk(pclk), .level(vsync_low), .synced(own_vsync_low));
    cdc_level cross_href    (.clk(pclk), .level(href_low),  .synced(own_href_low));
    cdc_level cross_swap    (.clk(pclk), .level(swap),      .synced(own_swap));
    cdc_level cross_falling (.clk(pclk), .level(falling),   .synced(own_falling));

    typedef struct packed {
        logic       vsync;
        logic       href;
        logic [7:0] data;
    } sample_t;

    sample_t    risen, fallen, sample;
    logic       between, in_line, was_between, was_in_line, ends, half, lost;
    logic [7:0] first;
    logic [2:0] count;

    always_ff @(posedge pclk) risen  <= {vsync, href, data};
    always_ff @(negedge pclk) fallen <= {vsync, href, data};

    assign between = sample.vsync ^ own_vsync_low;
    assign in_line = (sample.href ^ own_href_low) && !between;

    always_ff @(posedge pclk) begin
        sample      <= own_falling ? fallen : risen;
        was_between <= between;
        was_in_line <= in_line;
        ends        <= between && !was_between;
        half        <= in_line && !half;
        if (!half) first <= sample.data;

        token_valid <= 1'b1;
        token.data  <= own_swap ? {sample.data, first} : {first, sample.data};
        if (ends) begin
            token.kind  <= gesture_pkg::TOKEN_FRAME;
        end else if (was_in_line && !in_line) begin
            token.kind  <= gesture_pkg::TOKEN_LINE;
            token.data  <= {14'd0, between, half};
        end else begin
            token.kind  <= gesture_pkg::TOKEN_PIXEL;
            token_valid <= in_line && half;
        end
        if (token_valid) lost <= !token_ready;

        count <= count + 1'b1;
        beat  <= beat ^ (count == '0);
    end

    assign token.lost = lost;
endmodule

`default_nettype wire

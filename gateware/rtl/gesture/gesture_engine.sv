// The gesture engine: finds a hand by its colour in the frames of an image sensor. The results of each whole frame are the number, the sums
// of coordinates and the bounding box of the pixels in the hand's colour. Software computes the hand's centre from these results, and
// filters the centre (docs/gesture.md; docs/formats/gesture.md, "Gestures").
//
//    pclk                              clk
//   pins ─▶ camera_capture ─▶ cdc_fifo ─▶ item ─▶ colour_window ─▶ frame_check ─┬▶ run_filter ─▶ mask_sums ─▶ results
//                                                                              └▶ snapshot
//
// The pipeline in `clk` never stalls: only valid bits travel with the pixels. After each line the FIFO pauses for 15 clocks, in which
// run_filter ends the line's last run, and after each frame for 15 clocks, in which the results of this frame and the settings for the next
// frame are latched. Throughput one pixel per clock outside of the pauses; 9 clocks from the FIFO to the sums.
//
// The sensor's clock may stop at any time: `status.running` is low when this clock has had no edge for 2^TIMEOUT_BITS periods of `clk`. The
// pins of the camera's control bus only pass through this module for synchronisation to `clk`.

`default_nettype none

module gesture_engine #(
    parameter bit          MOMENTS       = 1'b0,
    parameter int unsigned CLOCK_DIVIDER = 4,   // periods of `clk` in a period of the sensor's input clock: even
    parameter int unsigned TIMEOUT_BITS  = 12
) (
    input  wire                                         clk,
    input  wire                                         rst,
    input  wire  gesture_registers_pkg::pins_t          pins,     // polarities and order of bytes
    input  wire                                         enable,
    input  wire  gesture_registers_pkg::frame_settings_t settings, // sampled at the start of each frame
    input  wire  gesture_registers_pkg::snapshot_t      snapshot_request,
    output gesture_registers_pkg::status_t              status,
    output logic                                        latched,  // high for one clock when `results` are new
    output logic [15:0]                                 sequence_number,
    output gesture_registers_pkg::results_t             results,
    output gesture_registers_pkg::snapshot_state_t      snapshot_state,
    output gesture_registers_pkg::events_t              events,
    // The image sensor.
    input  wire                                         camera_pclk,
    input  wire                                         camera_vsync,
    input  wire                                         camera_href,
    input  wire  [7:0]                                  camera_data,
    input  wire                                         camera_scl,
    input  wire                                         camera_sda,
    input  wire                                         clock_on,
    output logic                                        camera_xclk
);
    // ---- Capture ------------------------------------------------------------------------------------------------

    logic                beat, seen_beat, last_beat;
    logic                sent_valid, sent_ready, token_valid, token_ready;
    gesture_pkg::token_t sent, token;

    camera_capture camera_capture (
        .pclk(camera_pclk), .vsync(camera_vsync), .href(camera_href), .data(camera_data),
        .vsync_low(pins.vsync_low), .href_low(pins.href_low), .swap(pins.swap), .falling(pins.falling),
        .beat, .token_valid(sent_valid), .token_ready(sent_ready), .token(sent)
    );

    cdc_fifo #(.WIDTH($bits(token)), .DEPTH(32)) crossing (
        .in_clk(camera_pclk), .in_valid(sent_valid), .in_ready(sent_ready), .in_data(sent),
        .out_clk(clk), .out_valid(token_valid), .out_ready(token_ready), .out_data(token)
    );

    cdc_level cross_beat  (.clk, .level(beat),         .synced(seen_beat));
    cdc_level cross_vsync (.clk, .level(camera_vsync), .synced(status.vsync));
    cdc_level cross_href  (.clk, .level(camera_href),  .synced(status.href));
    cdc_level cross_scl   (.clk, .level(camera_scl),   .synced(status.scl));
    cdc_level cross_sda   (.clk, .level(camera_sda),   .synced(status.sda));

    // ---- Monitor of the sensor's clock, and its input clock -------------------------------------------------------

    localparam int unsigned HALF       = CLOCK_DIVIDER / 2;
    localparam int unsigned PHASE_BITS = HALF > 1 ? $clog2(HALF) : 1;

    logic [TIMEOUT_BITS:0] quiet;
    logic [PHASE_BITS-1:0] phase;

    assign status.running = !quiet[TIMEOUT_BITS];

    always_ff @(posedge clk) begin
        last_beat <= seen_beat;
        quiet     <= quiet + (TIMEOUT_BITS + 1)'(status.running);
        if (seen_beat != last_beat) quiet <= '0;
        if (rst) quiet <= {1'b1, {TIMEOUT_BITS{1'b0}}};

        phase <= phase + 1'b1;
        if (phase == PHASE_BITS'(HALF - 1)) begin
            phase       <= '0;
            camera_xclk <= clock_on && !camera_xclk;
        end
        if (rst) phase <= '0;
    end

    // ---- Items of the pipeline ------------------------------------------------------------------------------------

    logic [3:0]         pause;
    logic               takes, after_line;
    logic [15:0]        pixel;
    gesture_pkg::item_t item;

    assign token_ready = pause == '0;
    assign takes       = token_valid && token_ready;

    always_ff @(posedge clk) begin
        pixel      <= token.data;
        item.pixel <= takes && token.kind == gesture_pkg::TOKEN_PIXEL;
        item.line  <= takes && token.kind == gesture_pkg::TOKEN_LINE;
        item.frame <= takes && token.kind == gesture_pkg::TOKEN_FRAME;
        item.lost  <= takes && token.lost;
        item.odd   <= token.data[0];
        item.cut   <= token.data[1];
        item.blank <= after_line && pause > 4'd1;
        item.next  <= after_line && pause == 4'd1;
        if (takes) begin
            after_line <= token.kind == gesture_pkg::TOKEN_LINE;
            pause      <= {4{token.kind != gesture_pkg::TOKEN_PIXEL}};
        end else begin
            pause      <= pause - 4'(pause != '0);
        end
    end

    // ---- Marks and positions --------------------------------------------------------------------------------------

    gesture_registers_pkg::frame_settings_t frame_settings;
    gesture_pkg::item_t                     judged, placed;
    logic                                   marked, placed_mark, inside_region, whole;
    logic [15:0]                            placed_pixel;
    logic [10:0]                            x, y;

    colour_window colour_window (
        .clk, .pixel, .window_a(frame_settings.window_a), .window_b(frame_settings.window_b), .marked
    );
    delay #(.WIDTH($bits(item)), .CLOCKS(5)) item_of_mark (.clk, .enable(1'b1), .in(item), .out(judged));
    delay #(.WIDTH(16), .CLOCKS(6)) pixel_of_mark (.clk, .enable(1'b1), .in(pixel), .out(placed_pixel));

    wide_register #(.WIDTH($bits(settings)), .LOADS(80)) settings_of_frame (
        .clk, .next(judged.frame), .in(settings), .out(frame_settings)
    );

    frame_check frame_check (
        .clk, .rst, .enable, .running(status.running), .settings(frame_settings), .item(judged),
        .out_item(placed), .x, .y, .inside_region, .whole,
        .waiting(status.waiting), .fault(status.fault), .pixels(status.pixels), .lines(status.lines), .events
    );

    always_ff @(posedge clk) placed_mark <= marked;

    // ---- Results --------------------------------------------------------------------------------------------------

    logic        kept;
    logic [10:0] kept_x, kept_y;

    run_filter run_filter (
        .clk, .reach(frame_settings.least_run - 4'(frame_settings.least_run != '0)), .item(placed),
        .marked(placed_mark && inside_region), .x, .y, .kept, .out_x(kept_x), .out_y(kept_y)
    );

    mask_sums #(.MOMENTS(MOMENTS)) mask_sums (
        .clk, .rst, .kept, .x(kept_x), .y(kept_y), .frame(placed.frame), .whole, .latched, .sequence_number, .results
    );

    snapshot snapshot (
        .clk, .rst, .request(snapshot_request), .pixel(placed.pixel), .marked(placed_mark), .colour(placed_pixel),
        .x(x[4:0]), .y(y[4:0]), .frame(placed.frame), .whole, .sequence_number, .state(snapshot_state)
    );

    wire _unused = &{1'b0, placed.line, placed.lost, placed.odd, placed.cut};
endmodule

`default_nettype wire

// Counts columns and lines, and checks each frame: a frame is whole if it has `height` lines of `width` pixels, without a fault
// (docs/formats/gesture.md, "Gestures").
//
// Outputs appear one clock after `item`. `x` and `y` are the position of the pixel; in the clocks after the end of a line, `x` continues to
// count. `inside_region` is high if this position is in the region. `whole` is valid while `out_item.frame` is high. The first frame begins
// at the first end of a frame after `enable` has risen. If the sensor's clock stops, the current frame is dropped, and a new frame begins
// at the next end of a frame. Throughput one item per clock.

`default_nettype none

module frame_check (
    input  wire                                          clk,
    input  wire                                          rst,
    input  wire                                          enable,
    input  wire                                          running,
    input  wire  gesture_registers_pkg::frame_settings_t settings,
    input  wire  gesture_pkg::item_t                     item,
    output gesture_pkg::item_t                           out_item,
    output logic [10:0]                                  x,
    output logic [10:0]                                  y,
    output logic                                         inside_region,
    output logic                                         whole,
    output logic                                         waiting,
    output logic [2:0]                                   fault, // of the last frame
    output logic [10:0]                                  pixels, // of the last line
    output logic [10:0]                                  lines, // of the last frame
    output gesture_registers_pkg::events_t               events
);
    logic [10:0] column, line;
    logic        active, malformed;
    logic [2:0]  found, line_fault, frame_fault;

    assign malformed = line_fault != gesture_registers_pkg::FAULT_NONE;
    assign waiting   = enable && !active;

    always_comb begin
        line_fault = gesture_registers_pkg::FAULT_NONE;
        if (column != settings.width) line_fault = gesture_registers_pkg::FAULT_PIXELS;
        if (item.odd)        line_fault = gesture_registers_pkg::FAULT_BYTE;
        if (item.cut)        line_fault = gesture_registers_pkg::FAULT_CUT;

        // Only the first fault of a frame is kept.
        frame_fault = found;
        if (found == gesture_registers_pkg::FAULT_NONE) begin
            if (item.lost)                            frame_fault = gesture_registers_pkg::FAULT_LOST;
            else if (item.line)                       frame_fault = line_fault;
            else if (item.frame && line != {1'b0, settings.height}) frame_fault = gesture_registers_pkg::FAULT_LINES;
        end
    end

    always_ff @(posedge clk) begin
        out_item <= item;
        x        <= column;
        y        <= line;
        inside_region <= settings.region_x.first <= column && column <= settings.region_x.last
                      && settings.region_y.first <= line   && line   <= settings.region_y.last;
        whole    <= active && running && enable && frame_fault == gesture_registers_pkg::FAULT_NONE;
        events   <= '0;

        // Both counts saturate.
        if (item.pixel || item.blank) column <= column + 11'(column != '1);
        if (item.next || item.frame)  column <= '0;
        if (item.next)                line   <= line + 11'(line != '1);
        if (item.frame)               line   <= '0;
        if (item.line)                pixels <= column;
        if (item.frame)               lines  <= line;

        found                  <= item.frame ? gesture_registers_pkg::FAULT_NONE : frame_fault;
        events.lines_malformed <= active && item.line && malformed;
        if (item.frame) begin
            active <= 1'b1;
            if (active) begin
                fault                 <= frame_fault;
                events.frames         <= frame_fault == gesture_registers_pkg::FAULT_NONE;
                events.frames_dropped <= frame_fault != gesture_registers_pkg::FAULT_NONE;
            end
        end
        if (!running) begin
            active        <= 1'b0;
            events.frames <= 1'b0;
            if (active) begin
                fault                 <= gesture_registers_pkg::FAULT_STOPPED;
                events.frames_dropped <= 1'b1;
            end
        end
        if (rst || !enable) begin
            active <= 1'b0;
            events <= '0;
        end
        if (rst) fault <= gesture_registers_pkg::FAULT_NONE;
    end

    wire _unused = &{1'b0, settings.window_a, settings.window_b, settings.least_run};
endmodule

`default_nettype wire

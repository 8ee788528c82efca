// Proof of `camera_capture` from any state of its registers, for any behaviour of the pins and of the FIFO at its output. The loss of a
// token that was not taken is reported by the next token, and no other loss is reported. After the first end of a frame that is at least
// four clocks after the start, no frame ends inside a line, and each line has at least one byte.

`default_nettype none

module camera_capture_proof (
    input wire       clk,
    input wire       vsync,
    input wire       href,
    input wire [7:0] data,
    input wire       vsync_low,
    input wire       href_low,
    input wire       swap,
    input wire       falling,
    input wire       ready
);
    logic                beat, valid;
    gesture_pkg::token_t token;
    // Whether a token has been offered, and whether the last token was not taken.
    logic                shown = 1'b0, missing = 1'b0;
    // Whether a frame has ended, and whether the last token was a pixel; clocks since the start, at most 4.
    logic                began = 1'b0, inside = 1'b0;
    logic [2:0]          age = '0;

    camera_capture dut (
        .pclk(clk), .vsync, .href, .data, .vsync_low, .href_low, .swap, .falling,
        .beat, .token_valid(valid), .token_ready(ready), .token
    );

    always_ff @(posedge clk) begin
        age <= age + 3'(!age[2]);
        if (valid) begin
            shown   <= 1'b1;
            missing <= !ready;
            began   <= began || age[2] && token.kind == gesture_pkg::TOKEN_FRAME;
            inside  <= token.kind == gesture_pkg::TOKEN_PIXEL;
        end

        if (valid && shown) reported: assert (token.lost == missing);
        if (valid && began) line_ends: assert (token.kind != gesture_pkg::TOKEN_FRAME || !inside);
        if (valid && began) known_kind: assert (token.kind != 2'd3);
        if (valid && began && token.kind == gesture_pkg::TOKEN_LINE) has_bytes: assert (inside || token.data[0]);

        cut: cover (valid && began && token.kind == gesture_pkg::TOKEN_LINE && token.data[1:0] == 2'd3);
        two_lost: cover (valid && began && ready && token.lost);
    end

    wire _unused = beat;
endmodule

`default_nettype wire

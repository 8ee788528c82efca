// Fetches one source line (a line of the frame in memory) into a slot of the line ring, which is a buffer of two lines.
//
// Memory side, the LiteDRAM native read port: commands by valid/ready (payload stable while valid and not ready), at most one word per
// clock; data arrives later, in order, and without back-pressure. The whole slot is free before the first command, so each word is stored
// in the clock in which it arrives.
//
// Requests: `request` is a level, which holds with `line` and `slot` until `done` is high for one clock. While `enable` is low, a request
// ends at once without reading memory. A request that is withdrawn early ends without `done`. Latency: 2 clocks from `request` to the first
// command, 1 clock from the last word to `done`.

`default_nettype none

module scanout_fetch #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned LINE_WORDS   = 160,
    parameter int unsigned Y_BITS       = 10,
    localparam int unsigned WORD_BITS   = $clog2(LINE_WORDS + 1)
) (
    input  wire                     clk,
    input  wire                     rst,
    // Frame parameters: `base` is the address of the first word, `shift` the log2 of the scale.
    input  wire                     enable,
    input  wire  [ADDRESS_BITS-1:0] base,
    input  wire  [1:0]              shift,
    // Request.
    input  wire                     request,
    input  wire  [Y_BITS-1:0]       line,
    input  wire                     slot,
    output logic                    done,
    output logic                    busy,
    // Memory.
    output logic                    cmd_valid,
    input  wire                     cmd_ready,
    output logic [ADDRESS_BITS-1:0] cmd_addr,
    input  wire                     rdata_valid,
    // Write port of the line ring.
    output logic                    store,
    output logic                    store_slot,
    output logic [WORD_BITS-1:0]    store_word
);
    localparam int unsigned OFFSET_BITS = Y_BITS + WORD_BITS;
    localparam logic [WORD_BITS-1:0] FULL_LINE = WORD_BITS'(LINE_WORDS);

    // Multiplies by LINE_WORDS as a sum of shifted terms (two terms for 160 words), because synthesis would use a DSP48 for `*`.
    function automatic logic [OFFSET_BITS-1:0] times_line_words(input logic [Y_BITS-1:0] factor);
        times_line_words = '0;
        for (int i = 0; i < WORD_BITS; i++)
            if (FULL_LINE[i]) times_line_words += OFFSET_BITS'(factor) << i;
    endfunction

    typedef enum logic [1:0] {IDLE, LOCATE, FETCH, DONE} state_t;
    state_t                 state;
    logic                   withdrawn;
    logic [OFFSET_BITS-1:0] offset;
    logic [WORD_BITS-1:0]   last, to_ask;

    assign busy  = state == LOCATE || state == FETCH;
    assign done  = state == DONE && !withdrawn;
    assign store = state == FETCH && rdata_valid;

    always_ff @(posedge clk) begin
        if (busy && !request) withdrawn <= 1'b1;

        case (state)
            IDLE: begin
                withdrawn  <= 1'b0;
                // The shift loses no bits, since LINE_WORDS is a multiple of the largest scale.
                offset     <= times_line_words(line) >> shift;
                last       <= (FULL_LINE >> shift) - 1'b1;
                store_slot <= slot;
                store_word <= '0;
                if (request) state <= enable ? LOCATE : DONE;
            end
            LOCATE: begin
                cmd_valid <= 1'b1;
                cmd_addr  <= base + ADDRESS_BITS'(offset);
                to_ask    <= last;
                state     <= FETCH;
            end
            FETCH: begin
                if (cmd_valid && cmd_ready) begin
                    cmd_valid <= to_ask != '0;
                    cmd_addr  <= cmd_addr + 1'b1;
                    to_ask    <= to_ask - 1'b1;
                end
                if (rdata_valid) begin
                    store_word <= store_word + 1'b1;
                    if (store_word == last) state <= DONE;
                end
            end
            DONE: state <= IDLE;
        endcase

        if (rst) begin
            state     <= IDLE;
            cmd_valid <= 1'b0;
        end
    end
endmodule

`default_nettype wire

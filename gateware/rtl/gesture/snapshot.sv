// Keeps a small picture of one whole frame in block RAM, on request: every 2^step-th pixel of every 2^step-th line, as a bit of the
// mask or as a colour.
//
// A word contains either 16 pixels of the mask, the first pixel in the highest bit, or one RGB565 colour. Pixels are stored in the order of
// the frame; pixels that exceed the memory's capacity are dropped. After `start` the next whole frame is kept, and then `ready` rises.
// `word` is the word at the read position, two clocks after the position was set (`set`) or incremented (`move`).

`default_nettype none

module snapshot #(
    parameter int unsigned PLACE_BITS = 11
) (
    input  wire                                      clk,
    input  wire                                      rst,
    input  wire  gesture_registers_pkg::snapshot_t   request,
    input  wire                                      pixel,
    input  wire                                      marked,
    input  wire  [15:0]                              colour,
    input  wire  [4:0]                               x,
    input  wire  [4:0]                               y,
    input  wire                                      frame,
    input  wire                                      whole,
    input  wire  [15:0]                              sequence_number,
    output gesture_registers_pkg::snapshot_state_t   state
);
    (* ram_style = "block" *) logic [15:0] memory [0:(1 << PLACE_BITS)-1];

    logic [PLACE_BITS-1:0] reading;
    logic                  wanted, keeping, taken, store;
    logic [3:0]            bits;
    logic [15:0]           word, next_word;
    logic [4:0]            between;

    // Mask of the bits of a column or line that must be 0 for a pixel of the small picture.
    always_comb
        for (int i = 0; i < 5; i++) between[i] = request.step > 3'(i);

    assign taken     = keeping && pixel && ((x | y) & between) == '0 && !state.words[PLACE_BITS];
    assign store     = taken && (request.colour || bits == '1);
    assign next_word = request.colour ? colour : {word[14:0], marked};

    always_ff @(posedge clk) begin
        if (taken) begin
            word <= next_word;
            bits <= bits + 1'b1;
        end
        if (store) memory[state.words[PLACE_BITS-1:0]] <= next_word;
        state.words <= state.words + (PLACE_BITS + 1)'(store);

        if (frame) begin
            if (keeping && whole) begin
                keeping     <= 1'b0;
                wanted      <= 1'b0;
                state.ready <= 1'b1;
                state.sequence_number <= sequence_number + 1'b1;
            end else if (wanted) begin
                keeping     <= 1'b1;
                bits        <= '0;
                state.words <= '0;
            end
        end
        if (request.start) begin
            wanted      <= 1'b1;
            keeping     <= 1'b0;
            state.ready <= 1'b0;
        end

        if (request.set) reading <= request.place;
        else             reading <= reading + PLACE_BITS'(request.move);
        state.word <= memory[reading];

        if (rst) begin
            wanted      <= 1'b0;
            keeping     <= 1'b0;
            state.ready <= 1'b0;
        end
    end

    wire _unused = word[15];
endmodule

`default_nettype wire

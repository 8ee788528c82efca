// Writes the results of the setup to memory: each descriptor once, the descriptor's number to the list of every band that the triangle
// touches, and the numbers of exceptions to a separate list.
//
// Layout in words of 16 bytes; entries are u32 (docs/formats/triangle.md, "Descriptors and band lists"):
//   descriptors   descriptor_base + 3·number           3 words each; with SMOOTH 3 more, with TEXTURE 2 more
//   lists         list_base                            16 words: the lengths of 64 lists
//                 list_base + 16 + (band << list_shift) + 128·band  the list of a band, 4 entries per word
//   exceptions    exception_base                       4 entries per word
//
// This module keeps up to three entries of each list until a fourth entry completes the word, so that whole words are written.
// Memory needs several clocks to switch between descriptors and a list, and writes of four entries make these switches rare.
//
// With LINES, `in_line` selects `in_piece` as the input: a piece of a line, which is in one band and replaces a
// triangle's descriptor (records_pkg::stored_piece_t). `in_line` must hold from `restart` until `done`.
//
// Throughput 6 clocks per descriptor, or 9 with SMOOTH, plus 2 for each band after the first. A descriptor is written to memory directly
// from the input stream, so it leaves the stream one clock after its last word. `in_ready` is a register.
//
//   clock  1      2, 3, 4       5          6                 7, 8 …
//          IDLE   WORD          LOOK       ENTRY             LOOK, ENTRY
//                 3 words out   in_ready   the first band    each further band
//
// `restart` (while idle) empties all lists, which takes 64 clocks; `finish` (a level, after the last input) writes the lengths
// and ends with `done`. Later inputs are appended to the lists until the next `restart`. Items that do not fit are dropped, and `full` is
// set: the frame is then incomplete.

`default_nettype none

module binner #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned COUNT_BITS   = 20,
    parameter bit          SMOOTH       = 1'b0,
    parameter bit          TEXTURE      = 1'b0,
    parameter bit          LINES        = 1'b0,
    localparam int unsigned PLANES_BITS = triangle_pkg::planes_bits(SMOOTH, TEXTURE)
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire                     restart,
    input  wire                     finish,
    output logic                    done,
    output logic                    idle,
    output logic                    full,
    // Size code of the picture.
    input  wire  [1:0]              size,
    input  wire  [ADDRESS_BITS-1:0] descriptor_base,
    input  wire  [COUNT_BITS-1:0]   descriptor_limit,
    input  wire  [ADDRESS_BITS-1:0] list_base,
    input  wire  [4:0]              list_shift,
    input  wire  [ADDRESS_BITS-1:0] exception_base,
    input  wire  [COUNT_BITS-1:0]   exception_limit,
    output logic [COUNT_BITS-1:0]   descriptors,
    output logic [COUNT_BITS-1:0]   exceptions,
    input  wire                     in_valid,
    output logic                    in_ready,
    input  wire  records_pkg::descriptor_t       in_descriptor,
    input  wire  [PLANES_BITS-1:0]  in_planes,
    input  wire                     in_line,
    input  wire  records_pkg::piece_t  in_piece,
    input  wire                     exception_valid,
    output logic                    exception_ready,
    input  wire  [31:0]             exception_number,
    // To a write_port.
    output logic                    write_valid,
    input  wire                     write_ready,
    output logic [ADDRESS_BITS-1:0] write_addr,
    output logic [127:0]            write_data,
    output logic [15:0]             write_strobe,
    // High when the word belongs to a descriptor, low when it belongs to a list.
    output logic                    write_descriptor
);
    localparam int unsigned BANDS       = 64;
    localparam int unsigned BAND_BITS   = $clog2(BANDS);
    localparam int unsigned DESCRIPTOR_WORDS = triangle_pkg::descriptor_words(SMOOTH, TEXTURE);
    localparam int unsigned WORD_BITS        = $clog2(DESCRIPTOR_WORDS);

    // Returns the byte strobe that writes only the entry in lane `lane` of a word.
    function automatic logic [15:0] entry_strobe(input logic [1:0] lane);
        entry_strobe = 16'hf << {lane, 2'b00};
    endfunction

    typedef enum logic [2:0] {CLEAR, IDLE, WORD, LOOK, ENTRY, LENGTHS, LENGTHS_WORD, DONE} state_t;
    state_t state;

    // For each list: whether it is full and its length; the first three entries of its incomplete last word, each in a memory of its own; and
    // its address. The addresses are computed incrementally while the lists are emptied.
    (* ram_style = "distributed" *) logic [COUNT_BITS:0]     lengths [0:BANDS-1];
    (* ram_style = "distributed" *) logic [ADDRESS_BITS-1:0] addresses [0:BANDS-1];
    logic [BAND_BITS-1:0]    band;
    logic [COUNT_BITS-1:0]   length, stored, room;
    logic [2:0][31:0]        list_end;
    logic [ADDRESS_BITS-1:0] list_word, next_address, address_step;
    logic                    store, word_ends, end_written;

    logic [128*DESCRIPTOR_WORDS-1:0] words;
    logic [WORD_BITS-1:0]    word;
    logic [9:0]              first_row;
    logic [ADDRESS_BITS-1:0] descriptor_word; // counted from `descriptor_base`
    logic                    free, list_full, descriptors_full, exceptions_full;

    if (SMOOTH && TEXTURE) begin : light_and_texture
        assign words = {95'd0, in_planes[480], in_planes[287:0], 15'd0, in_planes[481 +: triangle_pkg::TEXTURE_BITS], in_planes[479:288],
                        in_descriptor};
    end else if (TEXTURE) begin : texture
        assign words = {15'd0, in_planes, in_descriptor};
    end else if (SMOOTH) begin : light
        assign words = {95'd0, in_planes, in_descriptor};
    end else begin : flat
        assign words = in_descriptor;

        wire _unused = &{1'b0, in_planes};
    end

    assign first_row = LINES && in_line ? in_piece.row : in_descriptor.top;

    assign idle            = state == IDLE;
    assign done            = state == DONE;
    assign free            = !write_valid || write_ready;
    assign exception_ready = state == IDLE && !in_valid && !write_valid;

    assign word_ends = length[1:0] == 2'd3;
    assign store     = state == CLEAR || state == ENTRY && (free || !word_ends) && !list_full;
    assign stored    = state == CLEAR ? '0 : length + 1'b1;

    for (genvar i = 0; i < 3; i++) begin : ends
        (* ram_style = "distributed" *) logic [COUNT_BITS-1:0] entries [0:BANDS-1];

        always_ff @(posedge clk) if (store && length[1:0] == 2'(i)) entries[band] <= descriptors;

        always_ff @(posedge clk) list_end[i] <= 32'(entries[band]);
    end

    // Computes the band of a row in two clocks. `row_band` is the band of the descriptor's first row while `top_comes[2]` is high, and of
    // its last row from the first LOOK clock on. In the smallest picture, which has few bands, comparisons determine the band.
    // In all other pictures a band has 3·2^n rows (glint_soc/constants.py), so one division by 3 suffices. For v of 8 bits, floor(v/3)
    // equals floor(v·171/512). As 171 = 2·5·17 + 1, the product takes three additions.
    localparam int unsigned SMALL_ROWS   = band_pkg::lines(2'd0);
    localparam int unsigned SMALL_BANDS  = picture_pkg::HEIGHT / SMALL_ROWS;
    localparam int unsigned SMALL_BITS   = $clog2(SMALL_BANDS);
    localparam int unsigned MEDIUM_SHIFT = $clog2(band_pkg::lines(2'd1) / 3);
    localparam int unsigned LARGE_SHIFT  = $clog2(band_pkg::lines(2'd2) / 3);

    logic [9:0]           row;
    logic [7:0]           parts, parts_1;
    logic [10:0]          by_5;
    logic [14:0]          by_85;
    logic [15:0]          by_171;
    logic [2:0]           top_comes;
    logic [SMALL_BITS-1:0] small_bands, small_band;
    logic [BAND_BITS-1:0] row_band;

    assign parts  = size == 2'd1 ? 8'(row >> MEDIUM_SHIFT) : 8'(row >> LARGE_SHIFT);
    assign by_5   = 11'(parts) + {1'b0, parts, 2'b0};
    assign by_171 = 16'(parts_1) + {by_85, 1'b0};

    always_comb begin
        small_bands = '0;
        for (int unsigned i = 1; i < SMALL_BANDS; i++) small_bands = small_bands + SMALL_BITS'(row >= 10'(i * SMALL_ROWS));
    end

    always_ff @(posedge clk) begin
        if (state == IDLE) row <= first_row;
        if (state == WORD && !(LINES && in_line)) row <= in_descriptor.bottom - 1'b1;
        top_comes  <= {top_comes[1], top_comes[0] && !descriptors_full, state == IDLE && in_valid && !in_ready};
        parts_1    <= parts;
        by_85      <= 15'(by_5) + {by_5, 4'b0};
        small_band <= small_bands;
        row_band   <= size == 2'd0 ? BAND_BITS'(small_band) : by_171[9 +: BAND_BITS];
    end

    // The length and the entries of the list of `band` are read from the memories one clock after `band` is set. `room` is the number of
    // entries of a full list, a power of two.
    always_ff @(posedge clk) begin
        if (store) lengths[band] <= {(stored & room) != '0, stored};
        if (state == CLEAR) addresses[band] <= next_address;
        {list_full, length} <= lengths[band];
        list_word <= addresses[band];

        room         <= COUNT_BITS'(4) << list_shift;
        address_step <= (ADDRESS_BITS'(1) << list_shift) + ADDRESS_BITS'(list_pkg::BANK_WORDS);
        next_address <= (restart ? list_base : next_address) + (restart ? ADDRESS_BITS'(list_pkg::TABLE_WORDS) : address_step);

        descriptors_full <= descriptors == descriptor_limit;
        exceptions_full  <= exceptions == exception_limit;
    end

    // The next word: a word of a descriptor or of a piece, the last entries of a list, or one entry in all lanes, of which the strobe
    // selects one. The selections are encoded in a tree of multiplexers, because synthesis needs more LUTs for other conditions and for
    // `case`.
    logic [127:0] next_data, ends_word, descriptor_or_ends;
    logic [31:0]  entry;
    logic         takes_list;

    assign takes_list = state == ENTRY || length[1:0] != '0 && !end_written;
    assign entry      = state == IDLE ? exception_number : 32'(length);
    assign ends_word  = {32'(descriptors), list_end};

    if (DESCRIPTOR_WORDS > 3) begin : more_words
        assign descriptor_or_ends = state == WORD ? words[128 * word +: 128] : ends_word;
    end else begin : three_words
        logic [1:0] selection;

        assign selection          = state == WORD ? word : '1;
        assign descriptor_or_ends = selection[1] ? selection[0] ? ends_word : words[256 +: 128]
                                                 : selection[0] ? words[128 +: 128] : words[0 +: 128];
    end

    if (LINES) begin : lines
        logic [$bits(in_piece)-1:0] piece;
        logic [1:0]                 selection;

        assign piece = in_piece;

        always_comb begin
            if (state == WORD) selection = in_line ? {1'b0, word[1]} : 2'd3;
            else               selection = state != IDLE && takes_list ? 2'd3 : 2'd2;
        end

        // The low half of the second word of a piece is not used.
        assign next_data = selection[1] ? selection[0] ? descriptor_or_ends : {4{entry}}
                         : selection[0] ? {in_piece.colour, records_pkg::PIECE_MARK, 8'd0, piece[165:128], piece[63:0]} : piece[127:0];

        wire _unused = &{1'b0, piece};
    end else begin : triangles_alone
        assign next_data = state == IDLE || state != WORD && !takes_list ? {4{entry}} : descriptor_or_ends;

        wire _unused = &{1'b0, in_line, in_piece};
    end

    // The address of the next word, with one adder for all kinds of words.
    logic [ADDRESS_BITS-1:0] base, offset;

    always_comb begin
        case (state)
            WORD:    {base, offset} = {descriptor_base, descriptor_word};
            IDLE:    {base, offset} = {exception_base, ADDRESS_BITS'(exceptions >> 2)};
            default: {base, offset} = takes_list ? {list_word, ADDRESS_BITS'(length >> 2)} : {list_base, ADDRESS_BITS'(band >> 2)};
        endcase
    end

    // Address and data are loaded in every clock in which the output register is free, with or without a new word, so that their enables
    // have short paths. In LOOK the address is not loaded, so address and data have separate enables.
    always_ff @(posedge clk) begin
        if (free) write_data <= next_data;
        if (free && state != LOOK) write_addr <= base + offset;
    end

    always_ff @(posedge clk) begin
        if (write_ready) write_valid <= 1'b0;
        in_ready <= 1'b0;

        case (state)
            CLEAR: begin
                band <= band + 1'b1;
                if (band == '1) state <= IDLE;
            end
            IDLE: begin
                word <= '0;
                if (in_valid) begin
                    if (!in_ready) state <= WORD;
                end else if (exception_valid) begin
                    if (!write_valid) begin
                        exceptions   <= exceptions + COUNT_BITS'(!exceptions_full);
                        full         <= full || exceptions_full;
                        write_valid  <= !exceptions_full;
                        write_strobe <= entry_strobe(exceptions[1:0]);
                        write_descriptor <= 1'b0;
                    end
                end else if (finish) begin
                    band  <= '0;
                    state <= LENGTHS;
                end
            end
            WORD: if (descriptors_full) begin
                full     <= 1'b1;
                in_ready <= 1'b1;
                state    <= IDLE;
            end else if (free) begin
                write_valid     <= 1'b1;
                write_strobe    <= '1;
                write_descriptor <= 1'b1;
                descriptor_word <= descriptor_word + 1'b1;
                word            <= word + 1'b1;
                if (word == WORD_BITS'(DESCRIPTOR_WORDS - 1)) begin
                    in_ready <= 1'b1;
                    state    <= LOOK;
                end
            end
            // Waits one clock to read the length and the last entries of the next list.
            LOOK: state <= ENTRY;
            ENTRY: if (free || !word_ends) begin
                if (word_ends) begin
                    write_valid  <= !list_full;
                    write_strobe <= '1;
                    write_descriptor <= 1'b0;
                end
                full         <= full || list_full;
                band         <= band + 1'b1;
                state        <= LOOK;
                if (band == row_band) begin
                    descriptors <= descriptors + 1'b1;
                    state       <= IDLE;
                end
            end
            LENGTHS: begin
                end_written <= 1'b0;
                state       <= LENGTHS_WORD;
            end
            LENGTHS_WORD: if (free && length[1:0] != '0 && !end_written) begin
                write_valid  <= 1'b1;
                write_strobe <= '1;
                write_descriptor <= 1'b0;
                end_written  <= 1'b1;
            end else if (free) begin
                write_valid  <= 1'b1;
                write_strobe <= entry_strobe(band[1:0]);
                write_descriptor <= 1'b0;
                band         <= band + 1'b1;
                state        <= band == '1 ? DONE : LENGTHS;
            end
            default: if (!finish) state <= IDLE;
        endcase
        if (top_comes[2]) band <= row_band;

        if (rst || restart) begin
            state           <= CLEAR;
            band            <= '0;
            descriptors     <= '0;
            exceptions      <= '0;
            descriptor_word <= '0;
            full            <= 1'b0;
            write_valid     <= 1'b0;
            in_ready        <= 1'b0;
        end
    end

    wire _unused = &{1'b0, by_171[15], by_171[8:0]};
endmodule

`default_nettype wire

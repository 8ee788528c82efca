// Reads the header and the palette, which precede the texels of a texture in memory (docs/formats/texture.md), and outputs the addresses of
// the mip levels.
//
//   start ─▶ entry of the table ─▶ second and first word of the header ─▶ levels, the last first ─▶ palette, from its end ─▶ done
//
// The entries of the table of textures are the byte addresses of the headers, 32 bits each. All addresses are computed in one register,
// `address`: the field `length` leads from the header to the end of the texture; from there `address` decreases by the size of each level,
// which grows by shifts, and then through the palette.
//
// `start` and `done` are high for one clock each; the next start must follow `done`. `number` and `table_base` must hold from `start` to
// `done`. `sampler` holds until the next start. Time: two latencies of memory and 22 clocks, and for a palette one more latency and one
// clock per colour. Memory may contain any values: sides and numbers of levels are limited to the valid range, and any other invalid value
// counts as a valid value. Memory: a client of read_port.

`default_nettype none

module texture_loader #(
    parameter int unsigned ADDRESS_BITS = 23
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire                     start,
    input  wire  [7:0]              number,
    input  wire  [ADDRESS_BITS-1:0] table_base,
    output logic                    done,
    // Memory.
    output logic                    ask_valid,
    input  wire                     ask_ready,
    output logic [ADDRESS_BITS-1:0] ask_addr,
    input  wire                     data_valid,
    output logic                    data_ready,
    input  wire  [127:0]            data,
    output texture_pkg::sampler_t   sampler,
    // Address of the first word of a level.
    output logic                    level_write,
    output logic [3:0]              level_number,
    output logic [ADDRESS_BITS-1:0] level_first,
    output logic                    palette_write,
    output logic [7:0]              palette_index,
    output logic [15:0]             palette_colour
);
    // The largest side is 2^10, so levels have numbers up to 10.
    localparam logic [3:0] LAST_LEVEL = 4'd10;
    // A word has 2^4 bytes.
    localparam int unsigned BYTE_BITS = 4;
    // The largest level, 1024×1024 colours, has 2^17 words.
    localparam int unsigned SIZE_BITS = 18;
    // Index of the header's field `length` in its word, in units of 32 bits: the multiplexer for entries of the table also selects this
    // field.
    localparam logic [1:0] LENGTH_ENTRY = 2'd1;

    typedef enum logic [3:0] {
        IDLE, OFFSET, ASK_ENTRY, ENTRY, SECOND, ASK_SECOND, ASK_FIRST, TAKE_SECOND, TAKE_FIRST, LEVELS, PALETTE, LAST
    } state_t;

    state_t state;

    // The word that was read, in place of both words of the header; the state determines which of them it is.
    records_pkg::texture_header_t header;

    assign header = {data, data};

    // Returns a value of at most 10 unchanged; a larger value becomes 8, 9 or 10.
    function automatic logic [3:0] limited(input logic [3:0] value);
        limited = {value[3], value[2] && !value[3], value[1], value[0] && !(value[3] && value[1])};
    endfunction

    // Returns 0, 1 and 2 unchanged, and 2 for 3.
    function automatic logic [1:0] one_of_three(input logic [1:0] value);
        one_of_three = {value[1], value[0] && !value[1]};
    endfunction

    logic [ADDRESS_BITS-1:0] address;
    // Step of the address in words: the size of a level, 1, or the high bits of the texture's number.
    logic [SIZE_BITS-1:0]    size;
    // Number of levels, or of words of the palette to request, that follow the current one.
    logic [4:0]              count;
    // Index of the next colour of the palette.
    logic [7:0]              index;
    logic                    asks_more, is_level, asks, takes_colour;
    logic [1:0]              grows;
    // Base-2 logarithm of the smallest side of a texture whose level `count` - 1 is larger than a block of 4 texels.
    logic [3:0]              least;
    logic [3:0][31:0]        entries;
    logic [31:0]             entry;

    assign entries        = data;
    assign entry          = entries[state == PALETTE ? index[2:1] : state == TAKE_FIRST ? LENGTH_ENTRY : number[1:0]];
    assign ask_addr       = address;
    assign level_first    = address;
    assign palette_index  = index;
    assign palette_colour = index[0] ? entry[31:16] : entry[15:0];
    assign takes_colour   = state == PALETTE && data_valid;
    assign palette_write  = takes_colour;
    assign done           = state == LAST;
    assign is_level       = state == LEVELS && count[3:0] <= sampler.last_level;
    assign asks           = state == PALETTE && asks_more && (!ask_valid || ask_ready);

    always_comb begin
        unique case (state)
            ENTRY, TAKE_SECOND, TAKE_FIRST: data_ready = 1'b1;
            PALETTE:                        data_ready = index[2:0] == '0;
            default:                        data_ready = 1'b0;
        endcase
        // Whether the next larger level has twice as many blocks across, and down; the sides of blocks have 4 or 8 texels.
        least    = count[3:0] + 4'd2;
        grows[0] = {least, 1'b0} < {sampler.side_log2[0], sampler.format == 2'd0};
        grows[1] = {least, 1'b0} < {sampler.side_log2[1], sampler.format != 2'd2};
    end

    // The address is 0 before the base or an entry of the table is added. The bit below the address adds the 1 of a subtraction. `keep`
    // preserves these control signals, so that each bit of `address` and `size` takes one LUT.
    (* keep *) logic         back, adds_other, doubles, quadruples;
    logic                    clears, steps, unused_carry;
    logic [ADDRESS_BITS-1:0] change;

    always_comb begin
        clears     = rst || state == LAST || state == ASK_ENTRY && ask_ready;
        adds_other = state == IDLE || state == ENTRY || state == TAKE_FIRST;
        back       = state == IDLE || state == ASK_SECOND || state == LEVELS || state == PALETTE;
        doubles    = state == LEVELS && grows[0] != grows[1] || state == TAKE_FIRST && data_valid;
        quadruples = state == LEVELS && grows == 2'b11;
        unique case (state)
            IDLE:              steps = start;
            OFFSET, SECOND:    steps = 1'b1;
            ENTRY, TAKE_FIRST: steps = data_valid;
            ASK_SECOND:        steps = ask_ready;
            LEVELS:            steps = is_level;
            PALETTE:           steps = asks;
            default:           steps = 1'b0;
        endcase
        // With `adds_other`, `back` selects the base instead of an entry.
        unique case ({adds_other, back})
            2'b00: change = ADDRESS_BITS'(size);
            2'b01: change = ADDRESS_BITS'(size) ^ {ADDRESS_BITS{1'b1}};
            2'b10: change = entry[BYTE_BITS +: ADDRESS_BITS];
            2'b11: change = table_base;
        endcase
    end

    always_ff @(posedge clk) begin
        if (clears) address <= '0;
        else if (steps) {address, unused_carry} <= {address, 1'b1} + {change, back && !adds_other};

        if (state == IDLE) size <= SIZE_BITS'(number[7:2]);
        else if (state == ENTRY || state == LEVELS && count == '0) size <= SIZE_BITS'(1);
        else size <= doubles ? size << 1 : quadruples ? size << 2 : size;
    end

    always_ff @(posedge clk) begin
        if (state == TAKE_SECOND) begin
            sampler.wrap     <= {one_of_three(header.wrap[1][1:0]), one_of_three(header.wrap[0][1:0])};
            sampler.bilinear <= header.filter[0];
            sampler.cut_out  <= header.cut_out[0];
            sampler.key      <= header.key;
            sampler.blend    <= header.blend[3:0];
        end
        if (state == TAKE_FIRST) begin
            sampler.format     <= one_of_three(header.format[1:0]);
            sampler.side_log2  <= {limited(header.height_log2[3:0]), limited(header.width_log2[3:0])};
            sampler.last_level <= limited(header.levels[3:0] - 1'b1);
        end

        level_write  <= is_level;
        level_number <= count[3:0];

        if (state == LEVELS) begin
            index <= sampler.format == 2'd1 ? 8'd255 : 8'd15;
        end else if (takes_colour) begin
            index <= index - 1'b1;
        end
        if (state == TAKE_FIRST) count <= 5'(LAST_LEVEL);
        else if (state == LEVELS && count == '0) count <= sampler.format == 2'd1 ? 5'd31 : 5'd1;
        else if (state == LEVELS || asks) count <= count - 1'b1;
        asks_more <= state == LEVELS || asks_more && !(asks && count == '0);

        unique case (state)
            OFFSET, SECOND:       ask_valid <= 1'b1;
            ASK_ENTRY, ASK_FIRST: ask_valid <= !ask_ready;
            PALETTE:              ask_valid <= asks_more || ask_valid && !ask_ready;
            default:              ask_valid <= ask_valid;
        endcase

        case (state)
            IDLE:        if (start) state <= OFFSET;
            OFFSET:      state <= ASK_ENTRY;
            ASK_ENTRY:   if (ask_ready) state <= ENTRY;
            ENTRY:       if (data_valid) state <= SECOND;
            SECOND:      state <= ASK_SECOND;
            ASK_SECOND:  if (ask_ready) state <= ASK_FIRST;
            ASK_FIRST:   if (ask_ready) state <= TAKE_SECOND;
            TAKE_SECOND: if (data_valid) state <= TAKE_FIRST;
            TAKE_FIRST:  if (data_valid) state <= LEVELS;
            LEVELS:      if (count == '0) state <= sampler.format == 2'd0 ? LAST : PALETTE;
            PALETTE:     if (takes_colour && index == '0) state <= LAST;
            default:     state <= IDLE;
        endcase

        if (rst) begin
            state     <= IDLE;
            ask_valid <= 1'b0;
        end
    end

    wire _unused = &{1'b0, unused_carry, header.magic, header.length, header.checksum, header.reserved_184};
endmodule

`default_nettype wire

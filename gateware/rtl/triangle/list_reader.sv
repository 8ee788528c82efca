// Reads the descriptors of one band, in the order of its lists: those of the geometry unit first, then a second set that
// the firmware has made (clipped triangles), where there is one.
//
// Layout as binner writes it. Three clients of a read_port: the lengths of the lists, the lists, the descriptors. The
// lists and the descriptors are read ahead as far as read_port's FIFOs reach, so that memory's latency is paid once a
// band. Latency some memory accesses, throughput a descriptor in 3 clocks.
//
// `start` (one clock, not while `busy`) begins with band `band`; `busy` falls when the last descriptor has been taken.

`default_nettype none

module list_reader #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned COUNT_BITS   = 20
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       start,
    input  wire  [5:0]                band,
    // Set 0 is the geometry unit's, set 1 the firmware's.
    input  wire  [1:0]                present,
    input  wire  [2*ADDRESS_BITS-1:0] list_base,
    input  wire  [2*ADDRESS_BITS-1:0] descriptor_base,
    input  wire  [4:0]                list_shift,
    output logic                      busy,
    // Memory: the clients of the lengths, the lists, the descriptors.
    output logic [2:0]                ask_valid,
    input  wire  [2:0]                ask_ready,
    output logic [3*ADDRESS_BITS-1:0] ask_addr,
    input  wire  [2:0]                data_valid,
    output logic [2:0]                data_ready,
    input  wire  [3*128-1:0]          data,
    output logic                      out_valid,
    input  wire                       out_ready,
    output triangle_pkg::descriptor_t               out_descriptor
);
    localparam int unsigned TABLE_WORDS = 16;

    typedef enum logic [2:0] {IDLE, ASK, LENGTH, LOCATE, ENTRIES} state_t;
    state_t state;

    logic                    set;
    logic [ADDRESS_BITS-1:0] table_base, descriptors;
    logic [COUNT_BITS-1:0]   length;

    assign table_base  = set ? list_base[ADDRESS_BITS +: ADDRESS_BITS] : list_base[0 +: ADDRESS_BITS];
    assign descriptors = set ? descriptor_base[ADDRESS_BITS +: ADDRESS_BITS] : descriptor_base[0 +: ADDRESS_BITS];
    assign busy        = state != IDLE;

    // The length of the band's list.
    logic [COUNT_BITS-1:0] found;

    assign ask_valid[0] = state == ASK && present[set];
    assign ask_addr[0 +: ADDRESS_BITS] = table_base + ADDRESS_BITS'(band >> 2);
    assign data_ready[0] = state == LENGTH;
    assign found = data[32 * band[1:0] +: COUNT_BITS];

    // The list: words are asked for ahead, entries taken out of the word that is there.
    logic [COUNT_BITS-1:0]   words_to_ask, entries_left;
    logic [ADDRESS_BITS-1:0] list_word;
    logic [1:0]              lane;
    logic                    entry_valid, entry_ready, entry_taken;
    logic [ADDRESS_BITS-1:0] entry;

    assign ask_valid[1] = state == ENTRIES && words_to_ask != '0;
    assign ask_addr[ADDRESS_BITS +: ADDRESS_BITS] = list_word;
    assign entry        = data[128 + 32 * lane +: ADDRESS_BITS];
    assign entry_valid  = state == ENTRIES && entries_left != '0 && data_valid[1];
    assign entry_taken  = entry_valid && entry_ready;
    assign data_ready[1] = entry_taken && (lane == '1 || entries_left == COUNT_BITS'(1));

    // Descriptors: three addresses for an entry, three words for a descriptor.
    logic                    asking;
    logic [1:0]              word_to_ask, word;
    logic [ADDRESS_BITS-1:0] descriptor_word;
    logic [COUNT_BITS-1:0]   descriptors_left;
    logic [255:0]            gathered;
    logic                    gather;

    assign entry_ready   = !asking || word_to_ask == 2'd2 && ask_ready[2];
    assign ask_valid[2]  = asking;
    assign ask_addr[2*ADDRESS_BITS +: ADDRESS_BITS] = descriptor_word;
    assign gather        = word != 2'd3 && data_valid[2];
    assign data_ready[2] = word != 2'd3;
    assign out_valid     = word == 2'd3;

    always_ff @(posedge clk) begin
        if (asking && ask_ready[2]) begin
            word_to_ask     <= word_to_ask + 1'b1;
            descriptor_word <= descriptor_word + 1'b1;
            if (word_to_ask == 2'd2) asking <= 1'b0;
        end
        if (entry_taken) begin
            asking          <= 1'b1;
            word_to_ask     <= '0;
            descriptor_word <= descriptors + entry + (entry << 1);
            lane            <= lane + 1'b1;
            entries_left    <= entries_left - 1'b1;
        end
        if (ask_valid[1] && ask_ready[1]) begin
            words_to_ask <= words_to_ask - 1'b1;
            list_word    <= list_word + 1'b1;
        end
        if (gather) begin
            word <= word + 1'b1;
            case (word)
                2'd0:    gathered[127:0]   <= data[256 +: 128];
                2'd1:    gathered[255:128] <= data[256 +: 128];
                default: out_descriptor    <= {data[256 +: 128], gathered};
            endcase
        end
        if (out_valid && out_ready) begin
            word             <= '0;
            descriptors_left <= descriptors_left - 1'b1;
        end

        case (state)
            IDLE: begin
                set <= 1'b0;
                if (start) state <= ASK;
            end
            ASK: begin
                if (!present[set]) begin
                    set   <= 1'b1;
                    state <= set ? IDLE : ASK;
                end else if (ask_ready[0]) begin
                    state <= LENGTH;
                end
            end
            LENGTH: begin
                length <= found;
                if (data_valid[0]) state <= LOCATE;
            end
            LOCATE: begin
                list_word        <= table_base + ADDRESS_BITS'(TABLE_WORDS) + (ADDRESS_BITS'(band) << list_shift);
                words_to_ask     <= (length >> 2) + COUNT_BITS'(length[1:0] != '0);
                entries_left     <= length;
                descriptors_left <= length;
                lane             <= '0;
                state            <= ENTRIES;
            end
            default: if (descriptors_left == '0) begin
                set   <= 1'b1;
                state <= set ? IDLE : ASK;
            end
        endcase

        if (rst) begin
            state  <= IDLE;
            asking <= 1'b0;
            word   <= '0;
        end
    end
endmodule

`default_nettype wire

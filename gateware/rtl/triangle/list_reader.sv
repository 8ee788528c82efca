// Reads the descriptors (triangles after the setup) of a frame, band by band, in the order of the band lists: in each band first the set
// that the geometry unit has written, then an optional second set that the firmware has written (clipped triangles). The module `binner`
// describes the layout in memory.
//
//             words               entries   ┌──────────────────┐
//   lengths ─────────▶ lists ────────┬─────▶│ descriptor_cache │──▶ out
//                        └─▶ jobs ───┘      └──────────────────┘
//
// Each of the three parts reads ahead until its FIFO is full, even past the ends of lists and bands: the lengths of up to 16 bands, up to 8
// jobs (a job is the list of one band) or 128 entries, and up to 10 descriptors (5 with SMOOTH, 6 with TEXTURE). Reading ahead hides the
// latency of memory.
// Three clients of a read_port read the lengths of the lists, the lists, and the descriptors. Throughput as in descriptor_cache; a list
// takes at least 4 clocks.
//
// `list_error` is high if, since `start`, the length of a list exceeded the largest length (such a list is read as empty), or an entry was
// not below the number of descriptors in its set (`counts`). Only the low COUNT_BITS bits of an entry are used.
//
// `start` (one clock, not while a frame is read) begins reading a frame, from band 0. `forget` invalidates the descriptor_cache. An item of
// `out` is a descriptor, or with `out_end` the end of a band; the end of `last_band` is the last item. Stream
// protocol as in `fifo`.

`default_nettype none

module list_reader #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned COUNT_BITS   = 20,
    parameter bit          SMOOTH       = 1'b0,
    parameter bit          TEXTURE      = 1'b0,
    localparam int unsigned PLANES_BITS = triangle_pkg::planes_bits(SMOOTH, TEXTURE)
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       start,
    input  wire                       forget,
    input  wire  [5:0]                last_band,
    // Two sets of lists and descriptors: set 0 is written by the geometry unit, set 1 by the firmware. The low bits belong to
    // set 0.
    input  wire  [1:0]                present,
    input  wire  [2*ADDRESS_BITS-1:0] list_base,
    input  wire  [2*ADDRESS_BITS-1:0] descriptor_base,
    input  wire  [2*COUNT_BITS-1:0]   counts,
    input  wire  [4:0]                list_shift,
    output logic                      list_error,
    // Ports of three clients of a read_port: 0 for the lengths, 1 for the lists and 2 for the descriptors.
    output logic [2:0]                ask_valid,
    input  wire  [2:0]                ask_ready,
    output logic [3*ADDRESS_BITS-1:0] ask_addr,
    input  wire  [2:0]                data_valid,
    output logic [2:0]                data_ready,
    input  wire  [3*128-1:0]          data,
    output logic                      out_valid,
    input  wire                       out_ready,
    output logic                      out_end,
    output records_pkg::descriptor_t out_descriptor,
    output logic [PLANES_BITS-1:0]    out_planes
);
    localparam int unsigned JOBS = 8;

    logic [1:0][ADDRESS_BITS-1:0] lists;

    assign lists = list_base;

    // Requests the lengths of the lists, with one read for each list. A word of the table of lengths holds the lengths of four bands. The
    // word is read again for each of these bands, because the lists of the two sets alternate.
    logic       asks_lengths, length_set;
    logic [5:0] length_band;

    assign ask_valid[0] = asks_lengths && present[length_set];
    assign ask_addr[0 +: ADDRESS_BITS] = lists[length_set] + ADDRESS_BITS'(length_band >> 2);

    always_ff @(posedge clk) begin
        if (!asks_lengths) begin
            asks_lengths <= start;
            length_set   <= 1'b0;
            length_band  <= '0;
        end else if (!present[length_set] || ask_ready[0]) begin
            length_set <= !length_set;
            if (length_set) begin
                length_band <= length_band + 1'b1;
                if (length_band == last_band) asks_lengths <= 1'b0;
            end
        end
        if (rst) asks_lengths <= 1'b0;
    end

    // Requests the words of the lists. For each list a job is first sent to the next part. A job is the length of the list, or 0 if the
    // list is too long or its set is absent.
    typedef enum logic [2:0] {IDLE, LENGTH, CHECK, JOB, WORDS} list_state_t;
    list_state_t list_state;

    logic                    list_set, job_ready;
    logic [5:0]              list_band;
    logic [ADDRESS_BITS-1:0] list_offset, list_step, list_first, list_word;
    logic [COUNT_BITS-1:0]   length;
    logic [31:0]             found;
    logic [COUNT_BITS-3:0]   words_left;
    logic [33:0]             list_room;
    logic                    list_ends, too_long;

    assign ask_valid[1] = list_state == WORDS;
    assign ask_addr[ADDRESS_BITS +: ADDRESS_BITS] = list_word;
    assign data_ready[0] = list_state == LENGTH && present[list_set];
    assign too_long  = 34'(found) > list_room;
    assign list_ends = list_state == JOB && job_ready && length == '0
                    || list_state == WORDS && ask_ready[1] && words_left == '0;

    always_ff @(posedge clk) begin
        // Addresses and lengths that depend on parameters of the frame, or on `list_set` and `list_band`, are registered, because these
        // inputs hold for at least two clocks before their use.
        list_room  <= 34'd4 << list_shift;
        list_step  <= (ADDRESS_BITS'(1) << list_shift) + ADDRESS_BITS'(list_pkg::BANK_WORDS);
        list_first <= lists[list_set] + list_offset;

        case (list_state)
            IDLE: begin
                list_set    <= 1'b0;
                list_band   <= '0;
                list_offset <= ADDRESS_BITS'(list_pkg::TABLE_WORDS);
                if (start) list_state <= LENGTH;
            end
            LENGTH: begin
                found <= present[list_set] ? data[32 * list_band[1:0] +: 32] : '0;
                if (!present[list_set] || data_valid[0]) list_state <= CHECK;
            end
            CHECK: begin
                length     <= too_long ? '0 : found[COUNT_BITS-1:0];
                list_state <= JOB;
            end
            JOB: begin
                list_word  <= list_first;
                words_left <= length[COUNT_BITS-1:2] - (COUNT_BITS - 2)'(length[1:0] == '0);
                if (job_ready) list_state <= WORDS;
            end
            default: if (ask_ready[1]) begin
                list_word  <= list_word + 1'b1;
                words_left <= words_left - 1'b1;
            end
        endcase
        if (list_ends) begin
            list_set   <= !list_set;
            list_state <= list_set && list_band == last_band ? IDLE : LENGTH;
            if (list_set) begin
                list_band   <= list_band + 1'b1;
                list_offset <= list_offset + list_step;
            end
        end
        if (rst) list_state <= IDLE;
    end

    logic                  next_valid, next_ready;
    logic [COUNT_BITS-1:0] next_length;

    fifo #(.WIDTH(COUNT_BITS), .DEPTH(JOBS)) jobs (
        .clk, .rst, .in_valid(list_state == JOB), .in_ready(job_ready), .in_data(length),
        .out_valid(next_valid), .out_ready(next_ready), .out_data(next_length)
    );

    // Extracts the entries from the words of each list, one per clock. After the lists of both sets, an item for the end of the band
    // follows.
    logic                    job_valid, set, left, last_entry, entry_taken, end_taken;
    logic                    item_valid, item_ready, item_free, item_end, item_set;
    logic [COUNT_BITS-1:0]   entries_after;
    logic [1:0]              lane;
    logic [31:0]             number;

    assign next_ready    = !job_valid;
    assign last_entry    = entries_after == '0;
    assign item_free     = !item_valid || item_ready;
    assign entry_taken   = job_valid && left && data_valid[1] && item_free;
    assign end_taken     = job_valid && !left && item_free;
    assign data_ready[1] = job_valid && left && item_free && (lane == '1 || last_entry);

    always_ff @(posedge clk) begin
        if (next_ready) begin
            job_valid     <= next_valid;
            left          <= next_length != '0;
            entries_after <= next_length - 1'b1;
            lane          <= '0;
        end
        if (entry_taken) begin
            lane          <= lane + 1'b1;
            entries_after <= entries_after - 1'b1;
            left          <= !last_entry;
        end
        if (end_taken) begin
            job_valid <= 1'b0;
            set       <= !set;
        end
        if (item_free) begin
            item_valid <= entry_taken || end_taken && set;
            item_end   <= !left;
            item_set   <= set;
            number     <= data[128 + 32 * lane +: 32];
        end
        if (rst) begin
            job_valid  <= 1'b0;
            set        <= 1'b0;
            item_valid <= 1'b0;
        end
    end

    logic [1:0][COUNT_BITS-1:0] limits;
    logic                       beyond;

    assign limits = counts;

    always_ff @(posedge clk) begin
        beyond <= item_valid && !item_end && number >= 32'(limits[item_set]);
        if (beyond || list_state == CHECK && too_long) list_error <= 1'b1;
        if (rst || start) list_error <= 1'b0;
    end

    descriptor_cache #(.ADDRESS_BITS(ADDRESS_BITS), .COUNT_BITS(COUNT_BITS), .SMOOTH(SMOOTH), .TEXTURE(TEXTURE)) descriptors (
        .clk, .rst, .forget, .base(descriptor_base),
        .in_valid(item_valid), .in_ready(item_ready), .in_end(item_end), .in_set(item_set), .in_number(number[COUNT_BITS-1:0]),
        .ask_valid(ask_valid[2]), .ask_ready(ask_ready[2]), .ask_addr(ask_addr[2*ADDRESS_BITS +: ADDRESS_BITS]),
        .data_valid(data_valid[2]), .data_ready(data_ready[2]), .data(data[256 +: 128]),
        .out_valid, .out_ready, .out_end, .out_descriptor, .out_planes
    );
endmodule

`default_nettype wire

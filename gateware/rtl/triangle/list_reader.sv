// Reads the descriptors of a frame, band by band, in the order of their lists: in each band those of the geometry unit first,
// then a second set that the firmware has made (clipped triangles), where there is one. Layout as binner writes it.
//
//             words               entries              addresses            words
//   lengths ─────────▶ lists ────────┬──────▶ triangles ────────▶ memory ─────────▶ out
//                        └─▶ jobs ───┘            └────────────▶ marks ──────────────┘
//
// Each part runs ahead of the one behind it as far as its FIFO reaches, through the ends of lists and bands: lengths of 16 bands,
// lists of 8 jobs (a list of a band each) or 128 entries, 10 descriptors (5 with SMOOTH). So memory's latency is hidden while what has been
// read lasts. Three clients of a read_port: the lengths of the lists, the lists, the descriptors. Throughput a descriptor in
// 4 clocks, with SMOOTH in 7; a list takes 4 clocks, if it is empty too.
//
// `list_error`: since `start` there was a list longer than lists may be, which was taken as empty, or an entry that is none of
// the set's `counts` descriptors, which was read from where it would be.
//
// `start` (one clock, not while a frame is read) begins with band 0. An item of `out` is a descriptor, or with `out_end` the end
// of a band. All is read after the end of `last_band`. Streams: an item moves in a clock in which valid and ready are high;
// valid does not wait for ready, and a payload stays as it is until it has moved.

`default_nettype none

module list_reader #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned COUNT_BITS   = 20,
    parameter bit          SMOOTH       = 1'b0,
    localparam int unsigned PLANES_BITS = SMOOTH ? 289 : 1
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       start,
    input  wire  [5:0]                last_band,
    // Set 0 is the geometry unit's, set 1 the firmware's.
    input  wire  [1:0]                present,
    input  wire  [2*ADDRESS_BITS-1:0] list_base,
    input  wire  [2*ADDRESS_BITS-1:0] descriptor_base,
    input  wire  [2*COUNT_BITS-1:0]   counts,
    input  wire  [4:0]                list_shift,
    output logic                      list_error,
    // Memory: the clients of the lengths, the lists, the descriptors.
    output logic [2:0]                ask_valid,
    input  wire  [2:0]                ask_ready,
    output logic [3*ADDRESS_BITS-1:0] ask_addr,
    input  wire  [2:0]                data_valid,
    output logic [2:0]                data_ready,
    input  wire  [3*128-1:0]          data,
    output logic                      out_valid,
    input  wire                       out_ready,
    output logic                      out_end,
    output triangle_pkg::descriptor_t out_descriptor,
    output logic [PLANES_BITS-1:0]    out_planes
);
    localparam int unsigned JOBS        = 8;
    localparam int unsigned MARKS       = 16;
    localparam int unsigned DESCRIPTOR_WORDS = 3 << SMOOTH;
    localparam int unsigned WORD_BITS        = $clog2(DESCRIPTOR_WORDS + 1);

    logic [1:0][ADDRESS_BITS-1:0] lists, descriptors;

    assign lists       = list_base;
    assign descriptors = descriptor_base;

    // Lengths: a word for each list, since a word of the table has those of four bands, and the sets take turns.
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

    // Lists: a job is the length of a list, 0 where there is none; its words follow in time.
    typedef enum logic [2:0] {IDLE, LENGTH, CHECK, JOB, WORDS} list_state_t;
    list_state_t list_state;

    logic                    list_set, job_ready;
    logic [5:0]              list_band;
    logic [ADDRESS_BITS-1:0] list_offset, list_word;
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
        list_room <= 34'd4 << list_shift;

        case (list_state)
            IDLE: begin
                list_set    <= 1'b0;
                list_band   <= '0;
                list_offset <= '0;
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
                list_word  <= lists[list_set] + list_offset + ADDRESS_BITS'(list_pkg::TABLE_WORDS);
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
                list_offset <= list_offset + (ADDRESS_BITS'(1) << list_shift) + ADDRESS_BITS'(list_pkg::SKEW_WORDS);
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

    // Triangles: entries are taken out of the words of the list; after both lists of a band comes its end. Each leaves a mark.
    logic                    job_valid, set, left, last_entry, mark_valid, mark_ready, entry_taken, end_taken;
    logic                    number_valid, number_ready, number_taken, number_set;
    logic [COUNT_BITS-1:0]   entries_after;
    logic [1:0]              lane;
    logic [31:0]             number;

    assign next_ready    = !job_valid;
    assign last_entry    = entries_after == '0;
    assign entry_taken   = job_valid && left && data_valid[1] && number_ready && mark_ready;
    assign end_taken     = job_valid && !left && (!set || mark_ready);
    assign mark_valid    = job_valid && (left ? data_valid[1] && number_ready : set);
    assign data_ready[1] = job_valid && left && number_ready && mark_ready && (lane == '1 || last_entry);

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
        if (number_ready) begin
            number_valid <= entry_taken;
            number       <= data[128 + 32 * lane +: 32];
            number_set   <= set;
        end else if (number_taken) begin
            number_valid <= 1'b0;
        end
        if (rst) begin
            job_valid    <= 1'b0;
            set          <= 1'b0;
            number_valid <= 1'b0;
        end
    end

    logic [1:0][COUNT_BITS-1:0] limits;
    logic                       beyond;

    assign limits = counts;

    always_ff @(posedge clk) begin
        beyond <= number_valid && number >= 32'(limits[number_set]);
        if (beyond || list_state == CHECK && too_long) list_error <= 1'b1;
        if (rst || start) list_error <= 1'b0;
    end

    // The addresses of a triangle's words.
    logic                    asks_words, last_address;
    logic [WORD_BITS-1:0]    address;
    logic [ADDRESS_BITS-1:0] descriptor_word;

    assign last_address = address == WORD_BITS'(DESCRIPTOR_WORDS - 1) && ask_ready[2];
    assign number_taken = !asks_words || last_address;
    assign number_ready = !number_valid;
    assign ask_valid[2] = asks_words;
    assign ask_addr[2*ADDRESS_BITS +: ADDRESS_BITS] = descriptor_word;

    always_ff @(posedge clk) begin
        if (number_taken) begin
            asks_words      <= number_valid;
            address         <= '0;
            descriptor_word <= descriptors[number_set] + ((ADDRESS_BITS'(number) + (ADDRESS_BITS'(number) << 1)) << SMOOTH);
        end else if (ask_ready[2]) begin
            address         <= address + 1'b1;
            descriptor_word <= descriptor_word + 1'b1;
        end
        if (rst) asks_words <= 1'b0;
    end

    // The words of a descriptor.
    logic                 marked, mark_is_end;
    logic [WORD_BITS-1:0] words;
    logic [128*DESCRIPTOR_WORDS-1:0] descriptor;

    fifo #(.WIDTH(1), .DEPTH(MARKS)) marks (
        .clk, .rst, .in_valid(mark_valid), .in_ready(mark_ready), .in_data(!left),
        .out_valid(marked), .out_ready(out_valid && out_ready), .out_data(mark_is_end)
    );

    assign data_ready[2]  = words != WORD_BITS'(DESCRIPTOR_WORDS);
    assign out_valid      = marked && (mark_is_end || words == WORD_BITS'(DESCRIPTOR_WORDS));
    assign out_end        = mark_is_end;
    assign out_descriptor = descriptor[383:0];

    if (SMOOTH) begin : light
        assign out_planes = descriptor[384 +: PLANES_BITS];

        wire _unused = &{1'b0, descriptor[767:673]};
    end else begin : flat
        assign out_planes = '0;
    end

    always_ff @(posedge clk) begin
        if (data_ready[2] && data_valid[2]) begin
            words      <= words + 1'b1;
            descriptor <= {data[256 +: 128], descriptor[128*DESCRIPTOR_WORDS-1:128]};
        end
        if (out_valid && out_ready && !mark_is_end) words <= '0;
        if (rst) words <= '0;
    end
endmodule

`default_nettype wire

// Starts the passes of the triangle engine after a check of their parameters, and reports their results.
//
//   ask ──▶ pending ──▶ regions, one per clock ──▶ start ──▶ busy ──▶ done ──▶ ended, error
//                                     └── refused ───────────────────────────────▲
//
// The parameters of a pass contain regions of memory. A region is described by its length and by the byte address of its first 16-byte
// word, in the CPU's 32-bit address space. A region that is not aligned or not within memory (2^MEMORY_BITS words from BASE on) ends the
// pass with ERROR_ADDRESS before its first access to memory. A build without TRIANGLES ends a geometry pass without `lines` with
// ERROR_TRIANGLES, and with neither TRIANGLES nor LINES each geometry pass, and a raster pass with `first` or `second`. A build without LINES
// ends a geometry pass with `lines` with ERROR_LINES. A build with TRIANGLES but without GEOMETRY ends each geometry pass with
// ERROR_GEOMETRY.
//
// A pass is requested by one clock of `ask`. `ended` (one clock) reports for each request that its pass is refused, done or cancelled;
// `error` then holds until the next request of this pass.
//
// A pass is `active` from its request until its error is valid. A second request during this time does not stop the pass; the error at its
// end is then ERROR_BUSY, unless the pass ends with another error.
//
// A request waits while the parameters of its pass are `loading`, from the next clock on. `kept` holds the flags of a pass from
// its request on; all other parameters must hold from the end of `loading` until `ended`.
//
// `cancel` (one clock, at any time) ends both passes, even a pass that is requested in the same clock. Later requests wait until the
// engine is `ready`. Latency 15 clocks from `ask`, or from the end of `loading`, to `start`.

`default_nettype none

module triangle_control #(
    parameter  logic [31:0] BASE         = 32'h4000_0000,
    parameter  bit          TRIANGLES    = 1'b1,
    parameter  bit          SMOOTH       = 1'b0,
    parameter  bit          TEXTURE      = 1'b0,
    parameter  bit          LINES        = 1'b0,
    parameter  bit          GEOMETRY     = TRIANGLES || LINES,
    parameter  bit          AVERAGE      = 1'b0,
    parameter  int unsigned MEMORY_BITS  = triangle_registers_pkg::ADDRESS_BITS,
    parameter  int unsigned SIZES        = 7, // picture sizes of this build: bit k for the size of code k
    localparam int unsigned COUNT_BITS   = triangle_registers_pkg::COUNT_BITS
) (
    input  wire                    clk,
    input  wire                    rst,
    input  wire                    cancel,
    // Geometry.
    input  wire                    geometry_ask,
    input  wire triangle_registers_pkg::geometry_flags_t geometry_flags,
    input  wire                    geometry_loading,
    input  wire triangle_registers_pkg::geometry_t geometry,
    output triangle_registers_pkg::geometry_flags_t geometry_kept,
    output logic                   geometry_active,
    output logic                   geometry_ended,
    output logic [3:0]             geometry_error,
    // Raster.
    input  wire                    raster_ask,
    input  wire triangle_registers_pkg::raster_flags_t raster_flags,
    input  wire                    raster_loading,
    input  wire triangle_registers_pkg::raster_t raster,
    output triangle_registers_pkg::raster_flags_t raster_kept,
    output logic                   raster_active,
    output logic                   raster_ended,
    output logic [3:0]             raster_error,
    // Engine.
    input  wire triangle_registers_pkg::status_t engine,
    output logic                   recovering,
    output logic                   geometry_start,
    output logic                   raster_start
);
    localparam logic [3:0] ERROR_NONE = triangle_registers_pkg::ERROR_NONE, ERROR_SIZE = triangle_registers_pkg::ERROR_SIZE,
                           ERROR_ADDRESS = triangle_registers_pkg::ERROR_ADDRESS, ERROR_BUSY = triangle_registers_pkg::ERROR_BUSY,
                           ERROR_MESH = triangle_registers_pkg::ERROR_MESH, ERROR_FULL = triangle_registers_pkg::ERROR_FULL,
                           ERROR_LIST = triangle_registers_pkg::ERROR_LIST,
                           ERROR_CANCELLED = triangle_registers_pkg::ERROR_CANCELLED,
                           ERROR_TRIANGLES = triangle_registers_pkg::ERROR_TRIANGLES,
                           ERROR_LINES = triangle_registers_pkg::ERROR_LINES,
                           ERROR_GEOMETRY = triangle_registers_pkg::ERROR_GEOMETRY;

    // Number of bits of a region's length in words; a length may exceed the size of memory.
    localparam int unsigned WORD_BITS  = triangle_registers_pkg::ADDRESS_BITS + 2;
    // Largest valid `list_shift`, the log2 of the words of a list: longer lists would exceed the counter of entries.
    localparam logic [4:0]  LAST_SHIFT = 5'(COUNT_BITS - 3);

    typedef enum logic [2:0] {IDLE, CHECK, SETTLE, JUDGE, START} state_t;
    state_t state;

    localparam logic [3:0] FIRST_GEOMETRY = 4'd0, LAST_GEOMETRY = 4'd3, FIRST_RASTER = 4'd4, LAST_RASTER = 4'd9;

    logic       geometry_pending, raster_pending, check_geometry, rastering;
    logic [3:0] region;
    logic [1:0] size;
    logic [5:0] bands;

    assign geometry_active = geometry_pending || geometry_start || engine.geometry_busy || engine.geometry_done;
    assign raster_active   = raster_pending || raster_start || engine.raster_busy || engine.raster_done;

    assign check_geometry = geometry_pending && !geometry_loading;

    assign size = rastering ? raster_kept.size : geometry_kept.size;

    // Code 3 is not a valid size in any build. The picture of the samples of a frame may have twice the width and height of the largest frame.
    localparam logic [3:0] SUPPORTED = {1'b0, 3'(AVERAGE ? SIZES | SIZES << 1 : SIZES)};

    assign bands = band_pkg::bands(size);

    // The error with which the pass is refused, or ERROR_NONE.
    logic       misplaced, has_lists, has_triangles;
    logic [3:0] refusal;

    assign has_lists     = !rastering || raster_kept.first || raster_kept.second;
    assign has_triangles = LINES ? !rastering && !geometry_kept.lines : has_lists;

    always_comb begin
        if (!TRIANGLES && has_triangles)                      refusal = ERROR_TRIANGLES;
        else if (!LINES && !rastering && geometry_kept.lines) refusal = ERROR_LINES;
        else if (!GEOMETRY && !rastering)                     refusal = ERROR_GEOMETRY;
        else if (!SUPPORTED[size])                            refusal = ERROR_SIZE;
        else if (misplaced)                                   refusal = ERROR_ADDRESS;
        else                                                  refusal = ERROR_NONE;
    end

    // First address and length (in words) of the region that is checked, and the candidates for its length.
    logic [31:0]          first;
    logic [WORD_BITS-1:0] words, mesh_words, list_words, frame_words, descriptor_words;
    logic [COUNT_BITS-1:0] count;
    logic [4:0]           list_shift;
    logic                 used;

    assign list_shift  = rastering ? raster.list_shift : geometry.list_shift;
    assign mesh_words  = geometry.mesh_bytes[31:WORD_BITS+4] != '0 ? '1 : WORD_BITS'(geometry.mesh_bytes >> 4);
    assign list_words  = list_shift > LAST_SHIFT ? '1 : WORD_BITS'(list_pkg::TABLE_WORDS)
                      + (WORD_BITS'(bands) << list_shift) + WORD_BITS'(bands * list_pkg::BANK_WORDS);
    assign frame_words = (WORD_BITS'(picture_pkg::FRAME_WORDS) << {size, 1'b0})
                       >> (AVERAGE && raster_kept.average && !raster_kept.quarter ? 2 : 0);

    always_comb begin
        used = 1'b1;
        case (region)
            4'd1:    count = geometry.descriptor_limit;
            4'd3:    count = geometry.exception_limit;
            4'd8:    count = raster.count[0];
            default: count = raster.count[1];
        endcase
        case (triangle_pkg::descriptor_words(SMOOTH, TEXTURE))
            5:       descriptor_words = WORD_BITS'(count) + (WORD_BITS'(count) << 2);
            8:       descriptor_words = WORD_BITS'(count) << 3;
            default: descriptor_words = (WORD_BITS'(count) + (WORD_BITS'(count) << 1)) << SMOOTH;
        endcase
        case (region)
            4'd0:    begin first = geometry.mesh;          words = mesh_words; end
            4'd1:    begin first = geometry.descriptors;   words = descriptor_words; end
            4'd2:    begin first = geometry.lists;         words = list_words; end
            4'd3:    begin first = geometry.exceptions;    words = (WORD_BITS'(count) + WORD_BITS'(3)) >> 2; end
            4'd4:    begin first = raster.frame;           words = frame_words; end
            4'd5:    begin first = raster.depth;           words = frame_words << 1; used = raster_kept.depth; end
            4'd6:    begin first = raster.lists[0];        words = list_words; used = raster_kept.first; end
            4'd7:    begin first = raster.lists[1];        words = list_words; used = raster_kept.second; end
            4'd8:    begin first = raster.descriptors[0];  words = descriptor_words; used = raster_kept.first; end
            default: begin first = raster.descriptors[1];  words = descriptor_words; used = raster_kept.second; end
        endcase
        // A build for fields alone checks only the regions of frame and depth, and needs no logic for other regions.
        if (!TRIANGLES && !LINES) begin
            first = region[0] ? raster.depth : raster.frame;
            words = region[0] ? frame_words << 1 : frame_words;
            used  = region == 4'd4 || region == 4'd5 && raster_kept.depth;
        end
    end

    // The check of a region takes two clocks: one selects the region, the next one computes its end.
    logic                 looked, was_used;
    logic [31:0]          was_first;
    logic [WORD_BITS-1:0] was_words;
    logic [WORD_BITS:0]   past;

    assign past = {{(WORD_BITS + 1 - MEMORY_BITS){1'b0}}, was_first[4 +: MEMORY_BITS]} + {1'b0, was_words};

    always_ff @(posedge clk) begin
        looked    <= state == CHECK;
        was_used  <= used;
        was_first <= first;
        was_words <= words;

        if (looked && was_used && (was_first[3:0] != '0 || was_first[31:4+MEMORY_BITS] != BASE[31:4+MEMORY_BITS]
                                   || past > (WORD_BITS+1)'(1) << MEMORY_BITS))
            misplaced <= 1'b1;
        if (state == IDLE) misplaced <= 1'b0;
    end

    always_ff @(posedge clk) begin
        geometry_start <= 1'b0;
        raster_start   <= 1'b0;
        geometry_ended <= 1'b0;
        raster_ended   <= 1'b0;

        if (engine.ready) recovering <= 1'b0;

        // A request for a pass that is pending or busy is refused, and the earlier request continues.
        if (geometry_ask) begin
            if (geometry_active) begin
                geometry_error <= ERROR_BUSY;
            end else begin
                geometry_pending <= 1'b1;
                geometry_kept    <= geometry_flags;
                geometry_error   <= ERROR_NONE;
            end
        end
        if (raster_ask) begin
            if (raster_active) begin
                raster_error <= ERROR_BUSY;
            end else begin
                raster_pending <= 1'b1;
                raster_kept    <= raster_flags;
                raster_error   <= ERROR_NONE;
            end
        end

        case (state)
            IDLE: begin
                rastering <= !check_geometry;
                region    <= check_geometry ? FIRST_GEOMETRY : FIRST_RASTER;
                if (check_geometry || raster_pending && !raster_loading) state <= CHECK;
            end
            CHECK: begin
                region <= region + 1'b1;
                if (region == (rastering ? LAST_RASTER : LAST_GEOMETRY)) state <= SETTLE;
            end
            // Waits until the end address of the last region is checked.
            SETTLE: state <= JUDGE;
            JUDGE: begin
                if (refusal != ERROR_NONE) begin
                    if (rastering) begin
                        {raster_pending, raster_ended} <= 2'b01;
                        raster_error <= refusal;
                    end else begin
                        {geometry_pending, geometry_ended} <= 2'b01;
                        geometry_error <= refusal;
                    end
                    state <= IDLE;
                end else begin
                    state <= START;
                end
            end
            default: if (!recovering) begin
                if (rastering) {raster_pending, raster_start}     <= 2'b01;
                else           {geometry_pending, geometry_start} <= 2'b01;
                state <= IDLE;
            end
        endcase

        if (engine.geometry_done) begin
            geometry_ended <= 1'b1;
            if (engine.mesh_error) geometry_error <= ERROR_MESH;
            else if (engine.full)  geometry_error <= ERROR_FULL;
        end
        if (engine.raster_done) begin
            raster_ended <= 1'b1;
            if (engine.list_error) raster_error <= ERROR_LIST;
        end

        if (cancel) begin
            if (geometry_active || geometry_ask) begin
                geometry_ended <= 1'b1;
                geometry_error <= ERROR_CANCELLED;
            end
            if (raster_active || raster_ask) begin
                raster_ended <= 1'b1;
                raster_error <= ERROR_CANCELLED;
            end
        end
        if (rst || cancel) begin
            state            <= IDLE;
            geometry_pending <= 1'b0;
            raster_pending   <= 1'b0;
            geometry_start   <= 1'b0;
            raster_start     <= 1'b0;
            recovering       <= 1'b1;
        end
        if (rst) begin
            geometry_ended <= 1'b0;
            raster_ended   <= 1'b0;
            geometry_error <= ERROR_NONE;
            raster_error   <= ERROR_NONE;
        end
    end

    wire _unused = &{1'b0, geometry, raster};
endmodule

`default_nettype wire

// Scan-out: shows an RGB565 frame in memory as video (by default 1280x720), enlarged 4, 2 or 1 times by repeating pixels and
// lines.
//
//            sys_clk                                             pix_clk
//   memory ─▶ scanout_fetch ─▶ line ring, 2 slots of 160 words ─▶ pixel ─▶ 565 to 888 ─▶ video
//                  ▲                                                ▲
//                  └──────────── one source line at a time ◀── scanout_lines ◀── scanout_timing
//
// Once a frame, when the vertical blanking begins, the sys side latches `frame_base`, `scale` and `enable`, counts the frame
// and pulses `vblank`. The pix side requests line 0 only after this, so all lines of a picture belong to one frame in memory.
// The video timing never stalls: a late line is replaced by the previous line, and counted as an underflow.
//
// Throughput: one pixel per pix_clk, at most one memory word per sys_clk. Latency: 4 pix_clk from scanout_timing to the video
// outputs; a source line (a line of the frame in memory) is requested one to `scale` output lines before its first use. Clock
// domain crossings: three four-phase requests with stable payload (cdc_request), one level, and the line ring, whose slots are
// written and read at different times under the control of scanout_lines.

`default_nettype none

module scanout #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned H_ACTIVE     = 1280, // a multiple of 32
    parameter int unsigned H_FRONT      = 110,  // at least the latency
    parameter int unsigned H_SYNC       = 40,
    parameter int unsigned H_BACK       = 220,
    parameter int unsigned V_ACTIVE     = 720,  // a multiple of 4
    parameter int unsigned V_FRONT      = 5,
    parameter int unsigned V_SYNC       = 5,
    parameter int unsigned V_BACK       = 20,
    parameter int unsigned V_BORDER     = 0     // visible black lines at the inner ends of V_BACK and V_FRONT
) (
    input  wire                     sys_clk,
    input  wire                     sys_rst,
    input  wire                     pix_clk,
    input  wire                     pix_rst,
    // Settings requested by software, latched at vblank. `frame_base` is an address in words of 16 bytes; `scale` is 4, 2 or 1.
    input  wire                     enable,
    input  wire  [2:0]              scale,
    input  wire  [ADDRESS_BITS-1:0] frame_base,
    // Settings in use.
    output logic                    enabled,
    output logic [2:0]              scale_current,
    output logic [ADDRESS_BITS-1:0] frame_current,
    output logic                    fetching,
    output logic [1:0]              error,      // of the last frame: 0 none, 1 invalid scale, 2 underflow
    output logic                    vblank,     // high for one clock per frame
    // Free-running counters.
    output logic [31:0]             frames,
    output logic [31:0]             underflows,
    // Events, one clock late: memory refused a command, a word of a line has arrived, a source line is complete.
    output logic                    stalled,
    output logic                    word_came,
    output logic                    line_ended,
    // Memory: LiteDRAM native read port, 128 bits.
    output logic                    cmd_valid,
    input  wire                     cmd_ready,
    output logic [ADDRESS_BITS-1:0] cmd_addr,
    input  wire                     rdata_valid,
    input  wire  [127:0]            rdata,
    // Video, in pix_clk.
    output logic                    video_hsync,
    output logic                    video_vsync,
    output logic                    video_de,
    output logic [7:0]              video_r,
    output logic [7:0]              video_g,
    output logic [7:0]              video_b
);
    localparam int unsigned LINE_WORDS = H_ACTIVE / 8;
    localparam int unsigned WORD_BITS  = $clog2(LINE_WORDS + 1);
    localparam int unsigned X_BITS     = $clog2(H_ACTIVE + H_FRONT + H_SYNC + H_BACK);
    localparam int unsigned Y_BITS     = $clog2(V_ACTIVE + V_FRONT + V_SYNC + V_BACK);

    // ---- Crossings ----------------------------------------------------------------------------------------------

    /* verilator lint_off PINCONNECTEMPTY */ // No request uses both `src_busy` and `src_finished`.
    logic pix_vblank, pix_frame_begun, sys_vblank;
    cdc_request cross_vblank (
        .src_clk(pix_clk), .src_rst(pix_rst), .src_start(pix_vblank), .src_busy(), .src_finished(pix_frame_begun),
        .dst_clk(sys_clk), .dst_rst(sys_rst), .dst_request(sys_vblank), .dst_done(sys_vblank)
    );

    logic pix_fetch, pix_fetch_busy, sys_fetch, sys_fetch_done;
    cdc_request cross_fetch (
        .src_clk(pix_clk), .src_rst(pix_rst), .src_start(pix_fetch), .src_busy(pix_fetch_busy), .src_finished(),
        .dst_clk(sys_clk), .dst_rst(sys_rst), .dst_request(sys_fetch), .dst_done(sys_fetch_done)
    );

    logic pix_underflow, sys_underflow;
    cdc_request cross_underflow (
        .src_clk(pix_clk), .src_rst(pix_rst), .src_start(pix_underflow), .src_busy(), .src_finished(),
        .dst_clk(sys_clk), .dst_rst(sys_rst), .dst_request(sys_underflow), .dst_done(sys_underflow)
    );

    /* verilator lint_on PINCONNECTEMPTY */

    // `enabled` crosses to pix_clk as a level, so that a reset of the sys side blanks the screen at once.
    logic pix_enabled;
    cdc_level cross_enabled (.clk(pix_clk), .level(enabled), .synced(pix_enabled));

    // ---- Frame parameters and counters, clocked by sys_clk ------------------------------------------------------

    logic [1:0] shift, shift_asked;
    logic       scale_known, underflow_seen;

    always_comb begin
        scale_known = 1'b1;
        shift_asked = 2'd0;
        case (scale)
            3'd1:    shift_asked = 2'd0;
            3'd2:    shift_asked = 2'd1;
            3'd4:    shift_asked = 2'd2;
            default: scale_known = 1'b0;
        endcase
    end

    assign vblank        = sys_vblank;
    assign scale_current = 3'd1 << shift;

    always_ff @(posedge sys_clk) begin
        if (sys_vblank) begin
            enabled        <= enable;
            frame_current  <= frame_base;
            if (scale_known) shift <= shift_asked;
            error          <= !scale_known ? 2'd1 : underflow_seen ? 2'd2 : 2'd0;
            underflow_seen <= 1'b0;
        end
        if (sys_underflow) underflow_seen <= 1'b1;

        // Events are registers, because memory's signals end long paths in LiteDRAM.
        stalled    <= cmd_valid && !cmd_ready;
        word_came  <= store;
        line_ended <= sys_fetch_done && enabled;

        frames     <= frames     + 32'(sys_vblank);
        underflows <= underflows + 32'(sys_underflow);

        if (sys_rst) begin
            enabled        <= 1'b0;
            frame_current  <= '0;
            shift          <= 2'd2;
            error          <= 2'd0;
            underflow_seen <= 1'b0;
            stalled        <= 1'b0;
            word_came      <= 1'b0;
            line_ended     <= 1'b0;
            frames         <= '0;
            underflows     <= '0;
        end
    end

    // ---- Fetch of source lines from memory, clocked by sys_clk --------------------------------------------------

    logic                 store, store_slot;
    logic [WORD_BITS-1:0] store_word;
    logic [Y_BITS-1:0]    pix_fetch_line;
    logic                 pix_fetch_slot;

    scanout_fetch #(.ADDRESS_BITS(ADDRESS_BITS), .LINE_WORDS(LINE_WORDS), .Y_BITS(Y_BITS)) fetch (
        .clk(sys_clk), .rst(sys_rst),
        .enable(enabled), .base(frame_current), .shift,
        .request(sys_fetch), .line(pix_fetch_line), .slot(pix_fetch_slot), .done(sys_fetch_done), .busy(fetching),
        .cmd_valid, .cmd_ready, .cmd_addr, .rdata_valid,
        .store, .store_slot, .store_word
    );

    // ---- Line ring, two buffers of one source line: written in sys_clk, read in pix_clk -------------------------

    logic [127:0]         ring [0:2*(1 << WORD_BITS)-1];
    logic [127:0]         ring_word;
    logic [WORD_BITS:0]   ring_address;

    always_ff @(posedge sys_clk) if (store) ring[{store_slot, store_word}] <= rdata;
    always_ff @(posedge pix_clk) ring_word <= ring[ring_address];

    // ---- Video timing and control of the line ring, clocked by pix_clk ------------------------------------------

    logic [X_BITS-1:0] x;
    logic              active, hsync, vsync, tick;
    logic [Y_BITS-1:0] tick_line;

    scanout_timing #(
        .H_ACTIVE(H_ACTIVE), .H_FRONT(H_FRONT), .H_SYNC(H_SYNC), .H_BACK(H_BACK),
        .V_ACTIVE(V_ACTIVE), .V_FRONT(V_FRONT), .V_SYNC(V_SYNC), .V_BACK(V_BACK), .V_BORDER(V_BORDER)
    ) timing (.clk(pix_clk), .rst(pix_rst), .x, .active, .hsync, .vsync, .tick, .tick_line);

    logic [1:0] pix_shift;
    logic       shown, shown_slot;

    always_ff @(posedge pix_clk) if (pix_frame_begun) pix_shift <= shift;

    scanout_lines #(.V_ACTIVE(V_ACTIVE), .Y_BITS(Y_BITS)) lines (
        .clk(pix_clk), .rst(pix_rst), .enabled(pix_enabled), .shift(pix_shift),
        .tick, .tick_line,
        .vblank(pix_vblank), .frame_begun(pix_frame_begun),
        .fetch(pix_fetch), .fetch_line(pix_fetch_line), .fetch_slot(pix_fetch_slot), .fetch_busy(pix_fetch_busy),
        .shown, .shown_slot, .underflow(pix_underflow)
    );

    // ---- Pixel pipeline, clocked by pix_clk: address, read of the ring, selection of the pixel ------------------

    logic [X_BITS-1:0] source_x;
    logic [2:0]        lane_1, lane_2;
    logic [1:0]        lane_3;
    // The half of the word that holds the pixel. Block RAM is slow, so only one multiplexer level precedes this register.
    logic [63:0]       half_word;
    logic [2:0]        sync_1, sync_2, sync_3; // hsync, vsync, active
    logic [15:0]       pixel;

    assign source_x = x >> pix_shift;
    assign pixel    = half_word[16*lane_3 +: 16];

    always_ff @(posedge pix_clk) begin
        ring_address <= {shown_slot, source_x[3 +: WORD_BITS]};
        lane_1       <= source_x[2:0];
        sync_1       <= {hsync, vsync, active};
        lane_2       <= lane_1;
        sync_2       <= sync_1;
        lane_3       <= lane_2[1:0];
        half_word    <= ring_word[64*lane_2[2] +: 64];
        sync_3       <= sync_2;

        {video_hsync, video_vsync, video_de} <= sync_3;
        // Repeats the top bits of a channel as its lowest bits, so that 31 and 63 become 255.
        video_r <= {pixel[15:11], pixel[15:13]};
        video_g <= {pixel[10:5],  pixel[10:9]};
        video_b <= {pixel[4:0],   pixel[4:2]};
        if (!sync_3[0] || !shown || !pix_enabled) {video_r, video_g, video_b} <= '0;

        if (pix_rst) begin
            sync_1 <= '0;
            sync_2 <= '0;
            sync_3 <= '0;
            {video_hsync, video_vsync, video_de} <= '0;
        end
    end
endmodule

`default_nettype wire

// Control of the line ring, which has two slots of one source line (a line of the frame in memory) each: decides which slot is shown, and
// which source line is fetched into the other, hidden slot.
//
// This module decides once per output line, at the tick (the leading edge of hsync, when the line's last pixel has left):
//
//   1. if the hidden slot holds the source line that the next output line needs, the slots are exchanged;
//   2. otherwise, if the next output line is the first one that needs this source line, an underflow occurs: the shown slot is shown again,
//      or black if no slot has been shown in this frame. Later output lines of the same source line check the slot again;
//   3. if the hidden slot is free, the source line after the needed source line is requested, even after an underflow. During the vertical
//      blanking, line 0 is requested at the first tick after the parameters of the next frame are latched (`frame_begun`).
//
// A slot is written only while it is hidden, and a frame only shows lines requested after its vblank, so the screen never mixes frames. A
// slow fetch delays later fetches, but never the video timing. `fetch_line` and `fetch_slot` are stable from `fetch` until `fetch_busy`
// falls.

`default_nettype none

module scanout_lines #(
    parameter int unsigned V_ACTIVE = 720, // a multiple of 4
    parameter int unsigned Y_BITS   = 10
) (
    input  wire               clk,
    input  wire               rst,
    input  wire               enabled,
    input  wire  [1:0]        shift,
    // Raster.
    input  wire               tick,
    input  wire  [Y_BITS-1:0] tick_line,
    // `vblank`: vertical blanking has begun. `frame_begun`: the parameters of the next frame are latched.
    output logic              vblank,
    input  wire               frame_begun,
    // Fetches.
    output logic              fetch,
    output logic [Y_BITS-1:0] fetch_line,
    output logic              fetch_slot,
    input  wire               fetch_busy,
    // Picture.
    output logic              shown,
    output logic              shown_slot,
    output logic              underflow
);
    // `needed` is the source line that the next output line shows, `next` the source line after it. `group_mask` selects the
    // bits of `tick_line` that number the output lines of one source line.
    logic [Y_BITS-1:0] needed, next, group_mask;
    logic              in_picture, first_use, next_exists;

    always_comb begin
        in_picture  = tick_line < Y_BITS'(V_ACTIVE);
        group_mask  = ~({Y_BITS{1'b1}} << shift);
        first_use   = (tick_line & group_mask) == '0;
        needed      = tick_line >> shift;
        next        = in_picture ? needed + 1'b1 : '0;
        // The source line whose output lines end with the last line of the picture is the last source line.
        next_exists = (tick_line | group_mask) != Y_BITS'(V_ACTIVE - 1);
    end

    // `frame_open` is high from `frame_begun` to the next vertical blanking. `hidden_asked` is high if a fetch into the hidden slot was
    // requested in this frame. `hidden_ready` is high if this fetch has also ended, and the fetched line is the needed line.
    logic frame_open, hidden_asked, hidden_ready;
    assign hidden_ready = hidden_asked && !fetch_busy && fetch_line == needed && in_picture;

    // Step 3 (see the head of this file) runs one clock after steps 1 and 2, and uses their results.
    logic              decide;
    logic [Y_BITS-1:0] decide_line;
    logic              decide_exists;

    always_ff @(posedge clk) begin
        vblank        <= 1'b0;
        fetch         <= 1'b0;
        underflow     <= 1'b0;
        decide        <= tick;
        decide_line   <= next;
        decide_exists <= next_exists;

        if (frame_begun) frame_open <= 1'b1;

        if (tick && hidden_ready) begin
            shown        <= 1'b1;
            shown_slot   <= !shown_slot;
            hidden_asked <= 1'b0;
        end
        if (tick && in_picture && first_use && !hidden_ready) underflow <= enabled;

        if (tick && tick_line == Y_BITS'(V_ACTIVE)) begin
            vblank       <= 1'b1;
            frame_open   <= 1'b0;
            shown        <= 1'b0;
            hidden_asked <= 1'b0;
        end else if (decide && enabled && frame_open && decide_exists && !fetch_busy
                     && !(hidden_asked && fetch_line == decide_line)) begin
            fetch        <= 1'b1;
            fetch_line   <= decide_line;
            fetch_slot   <= !shown_slot;
            hidden_asked <= 1'b1;
        end

        if (rst) begin
            vblank       <= 1'b0;
            fetch        <= 1'b0;
            underflow    <= 1'b0;
            decide       <= 1'b0;
            frame_open   <= 1'b0;
            shown        <= 1'b0;
            shown_slot   <= 1'b0;
            hidden_asked <= 1'b0;
        end
    end
endmodule

`default_nettype wire

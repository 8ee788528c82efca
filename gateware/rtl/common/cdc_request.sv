// Transfers a request from one clock domain to another, and its completion back, by a four-phase handshake of two levels.
//
//   start ──▶ request (level, until done) ──▶ done ──▶ finished (one clock) ──▶ busy falls
//
// Payloads do not pass through this module: the other side reads the registers directly. Data from the source must be stable from `start`
// until `finished`; data from the destination must be stable from `done` until the next `request`. The data are therefore stable for at
// least one clock of the receiving side before the receiving side uses them.
//
// The signals are levels, not toggles, because each side may be reset alone: after a reset, a destination sees the request again, and a
// source withdraws the request. There is at most one request at a time; `start` is ignored while `busy` is high. Latency from `start` to
// `finished`: about 3 clocks of each side, plus the time until `done`.

`default_nettype none

module cdc_request (
    input  wire  src_clk,
    input  wire  src_rst,
    input  wire  src_start,
    output logic src_busy,
    output logic src_finished,

    input  wire  dst_clk,
    input  wire  dst_rst,
    output logic dst_request,
    input  wire  dst_done
);
    logic asked, asked_synced;
    logic answered, answered_synced;

    always_ff @(posedge src_clk) begin
        if (src_rst || answered_synced)     asked <= 1'b0;
        else if (src_start && !src_busy) asked <= 1'b1;
    end

    always_ff @(posedge dst_clk) begin
        if (dst_rst || !asked_synced) answered <= 1'b0;
        else if (dst_done)            answered <= 1'b1;
    end

    cdc_level to_destination (.clk(dst_clk), .level(asked),    .synced(asked_synced));
    cdc_level to_source      (.clk(src_clk), .level(answered), .synced(answered_synced));

    assign src_busy     = asked || answered_synced;
    assign src_finished = asked && answered_synced;
    assign dst_request  = asked_synced && !answered;
endmodule

`default_nettype wire

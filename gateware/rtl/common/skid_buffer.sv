// A buffer of two items in a valid/ready stream, so that no combinational path crosses it: neither from `out_ready` to
// `in_ready`, nor from `in_valid` to `out_valid`.
//
// Latency 1 clock, throughput one item per clock. Stream protocol on both sides as in `fifo`.
//
//            ┌────────┐  spare   ┌──────────┐
//   in ──┬──▶│ spare  │─────────▶│          │
//        │   └────────┘          │  output  │──▶ out
//        └──────────────────────▶│          │
//                                └──────────┘

`default_nettype none

module skid_buffer #(
    parameter int unsigned WIDTH = 8
) (
    input  wire              clk,
    input  wire              rst,
    input  wire              in_valid,
    output logic             in_ready,
    input  wire  [WIDTH-1:0] in_data,
    output logic             out_valid,
    input  wire              out_ready,
    output logic [WIDTH-1:0] out_data
);
    logic [WIDTH-1:0] spare;

    // `in_ready` is high exactly while the spare register is free. Both flags are written without a clock enable, because flip-flops with
    // different enables cannot share a slice of the FPGA.
    always_ff @(posedge clk) begin
        out_valid <= in_valid || !in_ready || !out_ready && out_valid;
        in_ready  <= !out_valid || out_ready || in_ready && !in_valid;
        if (!out_valid || out_ready) out_data <= in_ready ? in_data : spare;
        if (in_ready) spare <= in_data;

        if (rst) begin
            in_ready  <= 1'b1;
            out_valid <= 1'b0;
        end
    end
endmodule

`default_nettype wire

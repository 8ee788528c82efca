// Proof that a buffer follows the stream protocol and keeps the order of its items, with any pattern of valid and ready on its input
// and output. The buffer is one of: the skid buffer; a FIFO of depth DEPTH; a pipeline of FLIGHT clocks that ends in a credit_fifo.

`default_nettype none

module buffer_proof #(
    parameter int unsigned WIDTH = 4,
    // Depth of the FIFO; 0 selects the skid buffer.
    parameter int unsigned DEPTH = 0,
    // Whether the FIFO is in block RAM.
    parameter bit BLOCK = 1'b0,
    // Whether the FIFO in block RAM has a clock without an item after each item.
    parameter bit PAUSE = 1'b0,
    // Whether the FIFO has no output register.
    parameter bit DIRECT = 1'b0,
    // Number of clocks of the pipeline before the credit_fifo; 0 selects one of the other buffers.
    parameter int unsigned FLIGHT = 0
) (
    input wire             clk,
    input wire             in_valid,
    input wire [WIDTH-1:0] in_data,
    input wire             out_ready
);
    logic             rst = 1'b1;
    logic             in_ready, out_valid;
    logic [WIDTH-1:0] out_data;

    always_ff @(posedge clk) rst <= 1'b0;

    if (DEPTH == 0) begin : skid
        skid_buffer #(.WIDTH(WIDTH)) dut (
            .clk, .rst, .in_valid, .in_ready, .in_data, .out_valid, .out_ready, .out_data
        );
    end else if (FLIGHT != 0) begin : pipeline
        logic [FLIGHT-1:0] valid;
        logic [WIDTH-1:0]  arriving;
        logic              idle;

        always_ff @(posedge clk) valid <= rst ? '0 : FLIGHT'({valid, in_valid && in_ready});

        delay #(.WIDTH(WIDTH), .CLOCKS(FLIGHT)) flight (.clk, .enable(1'b1), .in(in_data), .out(arriving));

        credit_fifo #(.WIDTH(WIDTH), .DEPTH(DEPTH), .DIRECT(DIRECT)) dut (
            .clk, .rst, .idle, .credit(in_ready), .sent(in_valid), .in_valid(valid[FLIGHT-1]), .in_data(arriving),
            .out_valid, .out_ready, .out_data
        );
        wire _unused = idle;
    end else begin : memory
        fifo #(.WIDTH(WIDTH), .DEPTH(DEPTH), .BLOCK(BLOCK), .PAUSE(PAUSE), .DIRECT(DIRECT)) dut (
            .clk, .rst, .in_valid, .in_ready, .in_data, .out_valid, .out_ready, .out_data
        );
    end

    stream_checker #(.WIDTH(WIDTH), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data(in_data)
    );
    stream_checker #(.WIDTH(WIDTH)) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data(out_data)
    );
    order_checker #(
        .WIDTH(WIDTH), .PLACES(DEPTH == 0 ? 2 : DEPTH + 1 + (BLOCK && !PAUSE) - DIRECT), .WITHIN(FLIGHT == 0 ? 2 + BLOCK : FLIGHT + 5)
    ) order (
        .clk, .rst, .in_valid, .in_ready, .in_data, .out_valid, .out_ready, .out_data
    );
endmodule

`default_nettype wire

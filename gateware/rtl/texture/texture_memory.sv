// One quarter of one copy of the cache's blocks. Two ports read 16 bits each, or write one half of `in` each. Latency 2 clocks, because the
// block RAM has output registers. A port keeps its output while it writes.

`default_nettype none

module texture_memory #(
    parameter int unsigned ADDRESS_BITS = 11
) (
    input  wire                     clk,
    input  wire                     write,
    input  wire  [ADDRESS_BITS-1:0] first,
    input  wire  [ADDRESS_BITS-1:0] second,
    input  wire  [31:0]             in,
    output logic [15:0]             first_out,
    output logic [15:0]             second_out
);
    (* ram_style = "block", rw_addr_collision = "no", no_rw_check *) logic [15:0] halves [0:2**ADDRESS_BITS-1];

    logic [15:0] first_read, second_read;

    // One process for each port, as synthesis tools expect; always_ff would not allow two processes to write the same variable.
    always @(posedge clk) begin
        if (write) halves[first] <= in[15:0];
        else first_read <= halves[first];
        first_out <= first_read;
    end

    always @(posedge clk) begin
        if (write) halves[second] <= in[31:16];
        else second_read <= halves[second];
        second_out <= second_read;
    end
endmodule

`default_nettype wire

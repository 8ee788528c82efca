// One bit from any clock into `clk`: two flip-flops in a row.
//
// Latency 2 to 3 clocks. The level must hold for longer than one period of `clk` to be seen for sure. There is no
// reset: after one the output follows the input within the latency.

`default_nettype none

module cdc_level (
    input  wire  clk,
    input  wire  level,
    output logic synced
);
    (* async_reg = "true" *) logic captured;
    (* async_reg = "true" *) logic settled;

    always_ff @(posedge clk) begin
        captured <= level;
        settled  <= captured;
    end

    assign synced = settled;
endmodule

`default_nettype wire

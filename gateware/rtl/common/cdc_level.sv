// Brings one bit from any clock domain into the domain of `clk`, through two flip-flops in series.
//
// Latency 2 to 3 clocks. A level is only guaranteed to be seen if it holds for longer than one period of `clk`. There is no reset
// input: after a reset of the design the output follows the input within the latency.

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

// Synchronises an input pin and suppresses spikes: the output changes to a new level when the input has held this level for LENGTH clocks.
//
// Latency: 2 to 3 clocks for the synchronisation, and LENGTH clocks. The output is high after a reset.

`default_nettype none

module spike_filter #(
    parameter int unsigned LENGTH = 5
) (
    input  wire  clk,
    input  wire  rst,
    input  wire  level,
    output logic filtered
);
    localparam int unsigned COUNT_BITS = $clog2(LENGTH);

    logic                  synced;
    logic [COUNT_BITS-1:0] count;

    cdc_level crossing (.clk, .level, .synced);

    always_ff @(posedge clk) begin
        count <= synced == filtered ? '0 : count + 1'b1;
        if (synced != filtered && count == COUNT_BITS'(LENGTH - 1)) begin
            filtered <= synced;
            count    <= '0;
        end

        if (rst) begin
            filtered <= 1'b1;
            count    <= '0;
        end
    end
endmodule

`default_nettype wire

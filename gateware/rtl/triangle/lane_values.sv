// Computes the values of an accumulator in the eight lanes of a group, modulo 2^32, by doubling: first lane 4 from lane 0, then lanes 2 and
// 6 from lanes 0 and 4, then the odd lanes from the even lanes.
//
// Latency 3 clocks, throughput one group per clock.

`default_nettype none

module lane_values (
    input  wire              clk,
    input  wire  [31:0]      in,     // in lane 0
    input  wire  [31:0]      step_x,
    output logic [7:0][31:0] values
);
    logic [31:0]      step_1, step_2;
    logic [1:0][31:0] two;
    logic [3:0][31:0] four;

    always_ff @(posedge clk) begin
        step_1 <= step_x;
        two[0] <= in;
        two[1] <= in + (step_x << 2);

        step_2 <= step_1;
        for (int i = 0; i < 2; i++) begin
            four[2 * i]     <= two[i];
            four[2 * i + 1] <= two[i] + (step_1 << 1);
        end

        for (int i = 0; i < 4; i++) begin
            values[2 * i]     <= four[i];
            values[2 * i + 1] <= four[i] + step_2;
        end
    end
endmodule

`default_nettype wire

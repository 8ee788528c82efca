// sqrt(x) of x from 1 to 4 in steps of 1/128, and how far the next one is: 18 fraction bits, rounded down (docs/formats.md, "Fields").
//
// `index` is the step's number, from 128 on; what is less counts as 128. `root` is without its leading bit, which is 1. Latency 2
// clocks, throughput an answer a clock.

`default_nettype none

module root_table (
    input  wire         clk,
    input  wire  [8:0]  index,
    output logic [17:0] root,
    output logic [9:0]  slope
);
    (* ram_style = "block" *)
    logic [27:0] entries [0:511];
    logic [27:0] latched;

    // The 18 bits behind the point, and to the next one; what is below 1 is nothing at all. As in round_inverse, reals are exact enough.
    initial begin
        for (int i = 0; i < 512; i++)
            entries[i] = {
                18'($rtoi($sqrt($itor(i < 128 ? 128 : i) * 536870912.0) - 262144.0)),
                10'(20'($rtoi($sqrt($itor(i < 128 ? 129 : i + 1) * 536870912.0) - 262144.0))
                    - 20'($rtoi($sqrt($itor(i < 128 ? 128 : i) * 536870912.0) - 262144.0)))
            };
    end

    always_ff @(posedge clk) begin
        latched       <= entries[index];
        {root, slope} <= latched;
    end
endmodule

`default_nettype wire

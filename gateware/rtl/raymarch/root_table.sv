// Table of sqrt(x) for x from 1 to 4 in steps of 1/128, and of the difference to the next entry, both with 18 fraction bits and
// rounded down (docs/formats/raymarch.md, "Round fields").
//
// `index` is 128·x; for an index below 128 the result is the entry of 128. `root` omits the leading bit of the root, which is 1. Latency 2
// clocks, throughput one result per clock.

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

    // An entry is {18 fraction bits of the root, difference to the next root}. Floating-point numbers are precise enough to round the
    // entries correctly; an integer loop for the root would take Yosys a minute.
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

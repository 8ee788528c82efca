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

    // Of what is below 2^39.
    function automatic logic [19:0] root_of(input logic [39:0] square);
        root_of = '0;
        for (int bit_of = 19; bit_of >= 0; bit_of--)
            if ((40'(root_of) + (40'd1 << bit_of)) * (40'(root_of) + (40'd1 << bit_of)) <= square) root_of = root_of + (20'd1 << bit_of);
    endfunction

    function automatic logic [27:0] entry(input int number);
        logic [19:0] here, next;
        here  = root_of(40'(number) << 29);
        next  = root_of(40'(number + 1) << 29);
        entry = {here[17:0], 10'(next - here)};
    endfunction

    initial begin
        for (int i = 0; i < 512; i++) entries[i] = entry(i < 128 ? 128 : i);
    end

    always_ff @(posedge clk) begin
        latched       <= entries[index];
        {root, slope} <= latched;
    end
endmodule

`default_nettype wire

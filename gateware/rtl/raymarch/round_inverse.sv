// What is below 1/sqrt(q) for every q that begins with ten given bits: sqrt(2^10/(i + 1)), less by a part of 2^-16, u8.9
// (docs/formats.md, "Rays").
//
// Latency 2 clocks in which `enable` is high, throughput an answer a clock.

`default_nettype none

module round_inverse (
    input  wire         clk,
    input  wire         enable,
    input  wire  [9:0]  index,
    output logic [16:0] inverse
);
    (* ram_style = "block" *)
    logic [14:0] inverses [0:1023];
    logic [14:0] latched, given;

    // Reals have digits enough to cut the root of a whole number rightly, and tools take a second for them and a minute for loops.
    initial begin
        for (int i = 0; i < 1024; i++) inverses[i] = 15'($rtoi($sqrt($itor(((1 << 28) - (1 << 13)) / (i + 1)))));
    end

    assign inverse = {2'b0, given};

    always_ff @(posedge clk) begin
        if (enable) begin
            latched <= inverses[index];
            given   <= latched;
        end
    end
endmodule

`default_nettype wire

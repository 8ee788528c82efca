// Table of lower bounds of 1/sqrt(q), indexed by the first ten bits i of q: sqrt(2^10/(i + 1))·(1 - 2^-16), u8.9
// (docs/formats/raymarch.md, "Rays").
//
// Latency 2 clocks, throughput one result per clock.

`default_nettype none

module round_inverse (
    input  wire         clk,
    input  wire  [9:0]  index,
    output logic [16:0] inverse
);
    (* ram_style = "block" *)
    logic [14:0] inverses [0:1023];
    logic [14:0] latched, given;

    // Floating-point numbers are precise enough to truncate the root of an integer correctly. Tools evaluate this formula in a second; an
    // integer loop for the root would take a minute.
    initial begin
        for (int i = 0; i < 1024; i++) inverses[i] = 15'($rtoi($sqrt($itor(((1 << 28) - (1 << 13)) / (i + 1)))));
    end

    assign inverse = {2'b0, given};

    always_ff @(posedge clk) begin
        latched <= inverses[index];
        given   <= latched;
    end
endmodule

`default_nettype wire

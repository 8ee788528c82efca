// Table of lower bounds of 1/length, indexed by the first ten bits i of a length: 2^10/(i + 1), u8.9 (docs/formats/raymarch.md, "Rays").
// It has two read ports.
//
// Latency 2 clocks, throughput one result per clock at each port.

`default_nettype none

module inverse_table (
    input  wire         clk,
    input  wire  [9:0]  index_a,
    output logic [16:0] inverse_a,
    input  wire  [9:0]  index_b,
    output logic [16:0] inverse_b
);
    (* ram_style = "block" *)
    logic [16:0] inverses [0:1023];
    logic [16:0] latched_a, latched_b;

    initial begin
        for (int i = 0; i < 1024; i++) inverses[i] = 17'(((1 << 19) - 2) / (i + 1));
        // The first entries do not fit 17 bits and are saturated.
        for (int i = 0; i < 3; i++) inverses[i] = '1;
    end

    always_ff @(posedge clk) begin
        latched_a <= inverses[index_a];
        latched_b <= inverses[index_b];
        inverse_a <= latched_a;
        inverse_b <= latched_b;
    end
endmodule

`default_nettype wire

// Table of the share of a colour that fog hides, in 256ths, by the logarithm of x = density·z (docs/formats/triangle.md, "Fog"): entry i is
// s + floor(s/128) with s = nearest(255·(1 − e^(−x))), for x = 2^(3 − (i + 1/2)/128), and 0 from entry 1536 on.
//
// Two ports; latency 2 clocks, throughput one entry of each port per clock.

`default_nettype none

module fog_shares (
    input  wire              clk,
    input  wire  [1:0][10:0] indices,
    output logic [1:0][8:0]  shares
);
    (* ram_style = "block" *) logic [8:0] entries [0:2047];
    logic [1:0][8:0] latched;

    for (genvar i = 0; i < 2048; i++) begin : rows
        // The share in 255ths. Yosys computes a parameter in a tenth of the time of a function.
        localparam int NEAREST = i < 1536 ? $rtoi(255.0 * (1.0 - $exp(-$exp($ln(2.0) * (3.0 - ($itor(i) + 0.5) / 128.0)))) + 0.5) : 0;

        initial entries[i] = 9'(NEAREST + NEAREST / 128);
    end

    always_ff @(posedge clk) begin
        for (int port = 0; port < 2; port++) latched[port] <= entries[indices[port]];
        shares <= latched;
    end
endmodule

`default_nettype wire

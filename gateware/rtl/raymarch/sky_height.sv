// Computes the elevation of a ray: the component of its direction along z divided by the largest component, u0.8, rounded down
// (docs/formats/raymarch.md, "Ends"). The colour of the sky depends on it.
//
//   first ten bits of the magnitudes ─▶ largest ─▶ z / (largest + 1), a bit of the quotient per clock
//
// The result is 0 for a ray that leads `down`. Latency 9 clocks, throughput one per clock, no handshake.

`default_nettype none

module sky_height (
    input  wire               clk,
    input  wire  [2:0][9:0]   magnitude,
    input  wire               down,
    output logic [7:0]        height
);
    // The index of an array's element is the number of quotient bits that are computed. The dividend and each remainder are below the
    // divisor.
    logic [8:0][9:0] rest;
    logic [8:0][9:0] largest;
    logic [8:0][7:0] quotient;

    always_ff @(posedge clk) begin
        rest[0]     <= down ? '0 : magnitude[2];
        quotient[0] <= '0;
        if (magnitude[2] > magnitude[0] && magnitude[2] > magnitude[1]) largest[0] <= magnitude[2];
        else if (magnitude[0] > magnitude[1])                           largest[0] <= magnitude[0];
        else                                                            largest[0] <= magnitude[1];
    end

    for (genvar i = 0; i < 8; i++) begin : bits
        // Twice the remainder, minus the divisor: the highest bit is the sign.
        logic [11:0] less;

        assign less = {1'b0, rest[i], 1'b0} + {2'b11, ~largest[i]};

        always_ff @(posedge clk) begin
            rest[i+1]     <= less[11] ? {rest[i][8:0], 1'b0} : less[9:0];
            largest[i+1]  <= largest[i];
            quotient[i+1] <= {quotient[i][6:0], !less[11]};
        end

        wire _unused = less[10];
    end

    assign height = quotient[8];

    wire _unused = &{1'b0, largest[8], rest[8]};
endmodule

`default_nettype wire

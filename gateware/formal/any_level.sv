// Stand-in for the module cdc_level in proofs with several clocks. If a level changes near the clock's edge, the sampled value is the level
// before or after the change, because a metastable flip-flop may settle to either value. Each level is sampled independently of other
// levels.

`default_nettype none

module cdc_level (
    input  wire  clk,
    input  wire  level,
    output logic synced
);
    (* anyseq *) logic early;

    logic before = 1'b0, captured = 1'b0, settled = 1'b0;

    always_ff @($global_clock) before <= level;

    always_ff @(posedge clk) begin
        captured <= early ? level : before;
        settled  <= captured;
    end

    assign synced = settled;
endmodule

`default_nettype wire

// Chooses the exit by which a ray leaves a prism, from the exits at up to three planes (docs/raymarch-exits.md, "Solids").
//
// `there[i]` is high if a plane perpendicular to axis i bounds the prism. The ray leaves by the last exit if `choice[1]` is high, by the
// first if `choice[0]` is high, and otherwise by the second of three. Of equal exits, the exit of the axis with the smaller number is the
// first. The results are the chosen exit, its axis, and for each axis whether the ray has crossed its plane at this exit; they are
// undefined if the exit exceeds the range of T.
//
// Latency 2 clocks, throughput one per clock, no handshake.

`default_nettype none

module exit_choice (
    input  wire                                  clk,
    input  wire  [2:0][exit_pkg::EXIT_BITS-1:0]  exits,
    input  wire  [2:0]                           there,
    input  wire  [1:0]                           choice,
    output logic [exit_pkg::EXIT_BITS-1:0]       t,
    output logic [1:0]                           axis,
    output logic [2:0]                           crossed
);
    // The suffix of a name is the number of clocks after the inputs.
    logic [2:0][exit_pkg::EXIT_BITS-1:0] exits_1;
    logic [2:0] there_1;
    logic [1:0] choice_1;
    logic       x_y_1, x_z_1, y_z_1;
    logic [2:0] first, last, chosen;

    always_comb begin
        first[0] = (x_y_1 || !there_1[1]) && (x_z_1 || !there_1[2]);
        first[1] = (!x_y_1 || !there_1[0]) && (y_z_1 || !there_1[2]);
        first[2] = (!x_z_1 || !there_1[0]) && (!y_z_1 || !there_1[1]);
        last[0]  = (!x_y_1 || !there_1[1]) && (!x_z_1 || !there_1[2]);
        last[1]  = (x_y_1 || !there_1[0]) && (!y_z_1 || !there_1[2]);
        last[2]  = (x_z_1 || !there_1[0]) && (y_z_1 || !there_1[1]);
        for (int i = 0; i < 3; i++)
            chosen[i] = there_1[i] && (choice_1[0] ? first[i] : choice_1[1] ? last[i] : !first[i] && !last[i]);
    end

    always_ff @(posedge clk) begin
        exits_1  <= exits;
        there_1  <= there;
        choice_1 <= choice;
        x_y_1    <= exits[0] <= exits[1];
        x_z_1    <= exits[0] <= exits[2];
        y_z_1    <= exits[1] <= exits[2];

        t    <= chosen[0] ? exits_1[0] : chosen[1] ? exits_1[1] : exits_1[2];
        axis <= {chosen[2], chosen[1]};
        // The planes before the chosen one have been crossed too.
        for (int i = 0; i < 3; i++) crossed[i] <= there_1[i] && (choice_1[0] ? first[i] : choice_1[1] || !last[i]);
    end
endmodule

`default_nettype wire

// Stand-in for the module stepper in proofs. Edge functions and depths are arbitrary, but constant while the walker stalls. Only
// the number of a group (eight neighbouring pixels of a line) is computed as in the real stepper.

`default_nettype none

module stepper #(
    parameter int unsigned WIDTH = 34,
    parameter int unsigned LOW   = 18
) (
    input  wire              clk,
    input  wire              advance,
    input  wire              keep,
    input  wire              extend,
    input  wire              seek,
    input  wire              left,
    input  wire              last,
    input  wire  [WIDTH-1:0] load_value,
    input  wire  [WIDTH-1:0] step_x,
    input  wire  [WIDTH-1:0] step_y,
    output logic [WIDTH-1:0] current,
    output logic [WIDTH-1:0] next
);
    if (WIDTH == 8) begin : group
        logic [WIDTH-1:0] snapshot, from;

        assign from = extend ? current : !seek && last ? load_value : snapshot;

        always_comb begin
            if (!extend && !seek) next = last ? from : from + step_y;
            else                  next = left ? from - step_x : from + step_x;
        end

        always_ff @(posedge clk) if (advance && !keep) snapshot <= next;
    end else begin : value
        (* anyseq *) logic [WIDTH-1:0] any;

        assign next = any;
    end

    always_ff @(posedge clk) if (advance) current <= next;
endmodule

`default_nettype wire

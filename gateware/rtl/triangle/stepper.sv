// One of the walker's accumulators, such as an edge function: its value at the current group, and a snapshot of its value at an
// earlier group.
//
// In each clock with `advance` the value becomes one of the following, by the first control that is high. `keep` preserves the
// snapshot; without `keep` the snapshot takes the new value.
//
//   extend        current + step_x, or current - step_x with `left`
//   else seek     snapshot + step_x, or snapshot - step_x with `left`
//   else last     load_value
//   else          snapshot + step_y
//
// The addition is in the walker's critical loop. So the upper part of the sum is computed for both values of the carry from the
// lower part, and the logic fits LUTs of six inputs: one LUT for each bit of `from`, and one for each bit of the sum. Sums are
// modulo 2^WIDTH.

`default_nettype none

module stepper #(
    parameter int unsigned WIDTH = 34,
    parameter int unsigned LOW   = 18
) (
    input  wire                    clk,
    input  wire                    advance,
    input  wire                    keep,
    input  wire                    extend,
    input  wire                    seek,
    input  wire                    left,
    input  wire                    last,
    input  wire  [WIDTH-1:0]       load_value,
    input  wire  [WIDTH-1:0]       step_x,
    input  wire  [WIDTH-1:0]       step_y,
    output logic [WIDTH-1:0]       current,
    output logic [WIDTH-1:0]       next
);
    logic [WIDTH-1:0]     snapshot, from, step;
    logic                 sideways, negate, carry;
    logic [LOW-1:0]       low;
    logic [WIDTH-LOW-1:0] high, high_with_carry;
    logic                 below_low, below_high;

    assign sideways = extend || seek;
    assign negate   = sideways && left;
    assign from     = extend ? current : !seek && last ? load_value : snapshot;
    assign step     = sideways ? step_x ^ {WIDTH{left}} : last ? '0 : step_y;

    // The added bit below the lowest bit makes the carry in: for a subtraction it is 1 in both summands.
    assign {carry, low, below_low}       = {1'b0, from[LOW-1:0], negate} + {1'b0, step[LOW-1:0], negate};
    assign high                          = from[WIDTH-1:LOW] + step[WIDTH-1:LOW];
    assign {high_with_carry, below_high} = {from[WIDTH-1:LOW], 1'b1} + {step[WIDTH-1:LOW], 1'b1};
    assign next                          = {carry ? high_with_carry : high, low};

    always_ff @(posedge clk) begin
        if (advance) begin
            current <= next;
            if (!keep) snapshot <= next;
        end
    end

    wire _unused = &{1'b0, below_low, below_high};
endmodule

`default_nettype wire

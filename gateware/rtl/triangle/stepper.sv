// One of the walker's accumulators: its value at the current place, and a snapshot of its value at an earlier place.
//
// In each clock with `advance` the value steps from the current place or from the snapshot, or becomes `load_value`. `keep`
// preserves the snapshot; otherwise the snapshot takes the new value.
//
//   extend        current + step_x, with `left` - step_x
//   else seek     snapshot + step_x, with `left` - step_x
//   else last     load_value
//   else          snapshot + step_y
//
// The addition is in the walker's critical loop. So the upper part is computed for both carries, and the rest fits LUTs of six
// inputs: one for `from`, one for the sum of a bit. Sums are modulo 2^WIDTH.

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

    // An added bit below the sum makes the carry in: 1 on both sides for a subtraction.
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

// One of the walker's accumulators: a value at the current place, and a snapshot of it to come back to.
//
// In each clock with `advance` it moves from one of the two, or takes `load_value`; `keep` leaves the snapshot as it is.
//
//   DOWN   snapshot + step_y
//   RIGHT  + step_x, LEFT  − step_x, from the current value or from the snapshot
//   LOAD   load_value
//
// The addition is what the walker's loop waits for, so the upper part is there for both carries. Sums are modulo 2^WIDTH.

`default_nettype none

module stepper #(
    parameter int unsigned WIDTH = 34,
    parameter int unsigned LOW   = 18
) (
    input  wire                    clk,
    input  wire                    advance,
    input  wire                    from_current,
    input  wire                    keep,
    input  wire raster_pkg::move_t move,
    input  wire  [WIDTH-1:0]       load_value,
    input  wire  [WIDTH-1:0]       step_x,
    input  wire  [WIDTH-1:0]       step_y,
    output logic [WIDTH-1:0]       current,
    output logic [WIDTH-1:0]       next
);
    logic [WIDTH-1:0]     snapshot, from, step;
    logic                 negate, carry;
    logic [LOW-1:0]       low;
    logic [WIDTH-LOW-1:0] high, high_with_carry;
    logic                 below_low, below_high;

    assign from   = from_current ? current : move == raster_pkg::LOAD ? load_value : snapshot;
    assign negate = move == raster_pkg::LEFT;

    always_comb begin
        case (move)
            raster_pkg::RIGHT:   step = step_x;
            raster_pkg::LEFT:    step = ~step_x;
            raster_pkg::LOAD:    step = '0;
            default:           step = step_y;
        endcase
    end

    // A bit below makes the carry in.
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

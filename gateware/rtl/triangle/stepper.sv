// An accumulator of depth or light that follows the walker's moves: its value at the current group, and a snapshot of its
// value at an earlier group.
//
// In each clock with `advance` the new value is selected by `move`. `keep` preserves the snapshot; without `keep` the
// snapshot takes the new value.
//
//   LEFT    current - step_x
//   RIGHT   current + step_x, or snapshot + step_x with `resume`
//   DOWN    snapshot + step_y
//   LOAD    load_value
//
// All controls come from registers, so one adder behind an operand multiplexer is fast enough, and takes half the LUTs of edge_stepper.
// Sums are modulo 2^32. Latency 1 clock, throughput one move per clock.

`default_nettype none

module stepper (
    input  wire                     clk,
    input  wire                     advance,
    input  wire                     keep,
    input  wire                     resume,
    input  wire raster_pkg::move_t  move,
    input  wire  [31:0]             load_value,
    input  wire  [31:0]             step_x,     // from lane to lane; a group has eight lanes
    input  wire  [31:0]             step_y,
    output logic [31:0]             current
);
    logic [31:0] snapshot, from, group_step, less, next;
    logic        borrow, below;

    assign group_step = {step_x[28:0], 3'b000};

    // Every sum is computed as a difference, from - less - borrow, because Yosys may exchange the operands of an addition, and then needs a
    // third LUT per bit.
    always_comb begin
        case (move)
            raster_pkg::LEFT:  from = current;
            raster_pkg::RIGHT: from = resume ? snapshot : current;
            raster_pkg::DOWN:  from = snapshot;
            default:           from = load_value;
        endcase
        case (move)
            raster_pkg::LEFT:  {less, borrow} = {group_step, 1'b0};
            raster_pkg::RIGHT: {less, borrow} = {~group_step, 1'b1};
            raster_pkg::DOWN:  {less, borrow} = {~step_y, 1'b1};
            default:           {less, borrow} = '0;
        endcase
    end

    assign {next, below} = {from, 1'b0} - {less, borrow};

    always_ff @(posedge clk) begin
        if (advance) current <= next;
        if (advance && !keep) snapshot <= next;
    end

    wire _unused = &{1'b0, step_x[31:29], below};
endmodule

`default_nettype wire

// The queue of steps between the tags and the texels. While a step is at the head, its missing blocks are filled, one memory word per
// clock; then the step leaves the queue and reads its texels. No block is therefore replaced before all earlier steps have read it, and
// each step finds its blocks.
//
//   step ───▶ block RAM ─┐
//   places ─▶ block RAM ─┼──▶ head: fill clocks, then one that reads
//   misses ─▶ FIFO ──────┘
//
// The parts of a step arrive at different times, each in the order of the steps. The misses of a step must not arrive before its other
// parts; with them, the step is in the queue. `room` is high while steps may arrive, and depends on the number of steps one clock earlier.
// Latency from the misses 2 clocks, throughput one step per clock. In a clock with `fills` or `reads`, the outputs are those of the step at
// the head. After `out_room` has fallen, at most two steps leave: one at once, and the step that is being filled.

`default_nettype none

module texture_queue #(
    parameter int unsigned STEPS = texture_pkg::STEPS
) (
    input  wire                  clk,
    input  wire                  rst,
    output logic                 idle,
    output logic                 room,
    input  wire                  step_valid,
    input  texture_pkg::step_t   in_step,
    input  wire                  places_valid,
    input  wire  [3:0][6:0]      in_places,
    input  wire                  missed_valid,
    input  wire  [3:0]           in_missed,
    // A word of memory moves in a clock in which `data_valid` and `data_ready` are high.
    input  wire                  data_valid,
    output logic                 data_ready,
    output logic                 fills,
    output logic [1:0]           fill_class,
    output logic                 fill_second, // the second word of the block
    input  wire                  out_room,
    output logic                 reads,
    output texture_pkg::step_t   head_step,
    output logic [3:0][6:0]      head_places
);
    localparam int unsigned INDEX_BITS = $clog2(STEPS);

    typedef logic [INDEX_BITS:0] pointer_t;

    // A step may arrive in the clock in which `room` is computed, and in the next clock.
    localparam pointer_t MOST = pointer_t'(STEPS - 2);

    (* ram_style = "block", no_rw_check *) logic [$bits(in_step)-1:0] steps [0:STEPS-1];
    (* ram_style = "block", no_rw_check *) logic [27:0] places [0:STEPS-1];
    pointer_t              step_end, head, next, count;
    logic [INDEX_BITS-1:0] places_end;

    assign count = step_end - head;
    assign idle  = count == '0;
    assign next  = head + pointer_t'(reads);

    always_ff @(posedge clk) begin
        if (step_valid) steps[step_end[INDEX_BITS-1:0]] <= in_step;
        if (places_valid) places[places_end] <= in_places;
        head_step   <= steps[next[INDEX_BITS-1:0]];
        head_places <= places[next[INDEX_BITS-1:0]];
        step_end    <= step_end + pointer_t'(step_valid);
        places_end  <= places_end + INDEX_BITS'(places_valid);
        head        <= next;
        room        <= count <= MOST;
        if (rst) begin
            step_end   <= '0;
            places_end <= '0;
            head       <= '0;
            room       <= 1'b0;
        end
    end

    // Missing blocks of the step at the head that are not filled yet.
    logic       missed_room, next_valid, next_taken, ends;
    logic [3:0] next_missed, left;

    fifo #(.WIDTH(4), .DEPTH(STEPS), .DIRECT(1'b1)) misses (
        .clk, .rst, .in_valid(missed_valid), .in_ready(missed_room), .in_data(in_missed),
        .out_valid(next_valid), .out_ready(next_taken), .out_data(next_missed)
    );

    assign next_taken = !data_ready && out_room;
    assign fills      = data_ready && data_valid;
    assign ends       = fills && fill_second && (left & (left - 4'd1)) == '0;
    assign fill_class = left[0] ? 2'd0 : left[1] ? 2'd1 : left[2] ? 2'd2 : 2'd3;

    always_ff @(posedge clk) begin
        reads <= ends;
        if (fills) begin
            fill_second <= !fill_second;
            if (fill_second) left <= left & (left - 4'd1);
            if (ends) data_ready <= 1'b0;
        end
        if (next_taken) begin
            reads      <= next_valid && next_missed == '0;
            data_ready <= next_valid && next_missed != '0;
            left       <= next_missed;
        end
        if (rst) begin
            reads       <= 1'b0;
            data_ready  <= 1'b0;
            fill_second <= 1'b0;
        end
    end

    wire _unused = &{1'b0, missed_room};
endmodule

`default_nettype wire

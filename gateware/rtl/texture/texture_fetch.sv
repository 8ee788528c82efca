// Requests from memory the blocks that are missing in the cache, two words for each block.
//
//   blocks ─▶ FIFO ─▶ one after another ─▶ number in the level ─▶ + first block of the level ─▶ FIFO ─▶ ask
//
// The blocks of a step are requested in the order of their classes. Latency 7 clocks, throughput one word per clock. The FIFO of blocks
// holds STEPS steps; the source must not send more.

`default_nettype none

module texture_fetch #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned STEPS        = texture_pkg::STEPS
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire  [1:0]              format,
    input  wire  [3:0]              width_log2,
    // Word addresses of the first blocks of the levels.
    input  wire                     level_write,
    input  wire  [3:0]              level_number,
    input  wire  [ADDRESS_BITS-1:0] level_first,
    input  wire                     in_valid,
    input  wire  [3:0]              in_missed,  // by class; not 0
    input  texture_pkg::blocks_t    in_blocks,
    output logic                    ask_valid,
    input  wire                     ask_ready,
    output logic [ADDRESS_BITS-1:0] ask_addr
);
    localparam int unsigned ADDRESSES = 16;
    // Number of clocks from the choice of a word to its address.
    localparam int unsigned FLIGHT    = 2;

    (* ram_style = "distributed" *) logic [ADDRESS_BITS-1:0] firsts [0:15];

    always_ff @(posedge clk) if (level_write) firsts[level_number] <= level_first;

    // The lowest remaining class is requested next.
    logic                 step_valid, step_room, step_gone, room, sends, second;
    logic [3:0]           missed, done, left, next, level;

    // The places are stored without their lowest bit, which is the parity or is not used. A step therefore has 36 bits, the width of half a
    // block RAM.
    logic [1:0][1:0][7:1] in_places, places;

    for (genvar axis = 0; axis < 2; axis++) begin : shortened
        for (genvar odd = 0; odd < 2; odd++) begin : each
            assign in_places[axis][odd] = in_blocks.places[axis][odd][7:1];
        end
    end

    fifo #(.WIDTH(36), .DEPTH(STEPS), .BLOCK(1'b1)) steps (
        .clk, .rst, .in_valid, .in_ready(step_room), .in_data({in_missed, in_blocks.level, in_places}),
        .out_valid(step_valid), .out_ready(step_gone), .out_data({missed, level, places})
    );

    assign left      = missed & ~done;
    assign next      = left & ~(left - 4'd1);
    assign sends     = step_valid && room;
    assign step_gone = sends && second && left == next;

    always_ff @(posedge clk) begin
        if (sends) begin
            second <= !second;
            if (second) done <= step_gone ? '0 : done | next;
        end
        if (rst) begin
            second <= 1'b0;
            done   <= '0;
        end
    end

    // The column and the row of the block, then its number in the level. A level has a power of two of block columns, so a shift suffices.
    logic                    chosen_valid, placed_valid, chosen_second, placed_second, unused_idle;
    logic [7:0]              chosen_column, chosen_row;
    logic [7:1]              column, row;
    logic                    odd_column, odd_row;
    logic [15:0]             placed;
    logic [3:0]              columns_log2, level_columns_log2, block_log2;
    logic [ADDRESS_BITS-1:0] chosen_first, placed_first, address;

    assign odd_column         = next[1] || next[3];
    assign odd_row            = next[2] || next[3];
    assign column             = places[0][odd_column];
    assign row                = places[1][odd_row];
    assign block_log2         = format != 2'd0 ? 4'd3 : 4'd2;
    assign level_columns_log2 = width_log2 - level - block_log2;

    always_ff @(posedge clk) begin
        chosen_valid  <= sends && !rst;
        chosen_second <= second;
        chosen_column <= format != 2'd0 ? {1'b0, column} : {column, odd_column};
        chosen_row    <= format[1] ? {1'b0, row} : {row, odd_row};
        columns_log2  <= {1'b0, width_log2} < {1'b0, level} + {1'b0, block_log2} ? '0 : level_columns_log2;
        chosen_first  <= firsts[level];

        placed_valid  <= chosen_valid && !rst;
        placed_second <= chosen_second;
        placed        <= 16'(chosen_row) << columns_log2 | 16'(chosen_column);
        placed_first  <= chosen_first;
    end

    assign address = placed_first + ADDRESS_BITS'({placed, placed_second});

    pipeline_fifo #(.WIDTH(ADDRESS_BITS), .DEPTH(ADDRESSES), .FLIGHT(FLIGHT)) addresses (
        .clk, .rst, .idle(unused_idle), .room, .in_valid(placed_valid), .in_data(address),
        .out_valid(ask_valid), .out_ready(ask_ready), .out_data(ask_addr)
    );

    wire _unused = &{1'b0, step_room, unused_idle, in_blocks.places};
endmodule

`default_nettype wire

// One memory of the band buffer: 2^ROW_BITS rows of eight lanes. A lane holds WIDTH bits of one pixel. Each lane is a separate block RAM,
// so that it has its own write enable. With HALVES = 2, each half of a lane has a write enable; block RAM has a write enable for every nine
// bits.
//
//   read_row ─▶ register ─▶ RAM ─▶ register ─▶ read_data     3 clocks from `read_row` to its data
//   write_*  ─▶ register ─▶ RAM                              a `read_row` one clock after `write_row` reads the written data
//
// The memory accepts one read and one write in each clock. If a lane is read and written in the same clock, the read may return the old or
// the new value, so users must not rely on the value of such a read.

`default_nettype none

module band_bank #(
    parameter int unsigned WIDTH    = 18,
    parameter int unsigned ROW_BITS = 11,
    parameter int unsigned HALVES   = 1
) (
    input  wire                 clk,
    input  wire  [ROW_BITS-1:0] read_row,
    output logic [8*WIDTH-1:0]  read_data,
    input  wire  [ROW_BITS-1:0] write_row,
    input  wire  [7:0]          write_lanes,
    input  wire  [HALVES-1:0]   write_halves,
    input  wire  [8*WIDTH-1:0]  write_data
);
    logic [ROW_BITS-1:0] from_row, to_row;
    logic [7:0]          to_lanes;
    logic [8*WIDTH-1:0]  to_store;
    logic [HALVES-1:0]   to_halves;

    localparam int unsigned HALF = WIDTH / HALVES;

    always_ff @(posedge clk) begin
        from_row <= read_row;
        to_row   <= write_row;
        to_lanes <= write_lanes;
        to_halves <= write_halves;
        to_store <= write_data;
    end

    for (genvar lane = 0; lane < 8; lane++) begin : lanes
        (* ram_style = "block", rw_addr_collision = "no", no_rw_check *)
        logic [WIDTH-1:0] rows [0:2**ROW_BITS-1];
        logic [WIDTH-1:0] latched;

        always_ff @(posedge clk) begin
            latched <= rows[from_row];
            read_data[WIDTH*lane +: WIDTH] <= latched;
            for (int half = 0; half < HALVES; half++)
                if (to_lanes[lane] && to_halves[half])
                    rows[to_row][HALF*half +: HALF] <= to_store[WIDTH*lane+HALF*half +: HALF];
        end
    end
endmodule

`default_nettype wire

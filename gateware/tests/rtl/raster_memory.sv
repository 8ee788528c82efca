// For tests: the raster unit with a read port of its own, so that what stands around it is memory.

`default_nettype none

module raster_memory #(
    parameter int unsigned ADDRESS_BITS = 23,
    parameter int unsigned COUNT_BITS   = 20
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       restart,
    output logic                      ready,
    input  wire                       start,
    output logic                      busy,
    output logic                      done,
    input  wire  [1:0]                size,
    input  wire  [ADDRESS_BITS-1:0]   frame_base,
    input  wire  [ADDRESS_BITS-1:0]   depth_base,
    input  wire                       with_depth,
    input  wire  [15:0]               clear,
    input  wire  [1:0]                present,
    input  wire  [2*ADDRESS_BITS-1:0] list_base,
    input  wire  [2*ADDRESS_BITS-1:0] descriptor_base,
    input  wire  [4:0]                list_shift,
    output logic                      read_cmd_valid,
    input  wire                       read_cmd_ready,
    output logic [ADDRESS_BITS-1:0]   read_cmd_addr,
    input  wire                       read_rdata_valid,
    input  wire  [127:0]              read_rdata,
    output logic                      write_cmd_valid,
    input  wire                       write_cmd_ready,
    output logic [ADDRESS_BITS-1:0]   write_cmd_addr,
    output logic                      write_wdata_valid,
    input  wire                       write_wdata_ready,
    output logic [127:0]              write_wdata,
    output logic [15:0]               write_wdata_strobe,
    output logic [31:0]               clocks_busy,
    output logic [31:0]               clocks_walking,
    output logic [31:0]               clocks_empty,
    output logic [31:0]               groups_in,
    output logic [31:0]               clocks_held,
    output logic [31:0]               clocks_memory,
    output logic [31:0]               clocks_flush
);
    logic                      unit_ready, port_idle;
    logic [2:0]                ask_valid, ask_ready, data_valid, data_ready;
    logic [3*ADDRESS_BITS-1:0] ask_addr;
    logic [3*128-1:0]          data;

    assign ready = unit_ready && port_idle;
    assign write_wdata_strobe = '1;

    raster_unit #(.ADDRESS_BITS(ADDRESS_BITS), .COUNT_BITS(COUNT_BITS)) unit (
        .clk, .rst, .restart, .ready(unit_ready), .start, .busy, .done,
        .size, .frame_base, .depth_base, .with_depth, .clear, .present, .list_base, .descriptor_base, .list_shift,
        .ask_valid, .ask_ready, .ask_addr, .data_valid, .data_ready, .data,
        .cmd_valid(write_cmd_valid), .cmd_ready(write_cmd_ready), .cmd_addr(write_cmd_addr),
        .wdata_valid(write_wdata_valid), .wdata_ready(write_wdata_ready), .wdata_data(write_wdata),
        .clocks_busy, .clocks_walking, .clocks_empty, .groups_in, .clocks_held, .clocks_memory, .clocks_flush
    );

    read_port #(.CLIENTS(3), .ADDRESS_BITS(ADDRESS_BITS)) port (
        .clk, .rst, .drop(restart || !busy), .idle(port_idle),
        .ask_valid, .ask_ready, .ask_addr, .data_valid, .data_ready, .data,
        .cmd_valid(read_cmd_valid), .cmd_ready(read_cmd_ready), .cmd_addr(read_cmd_addr),
        .rdata_valid(read_rdata_valid), .rdata(read_rdata)
    );
endmodule

`default_nettype wire

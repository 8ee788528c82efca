// Two tables in one block RAM, with 256 entries of 8 bits each: the share of fog in a pixel's colour, by depth, and the share
// of light, by the number of evaluations (docs/formats/raymarch.md, "Ends").
//
// Latency 2 clocks, throughput one entry of each table per clock. The fog table is not read in the clock of a write.

`default_nettype none

module paint_table (
    input  wire        clk,
    input  wire        write,
    // Address of a write: the highest bit selects the table, 1 for light and 0 for fog; the other bits are the entry.
    input  wire  [8:0] write_entry,
    input  wire  [7:0] write_part,
    input  wire  [7:0] fog_entry,
    output logic [7:0] fog,
    input  wire  [7:0] light_entry,
    output logic [7:0] light
);
    (* ram_style = "block", no_rw_check *)
    logic [7:0] parts [0:511];
    logic [7:0] latched_fog, latched_light;
    logic [8:0] entry_a;

    assign entry_a = write ? write_entry : {1'b0, fog_entry};

    always_ff @(posedge clk) begin
        if (write) parts[entry_a] <= write_part;
        else       latched_fog <= parts[entry_a];
        latched_light <= parts[{1'b1, light_entry}];
        fog           <= latched_fog;
        light         <= latched_light;
    end
endmodule

`default_nettype wire

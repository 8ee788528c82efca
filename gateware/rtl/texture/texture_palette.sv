// The colours of a palette, with two read ports; the second port also writes. Latency 1 clock.

`default_nettype none

module texture_palette (
    input  wire         clk,
    input  wire         write,
    input  wire  [7:0]  write_index,
    input  wire  [15:0] write_colour,
    input  wire  [7:0]  first,
    input  wire  [7:0]  second,
    output logic [15:0] first_colour,
    output logic [15:0] second_colour
);
    (* ram_style = "block", rw_addr_collision = "no", no_rw_check *) logic [15:0] colours [0:255];
    logic [7:0] index;

    assign index = write ? write_index : second;

    always_ff @(posedge clk) begin
        first_colour <= colours[first];
        if (write) colours[index] <= write_colour;
        else second_colour <= colours[index];
    end
endmodule

`default_nettype wire

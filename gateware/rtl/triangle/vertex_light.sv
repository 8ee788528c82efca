// Computes the light of a vertex (docs/formats.md, "Smooth shading"): the shaded colour L of each channel, and the side of a
// triangle to which this light belongs. N is the vertex normal, l the row of the light.
//
// One multiplier makes five products: three for N·l, one for green and blue side by side, and one for red. A vertex takes 6
// clocks, in step with `vertex_stage`: `take` is high for one clock when a vertex enters that stage. The light waits in a FIFO
// until the position of its vertex leaves that stage; `give` then takes the light out. Latency 17 clocks.
//
//   clocks after `take`   1…3: factors of N·l   6: N·l   7, 8: |N·l| rounded   9: intensity   10, 11: colour in   13, 14: L

`default_nettype none

module vertex_light (
    input  wire              clk,
    input  wire              rst,
    input  wire  [2:0][24:0] row_light,
    input  wire              take,
    input  wire  [2:0][15:0] in_normal,
    input  wire  [15:0]      in_colour,
    input  wire              give,
    output logic [40:0]      out_light // {to back faces, red u13, green u14, blue u13}
);
    // The FIFO has more places than vertex_stage can hold vertices.
    localparam int unsigned PLACES = 16;

    // Bit k of `since` is high when a vertex entered k + 1 clocks ago.
    logic        [13:0]      since;
    logic        [2:0][15:0] normal;
    logic        [15:0]      colour, colour_held;
    logic signed [24:0]      a;
    logic signed [17:0]      b;
    logic signed [43:0]      c, p;
    logic        [15:0]      high, rounded;
    logic        [8:0]       intensity;
    logic                    back, back_held, whole, carry;
    logic        [26:0]      green_blue;

    always_comb begin
        case (1'b1)
            since[0]: a = row_light[0];
            since[1]: a = row_light[1];
            since[2]: a = row_light[2];
            since[9]: a = {6'b0, colour_held[10:5], 8'b0, colour_held[4:0]};
            default:  a = {20'b0, colour_held[15:11]};
        endcase
        case (1'b1)
            since[0]: b = 18'($signed(normal[0]));
            since[1]: b = 18'($signed(normal[1]));
            since[2]: b = 18'($signed(normal[2]));
            default:  b = {9'b0, intensity};
        endcase
        c = since[3] || since[4] ? p : '0;
    end

    multiply_add #(.BITS(44)) dsp (.clk, .enable(1'b1), .a, .b, .c, .p);

    // The negation of a negative product v is ~v + 1. The added 1 carries into `high` only if all bits of v below `high` are 0.
    assign carry = !back && whole;

    always_ff @(posedge clk) begin
        since <= {since[12:0], take};
        if (take) begin
            normal <= in_normal;
            colour <= in_colour;
        end
        if (since[5]) begin
            colour_held <= colour;
            high        <= p[43:28] ^ {16{p[43]}};
            whole       <= p[27:0] == '0;
            back        <= !p[43];
        end
        if (since[6])  rounded    <= high + {14'b0, carry, !carry};
        if (since[7])  intensity  <= rounded[15:9] != '0 ? 9'h100 : {1'b0, rounded[8:1]};
        if (since[9])  back_held  <= back;
        if (since[12]) green_blue <= p[26:0];
        if (rst) since <= '0;
    end

    // The FIFO is never full, and never empty at `give`.
    logic room, valid;

    fifo #(.WIDTH(41), .DEPTH(PLACES)) finished (
        .clk, .rst, .in_valid(since[13]), .in_ready(room), .in_data({back_held, p[12:0], green_blue}),
        .out_valid(valid), .out_ready(give), .out_data(out_light)
    );

    wire _unused = &{1'b0, rounded[0], room, valid};
endmodule

`default_nettype wire

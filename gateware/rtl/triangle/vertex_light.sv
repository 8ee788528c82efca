// Computes the light of a vertex (docs/formats/triangle.md, "Smooth shading" and "Light on meshes"): the shaded colour L of each
// channel, and the side of a triangle to which this light belongs. N is the vertex normal, l the row of the light. With `cull_back` only
// front faces are visible, so the light belongs to front faces. Without `cull_back`, the light belongs to the side that faces the light
// source; the other side is dark, so ambient light is not allowed.
//
// A channel of the colour has 8 bits: `fine` XOR the bits that widen RGB565. Less its highest bits, 3 of red and blue and 2 of green, it is
// in steps of RGB565, with fraction bits, as in the input of colour_pkg::rounded.
//
// One multiplier computes six products: three for N·l, and one for the share of each channel. A second multiplier computes the three
// products of colour and share. A vertex takes 6 clocks, in step with `vertex_stage`: `take` is high for one clock when a vertex enters
// vertex_stage. The light waits in a FIFO until the position of its vertex leaves vertex_stage; `give` then removes the light from the
// FIFO. Latency 21 clocks.
//
//   clocks after `take`   1…3: factors of N·l   6: N·l   7, 8: |N·l| rounded   9: intensity   10…12: factors of the shares
//                         14…16: shares, factors of L   17…19: L

`default_nettype none

module vertex_light (
    input  wire              clk,
    input  wire              rst,
    input  wire              cull_back,
    input  wire  [2:0][24:0] row_light,
    input  wire  [2:0][8:0]  light_colour, // u1.8, red is the lowest
    input  wire  [2:0][8:0]  ambient,
    input  wire              take,
    input  wire  [2:0][15:0] in_normal,
    input  wire  [23:0]      in_colour,    // {fine, colour} of records_pkg::vertex_t
    input  wire              give,
    output triangle_pkg::light_t out_light
);
    // The FIFO has more entries than vertex_stage can hold vertices.
    localparam int unsigned PLACES = 16;

    // Bit k of `since` is high when a vertex entered k + 1 clocks ago.
    logic        [18:0]      since;
    logic        [2:0][15:0] normal;
    logic        [23:0]      colour, colour_held, colour_late;
    logic        [7:0]       wide, fine;
    logic        [2:0]       highest;
    logic signed [24:0]      a, channel;
    logic signed [17:0]      b;
    logic signed [43:0]      addend, c, p, product;
    logic        [15:0]      high, rounded;
    logic        [8:0]       intensity, share;
    logic                    back, back_held, back_late, dark, whole, carry;
    logic        [15:0]      red, green;

    always_comb begin
        case (1'b1)
            since[0]:  a = row_light[0];
            since[1]:  a = row_light[1];
            since[2]:  a = row_light[2];
            since[9]:  a = {16'b0, light_colour[0]};
            since[10]: a = {16'b0, light_colour[1]};
            default:   a = {16'b0, light_colour[2]};
        endcase
        case (1'b1)
            since[0]: b = 18'($signed(normal[0]));
            since[1]: b = 18'($signed(normal[1]));
            since[2]: b = 18'($signed(normal[2]));
            default:  b = {9'b0, intensity};
        endcase
        case (1'b1)
            since[11]: addend = {27'b0, ambient[0], 8'h80};
            since[12]: addend = {27'b0, ambient[1], 8'h80};
            since[13]: addend = {27'b0, ambient[2], 8'h80};
            default:   addend = '0;
        endcase
        c = since[3] || since[4] ? p : addend;
        fine = colour_late[23:16];
        case (1'b1)
            since[13]: {highest, wide} = {colour_late[15:13], colour_late[15:11], colour_late[15:13] ^ fine[7:5]};
            since[14]: {highest, wide} = {1'b0, colour_late[10:9], colour_late[10:5], colour_late[10:9] ^ fine[4:3]};
            default:   {highest, wide} = {colour_late[4:2], colour_late[4:0], colour_late[4:2] ^ fine[2:0]};
        endcase
        channel = {17'b0, wide - {5'b0, highest}};
    end

    multiply_add #(.BITS(44)) dsp (.clk, .enable(1'b1), .a, .b, .c, .p);
    multiply_add #(.BITS(44)) colours (.clk, .enable(1'b1), .a(channel), .b({9'b0, share}), .c('0), .p(product));

    // A negative product v is negated as ~v + 1. The added 1 carries into `high` only if all bits of v below `high` are 0.
    assign carry = !back && whole;

    always_ff @(posedge clk) begin
        since <= {since[17:0], take};
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
        if (since[6])  rounded     <= high + {14'b0, carry, !carry};
        if (since[6])  dark        <= back && cull_back;
        if (since[7])  intensity   <= dark ? '0 : rounded[15:9] != '0 ? 9'h100 : {1'b0, rounded[8:1]};
        if (since[9])  back_held   <= back && !cull_back;
        if (since[11]) colour_late <= colour_held;
        if (since[13]) back_late   <= back_held;
        if (since[16]) red         <= product[15:0];
        if (since[17]) green       <= product[15:0];
        share <= p[17:16] != '0 ? 9'h100 : {1'b0, p[15:8]};
        if (rst) since <= '0;
    end

    // The FIFO is never full, and never empty while `give` is high.
    logic room, valid;

    fifo #(.WIDTH(triangle_pkg::LIGHT_BITS), .DEPTH(PLACES)) finished (
        .clk, .rst, .in_valid(since[18]), .in_ready(room), .in_data({back_late, red, green, product[15:0]}),
        .out_valid(valid), .out_ready(give), .out_data(out_light)
    );

    wire _unused = &{1'b0, rounded[0], product[43:16], room, valid};
endmodule

`default_nettype wire

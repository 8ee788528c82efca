// Table of the results of a picture's cones: for each block of pixels, the depth up to which no ray of the block hits a surface
// (docs/formats/raymarch.md, "Cones").
//
//   end of a cone: t, length ─▶ t·inverse ─▶ depth ─▶ 2^14 depths ─▶ near plane of a block
//
// A write takes 6 clocks; throughput one write per clock. A read takes 2 clocks; throughput one read per clock. A read does not return a
// write that is still in the pipeline. With ROUND, and while `round` is high, the length of a cone is Euclidean, and a second table
// contains the reciprocal of the length.

`default_nettype none

module cone_table #(
    parameter bit ROUND = 1'b0
) (
    input  wire         clk,
    input  wire         round,
    // Ends of cones.
    input  wire         in_valid,
    input  wire  [13:0] in_number,
    input  wire  [9:0]  in_length,
    input  wire  [22:0] in_t,
    // Reads.
    input  wire  [13:0] number,
    output logic [22:0] cleared
);
    // Depth up to which each cone hits no surface, u11.7.
    (* ram_style = "block", no_rw_check *) logic [17:0] depths [0:16383];

    logic [16:0]        largest_inverse_2, inverse_2;
    logic [22:0]        t_2;
    logic signed [41:0] product_5;
    logic [4:0]         valid;
    logic [13:0]        number_5;
    logic [17:0]        latched, depth;

    /* verilator lint_off PINCONNECTEMPTY */
    inverse_table table_of_inverses (.clk, .index_a(in_length), .inverse_a(largest_inverse_2), .index_b('0), .inverse_b());
    /* verilator lint_on PINCONNECTEMPTY */

    if (ROUND) begin : by_squares
        logic [16:0] round_inverse_2;
        round_inverse table_of_roots (.clk, .index(in_length), .inverse(round_inverse_2));
        assign inverse_2 = round ? round_inverse_2 : largest_inverse_2;
    end else begin : by_largest
        assign inverse_2 = largest_inverse_2;
        wire _unused = round;
    end

    delay #(.WIDTH(23), .CLOCKS(2)) t_waits (.clk, .enable(1'b1), .in(in_t), .out(t_2));
    delay #(.WIDTH(14), .CLOCKS(5)) number_waits (.clk, .enable(1'b1), .in(in_number), .out(number_5));

    multiply_add #(.BITS(42)) along (.clk, .enable(1'b1), .a({2'b0, t_2}), .b({1'b0, inverse_2}), .c('0), .p(product_5));

    always_ff @(posedge clk) begin
        valid <= {valid[3:0], in_valid};
        if (valid[4]) depths[number_5] <= product_5[31:14] | {18{product_5[41:32] != '0}};
        latched <= depths[number];
        depth   <= latched;
    end
    assign cleared = {depth, 5'd0};

    wire _unused = &{1'b0, product_5[13:0]};
endmodule

`default_nettype wire

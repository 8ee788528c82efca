// Computes the parameter T at which rays end on spheres of a lattice (docs/raymarch-exits.md, "Spheres of a lattice").
//
//   end ─▶ exit_root ─▶ -q·D - root ─▶ times 1/|D|² ─▶ shift ─▶ T of the box + ─▶ FIFO ─▶ end
//
// All ends pass in order. A hit on a sphere of the lattice beyond `far_t` becomes a miss. With ROUND, each end has its own limit instead,
// at which the ray may meet a sphere of the list. One unit is enough for all lanes, because a ray ends once. The streams are valid/ready;
// the pipeline cannot be stopped, so each end in it uses a credit. `far_t` must hold. Latency 21 clocks, throughput one end per clock.

`default_nettype none

module exit_landing #(
    // Whether rays may meet spheres of a list.
    parameter bit ROUND = 1'b0
) (
    input  wire                           clk,
    input  wire                           rst,
    input  wire  [exit_pkg::T_BITS-1:0]   far_t,
    // Ends.
    input  wire                           in_valid,
    output logic                          in_ready,
    input  wire exit_pkg::end_t           in_end,
    // Ends on spheres.
    output logic                          out_valid,
    input  wire                           out_ready,
    output exit_pkg::end_t                out_end
);
    localparam int unsigned LAST = 18;

    // The suffix of a name is the number of clocks after the end.
    logic [LAST:1]                  valid;
    logic                           idle, sent;
    exit_pkg::equation_t             equation_1;
    logic [exit_pkg::ALONG_BITS-1:0] along_9;
    logic [exit_pkg::ALONG_BITS:0]  along_10;
    logic [22:0]                    root_10;
    logic [22:0]                    distance_11;
    logic [21:0]                    distance_13;
    exit_pkg::inverse_square_t      inverse_11;
    logic [2:0]                     shift_14, shift_15;
    logic signed [43:0]             product_14;
    logic [24:0]                    fine_15, change_16;
    logic                           lands_1, lands_11, lands_15;
    logic [exit_pkg::T_BITS-1:0]    t_16;
    logic [exit_pkg::T_BITS:0]      t_17;
    exit_pkg::end_t                 end_1, end_16, end_17, end_18;
    logic [exit_pkg::ROUND_END_BITS-1:0] left_16, kept;

    assign sent = in_valid && in_ready;

    always_ff @(posedge clk) begin
        valid     <= {valid[LAST-1:1], sent};
        end_1     <= in_end;
        if (rst) valid <= '0;
    end

    assign equation_1 = end_1.equation;
    assign lands_1   = end_1.hit && end_1.round && end_1.lands;

    // Both terms have 15 fraction bits. exit_root replaces 0 by 1, and only this root can exceed the other term.
    exit_root rooting (.clk, .square(~equation_1.rest), .root(root_10));

    delay #(.WIDTH(exit_pkg::ALONG_BITS), .CLOCKS(8)) along_waits (.clk, .enable(1'b1), .in(equation_1.along), .out(along_9));

    always_ff @(posedge clk) begin
        along_10    <= {1'b0, ~along_9} + 1'b1;
        distance_11 <= {1'b0, along_10[exit_pkg::ALONG_BITS-1:0], 1'b0} - {2'b0, root_10[22:2]};
    end

    delay #(.WIDTH(exit_pkg::INVERSE_SQUARE_BITS), .CLOCKS(10)) inverse_waits (
        .clk, .enable(1'b1), .in(equation_1.inverse_square), .out(inverse_11)
    );
    delay #(.WIDTH(22), .CLOCKS(2)) distance_waits (.clk, .enable(1'b1), .in(distance_11[21:0]), .out(distance_13));
    delay #(.WIDTH(3), .CLOCKS(3)) shift_waits (.clk, .enable(1'b1), .in(3'd5 - inverse_11.exponent), .out(shift_14));
    delay #(.WIDTH(1), .CLOCKS(10)) lands_waits (.clk, .enable(1'b1), .in(lands_1), .out(lands_11));
    delay #(.WIDTH(1), .CLOCKS(4)) lands_goes (.clk, .enable(1'b1), .in(lands_11 && !distance_11[22]), .out(lands_15));

    // The factor is the mantissa minus 1, which is signed.
    multiply_add #(.BITS(44)) quotient (
        .clk, .enable(1'b1), .a({3'd0, distance_11[21:0]}), .b(inverse_11.mantissa), .c({4'd0, distance_13, 18'd0}), .p(product_14)
    );

    logic [exit_pkg::T_BITS-1:0] limit_17;

    if (ROUND) begin : own_limits
        delay #(.WIDTH(exit_pkg::T_BITS), .CLOCKS(16)) limit_waits (.clk, .enable(1'b1), .in(end_1.limit), .out(limit_17));
    end else begin : one_limit
        assign limit_17 = far_t;
    end

    logic is_beyond_17;

    assign is_beyond_17 = end_17.round && t_17 > {1'b0, limit_17};

    // The product has 33 fraction bits, and is multiplied by 2^(3 - shift).
    always_ff @(posedge clk) begin
        unique case (shift_14[1:0])
            2'd0: fine_15 <= product_14[40:16];
            2'd1: fine_15 <= {1'd0, product_14[40:17]};
            2'd2: fine_15 <= {2'd0, product_14[40:18]};
            2'd3: fine_15 <= {3'd0, product_14[40:19]};
        endcase
        shift_15  <= shift_14;
        change_16 <= !lands_15 ? '0 : shift_15[2] ? {4'd0, fine_15[24:4]} : fine_15;
        t_17      <= {1'b0, t_16} + {4'd0, change_16};

        end_17     <= end_16;
        end_18     <= end_17;
        end_18.t   <= ROUND && is_beyond_17 ? limit_17 : t_17[exit_pkg::T_BITS-1:0];
        end_18.hit <= end_17.hit && !is_beyond_17;
    end

    delay #(.WIDTH(exit_pkg::ROUND_END_BITS), .CLOCKS(15)) rest_waits (
        .clk, .enable(1'b1), .in(end_1[exit_pkg::ROUND_END_BITS-1:0]), .out(left_16)
    );
    assign end_16 = exit_pkg::END_BITS'(left_16);
    assign t_16   = end_16.t;

    credit_fifo #(.WIDTH(exit_pkg::ROUND_END_BITS), .DEPTH(32)) landed (
        .clk, .rst, .idle, .credit(in_ready), .sent, .in_valid(valid[LAST]), .in_data(end_18[exit_pkg::ROUND_END_BITS-1:0]),
        .out_valid, .out_ready, .out_data(kept)
    );

    assign out_end = exit_pkg::END_BITS'(kept);

    wire _unused = &{1'b0, idle, along_10[exit_pkg::ALONG_BITS], root_10[1:0], product_14[43:41], product_14[15:0], shift_15[1:0],
                     end_18.equation, end_18.lands, end_18.limit, end_1.limit, far_t, end_18.spot, end_1.spot};
endmodule

`default_nettype wire

// Steps 1 to 4 of the vertex stage (docs/formats/triangle.md): transforms a position P to camera coordinates X, Y, Z, compares Z with
// the near plane, and normalises Z to its mantissa. In orthographic projection the frame's depth scale, instead of Z, selects the bits of
// the mantissa.
//
// Clock numbers count from the vertex's entry into `vertex_stage`, which explains `half` and `element`.
//
//   1…3    n·P, one product per clock   1…6   U·P, then V·P
//   6      Z is valid                   6, 9   X, Y are valid (`planar`)
//   7      `zeros`, comparisons of both halves of Z
//   8      `behind`
//   9      `mantissa`

`default_nettype none

module vertex_transform (
    input  wire                clk,
    input  wire                half,
    input  wire  [1:0]         element,
    // Frame.
    input  wire                orthographic,
    input  wire  signed [3:0]  depth_exponent,
    input  wire  [2:0][24:0]   row_u,
    input  wire  [2:0][24:0]   row_v,
    input  wire  [2:0][24:0]   row_n,
    input  wire  signed [43:0] tx,
    input  wire  signed [43:0] ty,
    input  wire  signed [43:0] tz,
    input  wire  [38:0]        near_z,
    // A vertex.
    input  wire  [2:0][15:0]   position,
    output logic signed [38:0] planar, // without the lowest five bits, which step 6 discards
    output logic [3:0]         zeros,
    output logic               behind,
    output logic [23:0]        mantissa
);
    logic signed [15:0] factor;
    logic signed [24:0] row_planar, row_deep;

    always_comb begin
        case (element)
            2'd0:    factor = position[0];
            2'd1:    factor = position[1];
            default: factor = position[2];
        endcase
        case ({half, element})
            3'b000:  row_planar = row_u[0];
            3'b001:  row_planar = row_u[1];
            3'b010:  row_planar = row_u[2];
            3'b100:  row_planar = row_v[0];
            3'b101:  row_planar = row_v[1];
            default: row_planar = row_v[2];
        endcase
        case (element)
            2'd0:    row_deep = row_n[0];
            2'd1:    row_deep = row_n[1];
            default: row_deep = row_n[2];
        endcase
    end

    // Two clocks after the factors of the first of three products, the accumulator is set to the translation plus this product. In the next
    // two clocks the other products are added.
    logic               first;
    logic signed [43:0] translation, addend_planar, addend_deep, sum, deep;

    assign first         = element == 2'd2;
    assign translation   = half ? ty : tx;
    assign addend_planar = first ? translation : sum;
    assign planar        = sum[43:5];
    assign addend_deep   = first ? tz : deep;

    multiply_add #(.BITS(44)) multiply_planar (
        .clk(clk), .enable(1'b1), .a(row_planar), .b(18'(factor)), .c(addend_planar), .p(sum));
    multiply_add #(.BITS(44)) multiply_deep (
        .clk(clk), .enable(1'b1), .a(row_deep), .b(18'(factor)), .c(addend_deep), .p(deep));

    // In orthographic projection the mantissa starts with bit 35 + ke of Z.
    logic [3:0] places;

    assign places = 4'd5 - depth_exponent;

    // Compares Z with near in two halves. The highest bit of near_z is bit 38; `far` is high if Z has a set bit above bit 38. If Z is
    // beyond the near plane, the highest set bit of Z is one of the bits 30 to 40.
    logic        negative, far, high_less, high_equal, low_less;
    logic [40:6] z;

    always_ff @(posedge clk) begin
        negative   <= deep[43];
        far        <= deep[42:39] != '0;
        high_less  <= deep[38:20] < near_z[38:20];
        high_equal <= deep[38:20] == near_z[38:20];
        low_less   <= deep[19:0] < near_z[19:0];
        behind     <= negative || !far && (high_less || high_equal && low_less);

        z <= deep[40:6];
        casez (deep[40:31])
            10'b1?????????: zeros <= 4'd0;
            10'b01????????: zeros <= 4'd1;
            10'b001???????: zeros <= 4'd2;
            10'b0001??????: zeros <= 4'd3;
            10'b00001?????: zeros <= 4'd4;
            10'b000001????: zeros <= 4'd5;
            10'b0000001???: zeros <= 4'd6;
            10'b00000001??: zeros <= 4'd7;
            10'b000000001?: zeros <= 4'd8;
            10'b0000000001: zeros <= 4'd9;
            default:        zeros <= 4'd10;
        endcase
        if (orthographic) zeros <= places;
    end

    // Shifts Z to the left until its highest set bit is the top bit, first by multiples of four.
    logic [26:0] risen;
    logic [1:0]  rest;

    always_ff @(posedge clk) begin
        case (zeros[3:2])
            2'd0:    risen <= z[40:14];
            2'd1:    risen <= z[36:10];
            default: risen <= z[32:6];
        endcase
        rest <= zeros[1:0];
        case (rest)
            2'd0: mantissa <= risen[26:3];
            2'd1: mantissa <= risen[25:2];
            2'd2: mantissa <= risen[24:1];
            2'd3: mantissa <= risen[23:0];
        endcase
    end
endmodule

`default_nettype wire

// Evaluates a plane of light (the linear function of one colour channel, see triangle_pkg) at the row where the triangle enters
// the band: computes start + step_y * offset, modulo 2^32. `offset` is the number of rows from the triangle's first row to the row of the
// entry.
//
// The module `band_entry` drives the control inputs and counts the passes 0 to 7 of a triangle. The low 24 bits of step_y are multiplied in
// pass 6, the high 8 bits in pass 7, and the start is added to the first product.

`default_nettype none

module plane_entry (
    input  wire         clk,
    input  wire         take,      // a plane enters
    input  wire  [2:0]  pass,
    input  wire         advance,
    input  wire  [9:0]  offset,
    input  wire         hold,      // the triangle moves to the held stage
    input  wire         begins,    // the first product is valid
    input  wire         result,    // the value is computed
    input  wire         give,      // the held value is sent out
    input  wire  [95:0] in_plane,  // {step_y, step_x, start}
    output logic [95:0] out_plane  // {step_y, step_x, value at the row}
);
    localparam logic [2:0] LOW = 3'd6;

    // `late_start` holds the start until the first product is valid, because the next triangle may have entered by then.
    logic [31:0]        start, late_start, step_x, step_y, held_step_x, held_step_y, held;
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [47:0] c, sum;

    assign a = pass == LOW ? {1'b0, step_y[23:0]} : {step_y[31:24], 17'd0};
    assign b = pass == LOW ? {8'd0, offset}       : {1'b0, offset, 7'd0};

    assign c = begins ? {16'd0, late_start} : sum;

    multiply_add #(.BITS(48)) dsp (.clk, .enable(advance), .a, .b, .c, .p(sum));

    always_ff @(posedge clk) begin
        if (take)    {step_y, step_x, start} <= in_plane;
        late_start <= start;
        if (hold)    {held_step_y, held_step_x} <= {step_y, step_x};
        if (result)  held <= sum[31:0];
        if (give)    out_plane <= {held_step_y, held_step_x, held};
    end
endmodule

`default_nettype wire

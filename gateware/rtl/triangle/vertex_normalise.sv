// Step 6 of the vertex stage (docs/formats/triangle.md): X' = nearest(X·2^−sh) and Y' = nearest(Y·2^−sh), saturated to 25 bits, with one
// shifter for both.
//
// Clock numbers count from the vertex's entry into `vertex_stage`.
//
//   6, 9     X, Y arrive                  8        sh − 6 is valid, until 13
//   8, 11    shift by 16 and 8          9, 12  by 4 and 2
//   10, 13   by 1, round                11, 14 saturate
//   24…29    X', Y' are valid, with the reciprocal

`default_nettype none

module vertex_normalise (
    input  wire                clk,
    input  wire                half,
    input  wire  [1:0]         element,
    input  wire  [4:0]         scale_shift,
    // `planar` is X or Y without its lowest five bits; the lowest bit of `planar` is at most half a unit of the result.
    input  wire  signed [38:0] planar,
    // Leading zeros of Z, valid in clock 7. The shift sh is f + lead − 34, where f is `scale_shift` and lead is 40 − zeros.
    input  wire  [3:0]         zeros,
    output logic signed [24:0] x,
    output logic signed [24:0] y
);
    logic signed [38:0] waiting, wide, by_eights, by_twos, shifted;
    logic [4:0]         shift;
    logic signed [25:0] rounded;
    logic               sign, overflow;
    logic signed [24:0] saturated;

    assign shifted = shift[0] ? by_twos >>> 1 : by_twos;

    always_comb begin
        saturated = rounded[24:0];
        // Rounding up may result in 2^24, the first value that is out of range.
        if (overflow || rounded[25] != rounded[24]) saturated = {sign, {24{!sign}}};
    end

    always_ff @(posedge clk) begin
        waiting <= planar;
        wide    <= waiting;
        if (!half && element == 2'd0) shift <= scale_shift - 5'(zeros);
        case (shift[4:3])
            2'd0:    by_eights <= wide;
            2'd1:    by_eights <= wide >>> 8;
            default: by_eights <= wide >>> 16;
        endcase
        case (shift[2:1])
            2'd0: by_twos <= by_eights;
            2'd1: by_twos <= by_eights >>> 2;
            2'd2: by_twos <= by_eights >>> 4;
            2'd3: by_twos <= by_eights >>> 6;
        endcase
        rounded  <= 26'(signed'(shifted[25:1])) + 26'(shifted[0]);
        sign     <= shifted[38];
        overflow <= shifted[38:25] != {14{shifted[38]}};
    end

    // Results that are held until the reciprocal of the same vertex is valid: X' from clock 12 on, Y' from clock 15 on.
    logic signed [24:0] x_first, x_second, y_first, y_second;

    always_ff @(posedge clk) begin
        if (half && element == 2'd1) begin
            x_first  <= saturated;
            x_second <= x_first;
            x        <= x_second;
            y_second <= y_first;
            y        <= y_second;
        end
        if (!half && element == 2'd1) y_first <= saturated;
    end
endmodule

`default_nettype wire

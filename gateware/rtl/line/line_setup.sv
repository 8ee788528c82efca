// Set-up of segments (docs/formats/line.md, "Lines"): computes the first pixel of each line with its error and its depth, follows the line
// through the bands of the picture, and sends a piece for each band in which the line has a pixel.
//
//        A╲         ┌ first pixel, error, depth
//      ════╳══════  piece 1 from here
//           ╲       ┊ one pixel per clock
//      ══════╲════  piece 2 from here: the raster pass of this band needs no division
//             B
//
// The set-up has one subtractor, one multiplier and one divider, which work at the same time. The shift register `at` is a one-hot program
// counter:
//
//   at          subtractor                  multiplier                       divider, 32 clocks
//    0 to  9    |dx|, |dy|, their signs
//   10 to 15    pixels of B, A, positions in them
//   16 to 18    minor, major                minor * ahead - tie
//   19 to 23                                + major * (above - 256)          depth step
//   24 to 28                                depth step * ahead + bias
//
// On an axis along which the segment runs backward, coordinates are mirrored (`~(x - 1)`), so both coordinates increase along the walk.
// `edge_row`, also mirrored, is the first row past the current band of the walk; `entered` is high until the piece of this band has been
// copied to the output. The walk continues while a copied piece waits at the output.
//
// Streams are valid/ready. A segment leaves the input stream after its last piece, so its fields need no copy. A segment takes 31 clocks,
// or 59 if a depth step is computed (if the depths of its ends differ and it is at least one pixel long). One clock is added for each pixel
// until the line leaves the picture, including pixels before the line enters the picture, one for each piece, and one for each band that
// the line crosses in the picture. Up to 28 clocks for bands overlap with the division. A piece waits until the previous piece has moved.
// `size` and `bias` must hold while a segment is processed.

`default_nettype none

module line_setup (
    input  wire                    clk,
    input  wire                    rst,
    // Size code of the picture; and the bias, in depth codes, that moves lines nearer to the eye.
    input  wire  [1:0]             size,
    input  wire  [15:0]            bias,
    input  wire                    in_valid,
    output logic                   in_ready,
    input  wire line_pkg::segment_t in_segment,
    output logic                   out_valid,
    input  wire                    out_ready,
    output records_pkg::piece_t       out_piece
);
    // One-hot state: one of the states `at` of the program, the walk along the line, or the end.
    logic [28:0] at;
    logic        walking, finished, waiting;

    // The coordinate fetched for the subtractor, and the previously fetched coordinate.
    logic               fetch_y, fetch_b, locates;
    logic signed [19:0] fetched, previous;
    logic signed [20:0] difference;
    // Whether the segment runs backward, and the axis along which it is longer.
    logic               left, up, x_major, back_major, back_minor;
    // Distances between the end points: |dx| and |dy|, then along the major and the minor axis.
    logic [19:0]        major, minor;
    logic signed [20:0] fall;

    assign back_major = x_major ? left : up;
    assign back_minor = x_major ? up : left;
    assign fall       = {1'b0, minor} - {1'b0, major};

    assign fetch_y = at[2] || at[3] || at[6] || at[7]
                  || (x_major ? at[10] || at[12] || at[14] || at[15] : at[11] || at[13] || at[16] || at[17]);
    assign fetch_b = at[1] || at[3] || at[10] || at[11] || at[4] && left || at[5] && !left || at[6] && up || at[7] && !up
                  || at[14] && back_minor || at[15] && !back_minor || at[16] && back_major || at[17] && !back_major;

    // A position is the coordinate minus 1: while `locates` is high, the subtractor subtracts 1 instead of the previous coordinate.
    assign locates    = at[11] || at[12] || at[13] || at[14];
    assign difference = {fetched[19], fetched} + ~{previous[19], previous} + 21'(!locates);

    always_ff @(posedge clk) begin
        case ({fetch_y, fetch_b})
            2'b00: fetched <= in_segment.a_x;
            2'b01: fetched <= in_segment.b_x;
            2'b10: fetched <= in_segment.a_y;
            2'b11: fetched <= in_segment.b_y;
        endcase
        previous <= fetched;
        if (at[10] || locates) previous <= '0;

        if (at[2]) left <= difference[20];
        if (at[4]) up <= difference[20];
        if (at[9]) x_major <= !fall[20];
        if (at[6] || at[8] || at[16] || at[18]) begin
            major <= difference[19:0];
            minor <= major;
        end
    end

    // Coordinates of an end point along both axes, minus 1; `on_minor` and `on_major` are also mirrored. The high bits are the index of the
    // pixel, the low eight bits the position in the pixel.
    logic [20:0] minor_place, major_place, on_minor, on_major;
    logic [6:0]  beside;
    logic        below, passed;
    logic [7:0]  distance;

    always_ff @(posedge clk) begin
        if (at[11] || at[13]) minor_place <= difference;
        if (at[12] || at[14]) major_place <= difference;
    end

    assign on_minor = minor_place ^ {21{back_minor}};
    assign on_major = major_place ^ {21{back_major}};

    assign beside   = on_minor[6:0] ^ {7{!on_minor[7]}};
    assign below    = (x_major ? on_minor[7] : on_major[7]) ^ up;
    assign distance = {1'b0, beside} + {1'b0, on_major[6:0]} + 8'(below);
    assign passed   = on_major[7] && distance[7];

    // Distances from the end point: `ahead` to the first pixel's centre along the major axis; `above` to the border of the pixel along the
    // minor axis, less 256.
    logic signed [9:0] ahead, above;
    logic              tie;

    // Yosys puts the logic of the second summand into the LUTs of the sum, but uses separate LUTs for the logic of the first summand.
    assign ahead = 10'(back_major) + {{2{on_major[7] && !passed}}, on_major[7], ~on_major[6:0]};
    assign above = 10'(!back_minor) + {2'b11, on_minor[7:0]};
    assign tie   = x_major ? left || minor == '0 : !left;

    // Divider of the depth step. The register `quotient` shifts the dividend out and the quotient in. For a negative difference of the
    // depths the bits of dividend and quotient are complemented, so that the quotient is rounded down.
    logic signed [24:0] depth_difference;
    logic               falls, divides, dividing;
    logic [31:0]        quotient;
    logic signed [21:0] rest, next_rest;
    logic [4:0]         bits_done;

    assign depth_difference = {1'b0, in_segment.b_w} - {1'b0, in_segment.a_w};
    assign divides   = major[19:8] != '0 && depth_difference != '0;
    assign next_rest = {rest[20:0], quotient[31] ^ falls} + ({2'd0, major} ^ {22{!rest[21]}}) + 22'(!rest[21]);

    always_ff @(posedge clk) begin
        if (at[19]) begin
            falls     <= divides && depth_difference[24];
            quotient  <= {depth_difference[15:0], 16'd0};
            rest      <= {14'd0, depth_difference[23:16] ^ {8{depth_difference[24]}}};
            bits_done <= '0;
            dividing  <= divides;
            if (!divides) quotient <= '0;
        end else if (dividing) begin
            quotient  <= {quotient[30:0], !next_rest[21] ^ falls};
            rest      <= next_rest;
            bits_done <= bits_done + 1'b1;
            dividing  <= bits_done != '1;
        end
        if (rst) dividing <= 1'b0;
    end

    // The multiplier adds its product to `addend`. If a factor is 0 and the addend is the previous sum, the sum does not change.
    logic signed [24:0] factor;
    logic signed [17:0] other;
    logic signed [41:0] addend, sum;

    always_comb begin
        factor = {5'd0, major};
        if (at[24]) factor = {{17{falls}}, quotient[31:24]};
        if (at[25]) factor = {1'b0, quotient[23:0]};

        other = at[19] ? 18'(above) : 18'(ahead);
        if (!(at[17] || at[19] || at[24] || at[25])) other = '0;

        // The bias plus half a code, with 22 fraction bits.
        addend = sum & {42{!(at[19] || at[26] || at[27])}} | {42{at[19] && tie}}
               | {28'd0, bias[15:2]} & {42{at[26]}} | {sum[17:0], bias[1:0], 1'b1, 21'd0} & {42{at[27]}};
    end

    multiply_add #(.BITS(42)) multiplier (.clk, .enable(1'b1), .a(factor), .b(other), .c(addend), .p(sum));

    // The current pixel, its depth, and the error of the next pixel. All of them start at 0.
    logic               clear, walks, pending;
    logic signed [12:0] at_major, at_minor, end_major, major_change, minor_change;
    logic signed [13:0] remaining;
    logic signed [20:0] error, error_change;
    logic signed [33:0] depth, depth_change;

    assign pending      = !error[20];
    assign remaining    = {end_major[12], end_major} - {at_major[12], at_major};
    assign major_change = walks ? '0 : on_major[20:8];
    assign minor_change = at[15] ? on_minor[20:8] : '0;

    always_comb begin
        error_change = pending ? fall : {1'b0, minor};
        if (at[22]) error_change = sum[28:8];

        depth_change = {{2{falls}}, quotient};
        if (at[20]) depth_change = {2'd0, in_segment.a_w, 8'd0};
        if (at[28]) depth_change = sum[41:8];
    end

    always_ff @(posedge clk) begin
        if (at[13] || at[15] || walks) at_major <= at_major + major_change + 13'(walks || passed);
        if (at[15] || at[23] || walks) at_minor <= at_minor + minor_change + 13'(pending && !at[15]);
        if (at[22] || at[23] || walks) error <= error + error_change;
        if (at[20] || at[28] || walks) depth <= depth + depth_change;

        if (at[14]) end_major <= at_major;
        if (clear || at[14]) at_major <= '0;
        if (clear) begin
            at_minor <= '0;
            error    <= '0;
            depth    <= '0;
        end
    end

    // The current band, and whether the pixel is in the picture.
    logic signed [12:0] row, edge_row, edge_change;
    logic [12:0]        column;
    logic               reached, at_border, entered, shown, tracks, leaves, sends, copies;
    logic [9:0]         height;
    logic [12:0]        minus_height;
    logic [4:0]         blocks;
    band_pkg::cut_t     cut;

    // Values derived from `size`, which must not change while a segment is processed. The width of the picture is 64 times `blocks`.
    always_ff @(posedge clk) begin
        cut          <= band_pkg::cut(size);
        height       <= 10'(picture_pkg::HEIGHT) << size;
        minus_height <= 13'(-picture_pkg::HEIGHT) << size;
    end

    assign blocks    = cut.stride[7:3];
    assign row       = x_major ? at_minor : at_major;
    assign column    = (x_major ? at_major : at_minor) ^ {13{left}};
    assign reached   = row >= edge_row;
    assign at_border = edge_row == (up ? '0 : {3'd0, height});
    assign shown     = column[12:11] == '0 && column[10:6] < blocks;
    assign tracks    = (at[24] || walking) && reached && !at_border;
    // The pixel is past the last row, or beyond the side to which the line runs.
    assign leaves    = reached ? at_border : !shown && column[12] == left;
    assign sends     = entered && shown && !reached;
    assign walks     = walking && !reached && !sends;
    assign copies    = walking && sends && !out_valid;

    always_comb begin
        edge_change = {7'd0, cut.lines};
        if (at[5]) edge_change = up ? minus_height : '0;
    end

    always_ff @(posedge clk) begin
        if (at[5] || tracks) edge_row <= edge_row + edge_change;
        if (tracks)      entered <= 1'b1;
        else if (copies) entered <= 1'b0;
        if (clear) begin
            edge_row <= '0;
            entered  <= 1'b0;
        end
    end

    assign waiting  = at == '0 && !walking && !finished;
    assign clear    = waiting;
    assign in_ready = finished && !out_valid;

    always_ff @(posedge clk) begin
        at        <= {at[27:0], waiting && in_valid};
        at[17]    <= at[16] && remaining > 0;
        at[24]    <= at[23] || at[24] && dividing;
        at[25]    <= at[24] && !dividing;
        walking   <= at[28] || walking && !leaves && !(walks && remaining == 14'sd1);
        finished  <= at[16] && remaining <= 0 || walking && (leaves || walks && remaining == 14'sd1) || finished && out_valid;
        out_valid <= copies || out_valid && !out_ready;

        if (rst) begin
            at        <= '0;
            walking   <= 1'b0;
            finished  <= 1'b0;
            out_valid <= 1'b0;
        end
    end

    // State of the walk at the first pixel of the piece at the output.
    logic [33:0] first_depth;
    logic [20:0] first_error;
    logic [11:0] count;
    logic [9:0]  first_row;
    logic [10:0] first_column;

    always_ff @(posedge clk) if (copies) begin
        first_depth  <= depth;
        first_error  <= error;
        count        <= remaining[11:0];
        first_row    <= row[9:0] ^ {10{up}};
        first_column <= column[10:0];
    end

    assign out_piece = {
        in_segment.colour, {2{falls}}, quotient, first_depth, fall, minor, first_error, count, first_row, first_column, up, left,
        x_major
    };

    wire _unused = &{1'b0, distance[6:0], cut.last_band, cut.stride[2:0], cut.rows};
endmodule

`default_nettype wire

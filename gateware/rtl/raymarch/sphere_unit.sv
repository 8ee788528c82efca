// Finds the first sphere of a list that the ray of each pixel of a frame meets (docs/raymarch-exits.md, "Spheres of a list").
//
//   groups of 8 columns ─▶ a clock for each cone ─▶ FIFO of masks ─▶ a job for each cone at a pixel
//                                                                                    │
//                                                                                    ▼
//                                               forward·f, two sides ─▶ f² - a² - b² ─▶ root·share + f ─▶ exit_mantissa
//                                                                                                              │
//   meetings ◀─ FIFO ◀─ first of the pixel's cones ◀─ shift ◀─ distance·reciprocal ◀───────────────────────────┘
//
// An eye sees each sphere in a cone. The list of an eye has a cone for each sphere, and one more for each sphere that the near plane
// cuts. Each cone has a bounding rectangle on the screen. A pixel takes one clock for each cone whose rectangle contains it, and at
// least one clock. Rectangles consist of whole groups of 8 columns: while the pixels of a group pass, the cones of the next group are
// found without delay if there are at most 8.
//
// The pixels of a line are processed from left to right. With `stereo` each line is processed first for the left eye, then for the
// right eye. The results carry no position, because the rays of ray_pixels have the same order.
//
// Multipliers compute three linear functions of a pixel's column and row: two each for the forward function and side a, one for side b.
// Adding `across` from pixel to pixel would instead need two sums of up to 46 bits for each function and cone, in LUT memory: some 600
// LUTs instead of five multipliers, and no pixel could be skipped.
//
// `start` (one clock) begins the frame, and is allowed when the last meeting of the previous frame has left. The T of a ray that meets
// no sphere up to the far limit is the far limit. The output is a valid/ready stream: each item moves in a clock in which both are high,
// and payloads stay until then.
//
// The constants of the cones are written one at a time, in clocks with `write`, between frames. `address` is {eye, number of
// the cone, constant}. All numbers start at bit 0 of `value`, in this order:
//
//   0   columns: groups of the first and the last column, 8 bits each      8   first of side a, the 14 highest bits
//   1   rows: first and last, 10 bits each                                 9   first of side b, the 32 lowest bits
//   2   across of side a                                                  10   first of side b, the 14 highest bits
//   3   down of side a                                                    11   first of the forward function, s1.30
//   4   down of side b                                                    12   share, u0.17
//   5   across of the forward function                                    13   distance: mantissa of 24 bits, exponent of 4 bits
//   6   down of the forward function                                      14   number of the sphere, 3 bits, and half the shift of
//   7   first of side a, the 32 lowest bits                                    the sides' changes, 2 bits
//
// With CONE, the list may also include a solid cone. Bits 5 to 7 of constant 14 are the kind of a list entry, and constant 15 is `across`
// of side b. The kinds are:
// - SPHERE: a sphere, or its section by the near plane;
// - BASE: the plane of the solid cone's base, for an eye below this plane: the ray meets the base as a disc, and other faces behind the
//   plane;
// - LIMIT: the same plane, for an eye above it: the ray meets other faces before the plane;
// - LATERAL: the lateral surface: side b replaces the forward function as the divisor's addend, and the square of side b is left out;
// - AROUND: the lateral surface, for an eye above the apex that sees it all around: the root of the sum of the sides' squares is subtracted;
// - SECTION: the section of the cone by the near plane, which the ray meets at the near plane.
// The entry with the plane precedes those of the other faces.
//
// `across` and `down` have 25 bits with a sign. `last_cone` has the number of the last cone of each eye; an eye without cones has one entry
// whose first column is above its last column. Results are rounded as in the model. The other parameters must hold until the frame has
// ended.
//
// Latency 58 clocks for the first pixel of a group, if there are 8 cones. `rst` ends the frame.

`default_nettype none

module sphere_unit #(
    parameter bit STEREO = 1'b1,
    // Whether there may be a solid cone.
    parameter bit CONE   = 1'b0
) (
    input  wire                                clk,
    input  wire                                rst,
    input  wire                                start,
    // Frame: numbers of its last group of 8 columns and of its last row, counted from 0.
    input  wire  [7:0]                         last_group,
    input  wire  [9:0]                         last_row,
    input  wire                                stereo,
    input  wire  [exit_pkg::T_BITS-1:0]        near_limit,
    input  wire  [exit_pkg::T_BITS-1:0]        far_limit,
    input  wire  [1:0][3:0]                    last_cone,
    input  wire                                write,
    input  wire  [8:0]                         address,
    input  wire  [31:0]                        value,
    // Meetings.
    output logic                               out_valid,
    input  wire                                out_ready,
    output exit_pkg::meeting_t                 out_meeting
);
    localparam int unsigned CONES      = 16;
    localparam int unsigned ENTRIES    = STEREO ? 2 * CONES : CONES;
    localparam int unsigned ENTRY_BITS = $clog2(ENTRIES);
    localparam int unsigned GROUP_BITS = 1 + 10 + 8;
    // Latency of the tests in clocks.
    localparam int unsigned LAST       = 40;

    // Constants of the cones, each in a LUT memory that is read in the clock in which the constant is used.
    (* ram_style = "distributed" *) logic [15:0] columns      [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [19:0] rows         [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [24:0] across_a     [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [24:0] down_a       [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [24:0] down_b       [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [24:0] across_f     [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [24:0] down_f       [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [31:0] first_a_low  [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [13:0] first_a_high [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [31:0] first_b_low  [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [13:0] first_b_high [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [31:0] first_f      [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [16:0] shares       [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [27:0] distances    [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [2:0]  spheres      [0:ENTRIES-1];
    (* ram_style = "distributed" *) logic [1:0]  shifts       [0:ENTRIES-1];

    typedef enum logic [2:0] {SPHERE, BASE, LIMIT, LATERAL, AROUND, SECTION} kind_t;

    logic                  write_1;
    logic [8:0]            address_1;
    logic [31:0]           value_1;
    logic [ENTRY_BITS-1:0] written;

    assign written = address_1[4 +: ENTRY_BITS];

    always_ff @(posedge clk) begin
        write_1   <= write;
        address_1 <= address;
        value_1   <= value;
        if (write_1) begin
            if (address_1[3:0] == 4'd0)  columns[written]      <= value_1[15:0];
            if (address_1[3:0] == 4'd1)  rows[written]         <= value_1[19:0];
            if (address_1[3:0] == 4'd2)  across_a[written]     <= value_1[24:0];
            if (address_1[3:0] == 4'd3)  down_a[written]       <= value_1[24:0];
            if (address_1[3:0] == 4'd4)  down_b[written]       <= value_1[24:0];
            if (address_1[3:0] == 4'd5)  across_f[written]     <= value_1[24:0];
            if (address_1[3:0] == 4'd6)  down_f[written]       <= value_1[24:0];
            if (address_1[3:0] == 4'd7)  first_a_low[written]  <= value_1;
            if (address_1[3:0] == 4'd8)  first_a_high[written] <= value_1[13:0];
            if (address_1[3:0] == 4'd9)  first_b_low[written]  <= value_1;
            if (address_1[3:0] == 4'd10) first_b_high[written] <= value_1[13:0];
            if (address_1[3:0] == 4'd11) first_f[written]      <= value_1;
            if (address_1[3:0] == 4'd12) shares[written]       <= value_1[16:0];
            if (address_1[3:0] == 4'd13) distances[written]    <= value_1[27:0];
            if (address_1[3:0] == 4'd14) {shifts[written], spheres[written]} <= value_1[4:0];
        end
    end

    // The next group of the frame. The walk through its cones, from the last cone to the first, begins when the walk of the previous
    // group ends and the FIFO of masks has a free entry.
    logic                  more, begins, room, walking, walked, fresh, done, holds, ends_line, ends_row;
    logic                  next_eye;
    logic [9:0]            next_row;
    logic [7:0]            next_column;
    logic [3:0]            walk;
    logic [GROUP_BITS-1:0] group, done_group;
    logic [ENTRY_BITS-1:0] walk_entry;
    logic [CONES-1:0]      mask;

    assign begins     = more && room && (!walking || walked);
    assign ends_line  = next_column == last_group;
    assign ends_row   = ends_line && (!STEREO || !stereo || next_eye);
    assign walked     = walk == '0;
    assign walk_entry = ENTRY_BITS'({group[GROUP_BITS-1], walk});
    assign holds      = columns[walk_entry][7:0] <= group[7:0] && group[7:0] <= columns[walk_entry][15:8]
                        && rows[walk_entry][9:0] <= group[17:8] && group[17:8] <= rows[walk_entry][19:10];

    always_ff @(posedge clk) begin
        if (begins) begin
            next_column <= ends_line ? '0 : next_column + 1'b1;
            if (ends_line) next_eye <= !ends_row;
            if (ends_row) next_row <= next_row + 1'b1;
            if (ends_row && next_row == last_row) more <= 1'b0;
            group <= {next_eye, next_row, next_column};
        end
        if (start) {more, next_eye, next_row, next_column} <= {1'b1, 19'd0};

        walking    <= begins || walking && !walked;
        fresh      <= begins;
        walk       <= begins ? STEREO && next_eye ? last_cone[1] : last_cone[0] : walk - 4'd1;
        mask       <= {fresh ? '0 : mask[CONES-2:0], holds};
        done       <= walking && walked;
        done_group <= group;
        if (rst) begin
            more    <= 1'b0;
            walking <= 1'b0;
            done    <= 1'b0;
        end
    end

    logic                  group_valid, takes;
    logic [GROUP_BITS-1:0] next_group;
    logic [CONES-1:0]      next_mask;

    /* verilator lint_off PINCONNECTEMPTY */
    credit_fifo #(.WIDTH(GROUP_BITS + CONES), .DEPTH(4)) masks (
        .clk, .rst, .idle(), .credit(room), .sent(more && (!walking || walked)), .in_valid(done), .in_data({done_group, mask}),
        .out_valid(group_valid), .out_ready(takes), .out_data({next_group, next_mask})
    );
    /* verilator lint_on PINCONNECTEMPTY */

    // The pixel whose jobs are sent, and the mask of its remaining cones; the cone with the lowest number is next.
    logic                  busy, credit, job_ends, sends, pixel_ends, group_ends;
    logic [GROUP_BITS-1:0] now;
    logic [2:0]            column;
    logic [CONES-1:0]      left, left_after, of_group, lowest;
    logic                  first;

    always_comb begin
        logic found;
        found = 1'b0;
        for (int i = 0; i < CONES; i++) begin
            left_after[i] = left[i] && found;
            lowest[i]     = left[i] && !found;
            found         = found || left[i];
        end
    end
    assign job_ends   = left_after == '0;
    assign sends      = busy && credit;
    assign pixel_ends = sends && job_ends;
    assign group_ends = pixel_ends && column == '1;
    assign takes      = group_valid && (!busy || group_ends);

    always_ff @(posedge clk) begin
        busy  <= takes || busy && !group_ends;
        first <= takes || pixel_ends || first && !sends;
        if (pixel_ends) column <= column + 1'b1;
        if (sends)      left   <= pixel_ends ? of_group : left_after;
        if (takes) begin
            now      <= next_group;
            of_group <= next_mask;
            left     <= next_mask;
            column   <= '0;
        end
        if (rst) busy <= 1'b0;
    end

    // A job: a cone and a pixel. The suffix of a name is the number of clocks after the job.
    logic [LAST:0]         valid;
    logic                  first_0, last_0, some_0, first_39, last_40, some_10;
    logic [ENTRY_BITS-1:0] entry_0, entry_1, entry_2, entry_3, entry_4, entry_5, entry_19, entry_32, entry_37;
    logic [10:0]           column_0, column_3;
    logic [9:0]            row_0, row_4;
    logic [16:0]           column_1, row_1, row_2, row_3;
    logic [3:0]            number;

    always_comb begin
        number = '0;
        for (int i = 0; i < CONES; i++) if (lowest[i]) number = number | 4'(i);
    end

    always_ff @(posedge clk) begin
        valid   <= {valid[LAST-1:0], sends};
        first_0 <= first;
        last_0  <= job_ends;
        some_0  <= left != '0;
        entry_0 <= ENTRY_BITS'({now[GROUP_BITS-1], number});
        {row_0, column_0} <= {now[GROUP_BITS-2:0], column};
        if (rst) valid <= '0;

        {entry_5, entry_4, entry_3, entry_2, entry_1} <= {entry_4, entry_3, entry_2, entry_1, entry_0};
        column_1 <= 17'(column_0) << {shifts[entry_0], 1'b0};
        row_1    <= 17'(row_0) << {shifts[entry_0], 1'b0};
        {row_3, row_2} <= {row_2, row_1};
    end

    delay #(.WIDTH(1), .CLOCKS(39)) first_waits (.clk, .enable(1'b1), .in(first_0), .out(first_39));
    delay #(.WIDTH(1), .CLOCKS(40)) last_waits (.clk, .enable(1'b1), .in(last_0), .out(last_40));
    delay #(.WIDTH(1), .CLOCKS(10)) some_waits (.clk, .enable(1'b1), .in(some_0), .out(some_10));
    delay #(.WIDTH(11), .CLOCKS(3)) column_waits (.clk, .enable(1'b1), .in(column_0), .out(column_3));
    delay #(.WIDTH(10), .CLOCKS(4)) row_waits (.clk, .enable(1'b1), .in(row_0), .out(row_4));
    delay #(.WIDTH(ENTRY_BITS), .CLOCKS(14)) entry_to_19 (.clk, .enable(1'b1), .in(entry_5), .out(entry_19));
    delay #(.WIDTH(ENTRY_BITS), .CLOCKS(13)) entry_to_32 (.clk, .enable(1'b1), .in(entry_19), .out(entry_32));
    delay #(.WIDTH(ENTRY_BITS), .CLOCKS(5)) entry_to_37 (.clk, .enable(1'b1), .in(entry_32), .out(entry_37));

    // The sides and the forward function, with 30 fraction bits.
    logic signed [47:0] a_4, a_5, b_5, b_6, f_6, f_7;

    multiply_add #(.BITS(48)) a_of_column (
        .clk, .enable(1'b1), .a(across_a[entry_1]), .b({1'b0, column_1}),
        .c({{2{first_a_high[entry_3][13]}}, first_a_high[entry_3], first_a_low[entry_3]}), .p(a_4)
    );
    multiply_add #(.BITS(48)) a_of_row (.clk, .enable(1'b1), .a(down_a[entry_2]), .b({1'b0, row_2}), .c(a_4), .p(a_5));
    multiply_add #(.BITS(48)) b_of_row (.clk, .enable(1'b1), .a(down_b[entry_3]), .b({1'b0, row_3}), .c(b_5), .p(b_6));
    multiply_add #(.BITS(48)) f_of_column (
        .clk, .enable(1'b1), .a(across_f[entry_3]), .b({7'd0, column_3}), .c(48'($signed(first_f[entry_5]))), .p(f_6)
    );
    multiply_add #(.BITS(48)) f_of_row (.clk, .enable(1'b1), .a(down_f[entry_4]), .b({8'd0, row_4}), .c(f_6), .p(f_7));

    // The kind of the entry, and the contribution of the column to side b, which is 0 without a solid cone.
    kind_t kind_6, kind_7, kind_10, kind_19, kind_38;

    if (CONE) begin : solid_cone
        (* ram_style = "distributed" *) logic [24:0] across_b [0:ENTRIES-1];
        (* ram_style = "distributed" *) logic [2:0]  kinds    [0:ENTRIES-1];
        logic [16:0] column_2;

        always_ff @(posedge clk) begin
            column_2 <= column_1;
            kind_6   <= kind_t'(kinds[entry_5]);
            kind_7   <= kind_6;
            if (write_1) begin
                if (address_1[3:0] == 4'd14) kinds[written]    <= value_1[7:5];
                if (address_1[3:0] == 4'd15) across_b[written] <= value_1[24:0];
            end
        end
        multiply_add #(.BITS(48)) b_of_column (
            .clk, .enable(1'b1), .a(across_b[entry_2]), .b({1'b0, column_2}),
            .c({{2{first_b_high[entry_4][13]}}, first_b_high[entry_4], first_b_low[entry_4]}), .p(b_5)
        );
        delay #(.WIDTH(3), .CLOCKS(3)) kind_to_10 (.clk, .enable(1'b1), .in(kind_7), .out({kind_10}));
        delay #(.WIDTH(3), .CLOCKS(9)) kind_to_19 (.clk, .enable(1'b1), .in(kind_10), .out({kind_19}));
        delay #(.WIDTH(3), .CLOCKS(19)) kind_to_38 (.clk, .enable(1'b1), .in(kind_19), .out({kind_38}));
    end else begin : no_cone
        assign b_5 = {{2{first_b_high[entry_5][13]}}, first_b_high[entry_5], first_b_low[entry_5]};
        assign {kind_6, kind_7, kind_10, kind_19, kind_38} = {5{SPHERE}};
        wire _unused = &{1'b0, kind_6, kind_7, kind_10, kind_19, kind_38};
    end

    // A pixel is outside of the cone if the magnitude of a side is 2 or more, or if the forward function is negative.
    logic over_6, over_7, out_8, out_10;

    always_ff @(posedge clk) begin
        over_6 <= a_5[47:31] != {17{a_5[31]}};
        over_7 <= over_6 || b_6[47:31] != {17{b_6[31]}};
        out_8  <= over_7 || f_7[31];
    end
    delay #(.WIDTH(1), .CLOCKS(2)) out_waits (.clk, .enable(1'b1), .in(out_8), .out(out_10));

    // The negated number whose root is to be computed, with 38 fraction bits.
    logic signed [42:0] square_8, square_9, square_10;

    square_add square_a (.clk, .x(a_5[31:8]), .c('0), .p(square_8));
    square_add square_b (.clk, .x(b_6[31:8] & {24{!CONE || kind_6 != LATERAL}}), .c(square_8), .p(square_9));
    square_add #(.NEGATIVE(1'b1)) square_f (.clk, .x(f_7[31:8] & {24{!CONE || kind_7 != AROUND}}), .c(square_9), .p(square_10));

    // The root, u1.22, of a square with 30 fraction bits. A square below 2^-20 counts as 0.
    logic [31:0] rest_10;
    logic [22:0] root_19;
    logic        hit_11, hit_38;

    // A smaller square is a miss for spheres only. Entries of the other kinds are met at any square above 0, and AROUND also at 0.
    logic around_10, meets_10;

    assign around_10 = CONE && kind_10 == AROUND;
    assign rest_10   = square_10[39:8] ^ {32{!around_10}};
    assign meets_10  = around_10 || square_10[42] && (rest_10[31:10] != '0 || CONE && kind_10 != SPHERE && rest_10[9:0] != '0);

    always_ff @(posedge clk) hit_11 <= some_10 && !out_10 && meets_10;

    exit_root rooting (.clk, .square(rest_10), .root(root_19));
    delay #(.WIDTH(1), .CLOCKS(27)) hit_waits (.clk, .enable(1'b1), .in(hit_11), .out(hit_38));

    // The divisor, u2.22, and its reciprocal. The divisor is rounded up, because the root is rounded down.
    logic [23:0]                      f_21;
    logic signed [43:0]               divisor_22;
    logic [22:0]                      mantissa_32;
    logic [4:0]                       scale_32;

    // Only the divisor of a solid cone may be negative.
    logic [23:0] addend_7;
    logic [17:0] share_19;
    logic        negative_38, ahead_38;

    if (CONE) begin : signed_divisor
        logic [23:0] b_7;
        logic        ahead_7;

        always_ff @(posedge clk) b_7 <= b_6[31:8];
        assign addend_7 = kind_7 == LATERAL ? b_7 : f_7[31:8];
        assign share_19 = kind_19 == AROUND ? -{1'b0, shares[entry_19]} : {1'b0, shares[entry_19]};
        assign ahead_7  = !f_7[31];
        delay #(.WIDTH(1), .CLOCKS(16)) sign_waits (.clk, .enable(1'b1), .in(divisor_22[43]), .out(negative_38));
        delay #(.WIDTH(1), .CLOCKS(31)) ahead_waits (.clk, .enable(1'b1), .in(ahead_7), .out(ahead_38));
    end else begin : positive_divisor
        assign addend_7    = f_7[31:8];
        assign share_19    = {1'b0, shares[entry_19]};
        assign negative_38 = 1'b0;
        assign ahead_38    = 1'b1;
    end

    delay #(.WIDTH(24), .CLOCKS(14)) f_waits (.clk, .enable(1'b1), .in(addend_7), .out(f_21));
    multiply_add #(.BITS(44)) divisor (
        .clk, .enable(1'b1), .a({2'b0, root_19}), .b(share_19), .c({{3{CONE && f_21[23]}}, f_21, 17'h1FFFF}), .p(divisor_22)
    );
    exit_mantissa reciprocal (.clk, .enable(1'b1), .whole({divisor_22[40:17], 4'b1000}), .mantissa(mantissa_32), .exponent(scale_32));

    // T: the distance times the reciprocal of a quarter of the divisor. The factor is the mantissa minus 1, which is signed.
    logic [23:0]        distance_32, distance_34;
    logic [3:0]         exponent_32;
    logic [5:0]         exponent_33;
    logic [4:0]         exponent_34, exponent_35;
    logic signed [43:0] product_35;

    assign {exponent_32, distance_32} = distances[entry_32];

    always_ff @(posedge clk) begin
        exponent_33 <= {1'b0, scale_32} + {2'b0, exponent_32};
        exponent_34 <= exponent_33[4:0] | {5{exponent_33[5]}};
        exponent_35 <= exponent_34;
    end
    delay #(.WIDTH(24), .CLOCKS(2)) distance_waits (.clk, .enable(1'b1), .in(distance_32), .out(distance_34));
    multiply_add #(.BITS(44)) quotient (
        .clk, .enable(1'b1), .a({1'b0, distance_32}), .b(mantissa_32[21:4]), .c({2'd0, distance_34, 18'd0}), .p(product_35)
    );

    // The product times 2^exponent, without its 30 lowest bits. Three clocks shift by multiples of 8, of 2, and by one bit; `over` is
    // high if T is too large.
    logic [81:0]                 shifted;
    logic [63:23]                middle;
    logic [57:23]                coarse_36;
    logic [57:29]                fine_37;
    logic [2:0]                  exponent_36;
    logic                        exponent_37, over_36, over_37, over_38;
    logic [exit_pkg::T_BITS-1:0] t_38;

    assign shifted = {39'd0, product_35[42:0]} << {exponent_35[4:3], 3'd0};
    assign middle  = {6'd0, coarse_36} << {exponent_36[2:1], 1'b0};

    always_ff @(posedge clk) begin
        coarse_36   <= shifted[57:23];
        over_36     <= shifted[81:58] != '0;
        exponent_36 <= exponent_35[2:0];
        fine_37     <= middle[57:29];
        over_37     <= over_36 || middle[63:58] != '0;
        exponent_37 <= exponent_36[0];
        t_38        <= exponent_37 ? fine_37[56:29] : fine_37[57:30];
        over_38     <= over_37 || exponent_37 && fine_37[57];
    end

    // The nearest of the ray's cones so far; of several cones at the same T, the cone of the first job.
    logic [2:0]                  number_38, number_39, best_number;
    logic                        hit_39, best_met, from_met, better;
    logic [exit_pkg::T_BITS-1:0] t_39, best_t, from_t;

    logic met_38, between_39;

    if (CONE) begin : faces
        // The T of the base's plane, saturated to the largest T, is the lower or the upper limit of T of the other faces.
        logic                        is_plane_39, is_face_39, is_base_39, is_least;
        logic [exit_pkg::T_BITS-1:0] plane_39, limit, from_limit;

        assign met_38 = hit_38 && kind_38 != LIMIT && (kind_38 == SECTION || !over_38 && !negative_38 && t_38 >= near_limit);

        always_ff @(posedge clk) begin
            is_base_39  <= kind_38 == BASE;
            is_plane_39 <= kind_38 == BASE || kind_38 == LIMIT;
            is_face_39  <= kind_38 == LATERAL || kind_38 == AROUND || kind_38 == SECTION;
            plane_39    <= t_38 | {exit_pkg::T_BITS{over_38 || !ahead_38}};
            if (valid[39]) begin
                is_least <= is_plane_39 ? is_base_39 : is_least && !first_39;
                limit    <= is_plane_39 ? plane_39 : from_limit;
            end
        end
        assign from_limit = limit | {exit_pkg::T_BITS{first_39}};
        assign between_39 = !is_face_39 || (is_least && !first_39 ? t_39 > from_limit : t_39 < from_limit);
    end else begin : spheres_alone
        assign met_38     = hit_38 && !over_38 && t_38 >= near_limit;
        assign between_39 = 1'b1;
        wire _unused = &{1'b0, negative_38, ahead_38};
    end

    assign from_met = best_met && !first_39;
    assign from_t   = first_39 ? far_limit : best_t;
    assign better   = hit_39 && between_39 && {t_39, 1'b0} < {from_t, !from_met};

    always_ff @(posedge clk) begin
        number_38 <= spheres[entry_37];

        number_39 <= number_38;
        hit_39    <= met_38;
        t_39      <= CONE && kind_38 == SECTION ? near_limit : t_38;

        if (valid[39]) begin
            best_met    <= better || from_met;
            best_t      <= better ? t_39 : from_t;
            best_number <= better ? number_39 : best_number;
        end
    end

    /* verilator lint_off PINCONNECTEMPTY */
    credit_fifo #(.WIDTH(exit_pkg::MEETING_BITS), .DEPTH(64)) results (
        .clk, .rst, .idle(), .credit, .sent(busy && job_ends), .in_valid(valid[LAST] && last_40), .in_data({best_met, best_number, best_t}),
        .out_valid, .out_ready, .out_data(out_meeting)
    );
    /* verilator lint_on PINCONNECTEMPTY */

    wire _unused = &{1'b0, address_1[8:7], rows[walk_entry], f_7[47:32], a_5[7:0], b_6[7:0], f_7[7:0], square_10[41:40],
                     square_10[7:0], divisor_22[43:41], divisor_22[16:0],
                     mantissa_32[22], mantissa_32[3:0], product_35[43], shifted[22:0], middle[28:23]};
endmodule

`default_nettype wire

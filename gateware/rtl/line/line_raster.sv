// Draws the pieces of lines that are in a band (docs/formats/line.md, "Lines"): converts a piece to groups of eight pixels, in each of
// which one pixel is covered.
//
//   piece ─▶ walk: one pixel per clock ─▶ code, 5 * line ─▶ * stride / 5 + column ─▶ pipeline_fifo ─▶ group
//                   ▲                                                                    │
//                   └────────────────────────────── room ────────────────────────────────┘
//
// A group is {row = address in the band buffer, line, column, mask, code and colour of its only pixel}, see band_buffer. A piece ends with
// its last pixel, with its last pixel in the band, or one clock after the line has left the picture. The next piece begins in the next
// clock.
//
// Streams are valid/ready. The stages after the walk cannot be stopped; the walk stops while the FIFO cannot hold all pixels in these
// stages. Latency 5 clocks, throughput one pixel per clock. `size` and `first_row`, the size code of the picture and the first row of the
// band, must hold while the module contains pieces. If memory is damaged and a piece leaves the band, only its pixels in the band are
// drawn. `idle` is low from the clock after a piece is taken until its last group is taken.

`default_nettype none

module line_raster (
    input  wire                    clk,
    input  wire                    rst,
    input  wire  [1:0]             size,
    input  wire  [9:0]             first_row,
    output logic                   idle,
    input  wire                    in_valid,
    output logic                   in_ready,
    input  wire records_pkg::piece_t  in_piece,
    output logic                   group_valid,
    input  wire                    group_ready,
    output logic [10:0]            group_row,
    output logic [5:0]             group_line,
    output logic [7:0]             group_column,
    output logic [7:0]             group_mask,
    output logic [17:0]            group_code,
    output logic [15:0]            group_colour
);
    logic [5:0]     last_line;
    logic [4:0]     blocks;
    band_pkg::cut_t cut;

    // Values derived from `size`, which must not change while pieces are drawn. The width of the picture is 64 times `blocks`.
    always_ff @(posedge clk) begin
        cut       <= band_pkg::cut(size);
        last_line <= cut.lines - 1'b1;
    end

    assign blocks = cut.stride[7:3];

    // State of the piece at its current pixel; only `error` belongs to the next pixel.
    logic               active, x_major, left, up;
    logic [15:0]        colour;
    logic [11:0]        column;
    logic [11:0]        not_count; // complement of the number of remaining pixels: counting up takes fewer LUTs
    logic [5:0]         line;
    logic signed [20:0] error, fall;
    logic [19:0]        minor;
    logic signed [33:0] depth, depth_step;

    logic room, fifo_idle, moves_minor, moves_column, moves_line, shown, ends, takes;

    assign moves_minor  = !error[20];
    assign moves_column = x_major || moves_minor;
    assign moves_line   = !x_major || moves_minor;
    assign shown    = !column[11] && column[10:6] < blocks && line <= last_line;
    assign ends     = !shown || not_count == ~12'd1 || moves_line && line == (up ? '0 : last_line);
    assign in_ready = room && (!active || ends);
    assign takes    = in_valid && in_ready;

    always_ff @(posedge clk) begin
        if (room && active) begin
            not_count <= not_count + 1'b1;
            error     <= error + (moves_minor ? fall : {1'b0, minor});
            depth     <= depth + depth_step;
            column    <= column + ({12{left}} & {12{moves_column}} | 12'(moves_column));
            line      <= line + ({6{up}} & {6{moves_line}} | 6'(moves_line));
            active    <= !ends;
        end
        if (takes) begin
            active     <= 1'b1;
            not_count  <= ~in_piece.count;
            error      <= in_piece.error;
            depth      <= in_piece.depth;
            column     <= {1'b0, in_piece.column};
            line       <= in_piece.row[5:0] - first_row[5:0];
            x_major    <= in_piece.x_major;
            left       <= in_piece.left;
            up         <= in_piece.up;
            fall       <= in_piece.fall;
            minor      <= in_piece.minor;
            depth_step <= in_piece.depth_step;
            colour     <= in_piece.colour;
        end
        if (rst) active <= 1'b0;
    end

    typedef struct packed {
        logic [5:0]  line;
        logic [7:0]  column;
        logic [17:0] code;
        logic [15:0] colour;
    } pixel_t;

    typedef struct packed {
        logic [10:0] row;
        logic [7:0]  mask;
        pixel_t      pixel;
    } group_t;

    logic [2:1]  valid;
    pixel_t      pixel;
    logic [2:0]  lane;
    logic [8:0]  line_times_5;
    logic [10:0] line_row;
    group_t      made, group;

    always_comb begin
        if (cut.stride[7])      line_row = {line_times_5[5:0], 5'd0};
        else if (cut.stride[6]) line_row = {line_times_5[6:0], 4'd0};
        else                    line_row = {line_times_5[7:0], 3'd0};
    end

    always_ff @(posedge clk) begin
        valid <= {valid[1], room && active && shown};

        pixel.line   <= line;
        pixel.column <= column[10:3];
        pixel.colour <= colour;
        lane         <= column[2:0];
        line_times_5 <= {1'b0, line, 2'd0} + 9'(line);
        // The depth code is clamped to the range from 1 to its largest value.
        pixel.code   <= depth[31:14] | {18{depth[32]}} | 18'(depth[31:15] == '0);
        if (depth[33]) pixel.code <= 18'd1;

        made.pixel <= pixel;
        made.row   <= line_row + 11'(pixel.column);
        made.mask  <= 8'd1 << lane;
        if (rst) valid <= '0;
    end

    pipeline_fifo #(.WIDTH($bits(made)), .DEPTH(16), .FLIGHT(2), .DIRECT(1'b1)) pipeline_fifo (
        .clk, .rst, .idle(fifo_idle), .room, .in_valid(valid[2]), .in_data(made),
        .out_valid(group_valid), .out_ready(group_ready), .out_data(group)
    );

    assign idle = !active && valid == '0 && fifo_idle;

    assign group_row    = group.row;
    assign group_mask   = group.mask;
    assign group_line   = group.pixel.line;
    assign group_column = group.pixel.column;
    assign group_code   = group.pixel.code;
    assign group_colour = group.pixel.colour;

    wire _unused = &{1'b0, first_row[9:6], in_piece.row[9:6], line_times_5[8], depth[13:0], cut.last_band, cut.stride[2:0], cut.rows};
endmodule

`default_nettype wire

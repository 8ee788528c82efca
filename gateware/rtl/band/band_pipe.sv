// Draws groups of eight pixels into the band buffer's memories: reads the row of the group, compares the depth codes, and writes
// the lanes (pixels) that pass the depth test.
//
//   groups ─▶ issue ─▶ ┄┄┄┄┄┄┄┄ band_bank's read ┄┄┄┄┄┄┄┄ ─▶ compare ─▶ ┄┄ band_bank's write ┄┄
//             read_row    reading[0]      reading[1]         write_*
//
// A lane is written if its mask bit is set and its depth code is at least the stored one; the stored code of a pixel not yet
// written in this band is 0. For two eyes, a group writes only one byte of each colour word, for the view of one eye; such a group
// has no depth test. Latency 3 clocks from `read_row` to `write_*`; throughput one group per clock.
//
// Hazard: a group must not read a lane before an earlier group has written it. A group that shares a row and a lane with one
// of the three groups before it is held until at least four clocks after that group. Groups that share a row but no lane, as
// neighbouring triangles do along their common edge, pass without a stall, because each lane is a separate memory.
//
// With BLEND a pixel can be blended with the stored colour of its place, in three steps. First, a group with `group_asks` has a depth test,
// but writes nothing. 4 clocks after its `read_row`, `answer_lanes` (valid with `answer_valid`) is the mask of the lanes that pass. Then
// the blended pixels arrive as groups with `group_blended`, whose lanes are written without a depth test. The stored depth code stays; the
// depth code of a pixel not yet written becomes 0. No other groups may arrive in between, so the blended pixels, each in a different lane,
// are not held. The sky is written in the same way, in groups of eight pixels.
//
// The input is a valid/ready stream; `group_ready` comes from registers and from `open`, which admits groups. `empty` is high when no group
// is in the pipeline; a read of a row then returns the pixels of all accepted groups.

`default_nettype none

module band_pipe #(
    parameter int unsigned ROW_BITS = 11,
    parameter bit          BLEND    = 1'b0
) (
    input  wire                 clk,
    input  wire                 rst,
    input  wire                 open,
    // Groups.
    input  wire                 group_valid,
    output logic                group_ready,
    input  wire  [ROW_BITS-1:0] group_row,
    input  wire  [7:0]          group_mask,
    input  wire  [1:0]          group_halves,
    input  wire  [8*18-1:0]     group_codes,
    input  wire  [8*16-1:0]     group_colours,
    input  wire                 group_asks,
    input  wire                 group_blended,
    output logic                answer_valid,
    output logic [7:0]          answer_lanes,
    // Memory ports. The depth codes `stored` and the written bits `stored_written` belong to the `read_row` of 3 clocks ago.
    output logic [ROW_BITS-1:0] read_row,
    input  wire  [8*18-1:0]     stored,
    input  wire  [7:0]          stored_written,
    output logic [ROW_BITS-1:0] write_row,
    output logic [7:0]          write_lanes,
    // The lanes of `write_lanes` whose depth codes are written.
    output logic [7:0]          write_depths,
    output logic [1:0]          write_halves,
    output logic [8*18-1:0]     write_codes,
    output logic [8*16-1:0]     write_colours,
    // Lanes that pass the depth test, of a group that is written or asks for these lanes.
    output logic [7:0]          drawn_lanes,
    // State.
    output logic                empty,
    output logic                held
);
    // The row and mask of a group in the pipe, with which later groups are compared, and its pixels.
    typedef struct packed {
        logic [ROW_BITS-1:0] row;
        logic [7:0]          mask;
    } place_t;

    typedef struct packed {
        logic [1:0]          halves;
        logic [8*18-1:0]     codes;
        logic [8*16-1:0]     colours;
    } pixels_t;

    place_t     issued, reading_0, reading_1, compared;
    pixels_t    pixels, comparing;
    logic       issued_valid, issue;
    logic [2:0] occupied;
    // Thermometer code of the clocks that the issued group still has to wait. Only a valid group waits. `codes_held` equals bit 0, for the
    // depth codes alone; it depends on itself, because synthesis would otherwise merge both.
    logic [2:0] hold;
    (* keep *) logic codes_held;

    assign held        = hold[0];
    assign issue       = issued_valid && !held;
    assign group_ready = open && !held;
    assign read_row    = issued.row;
    assign empty       = !issued_valid && occupied == '0;

    // Compares the group at the input with the earlier groups before it is accepted, so that `group_ready` does not depend on the
    // comparison. A stage without a group has an empty mask, so it never conflicts.
    logic conflict_issued, conflict_0, conflict_1;
    assign conflict_issued = issued_valid && group_row == issued.row && (group_mask & issued.mask) != '0;
    assign conflict_0      = group_row == reading_0.row && (group_mask & reading_0.mask) != '0;
    assign conflict_1      = group_row == reading_1.row && (group_mask & reading_1.mask) != '0;

    always_ff @(posedge clk) begin
        hold <= hold >> 1;
        if (group_valid && group_ready) begin
            if (conflict_issued) hold <= 3'b111;
            else if (conflict_0) hold <= 3'b011;
            else if (conflict_1) hold <= 3'b001;
        end
        codes_held <= group_valid && open && !codes_held ? conflict_issued || conflict_0 || conflict_1 : hold[1];
        // The registers also load their inputs if no group is valid, so that their enable depends only on the register `hold`.
        if (!held) begin
            issued_valid <= group_valid && open;
            issued       <= {group_row, group_mask};
            {pixels.halves, pixels.colours} <= {group_halves, group_colours};
        end
        if (!codes_held) pixels.codes <= group_codes;

        reading_0 <= issued;
        if (!issue) reading_0.mask <= '0;
        reading_1 <= reading_0;
        compared  <= reading_1;
        occupied  <= {occupied[1:0], issue};

        if (rst) begin
            issued_valid   <= 1'b0;
            hold           <= '0;
            codes_held     <= 1'b0;
            occupied       <= '0;
            reading_0.mask <= '0;
            reading_1.mask <= '0;
            compared.mask  <= '0;
        end
    end

    // Lanes that pass the depth test.
    logic [7:0] passing;

    for (genvar lane = 0; lane < 8; lane++) begin : lanes
        assign passing[lane] = compared.mask[lane]
            && (comparing.halves != '1 || !stored_written[lane] || comparing.codes[18*lane +: 18] >= stored[18*lane +: 18]);
    end

    if (BLEND) begin : blend
        // Whether the group in each stage asks, and whether it is a blended pixel.
        logic [3:0] asks, blended;

        always_ff @(posedge clk) begin
            if (!held) {asks[0], blended[0]} <= {group_asks, group_blended};
            asks[3:1]    <= asks[2:0];
            blended[3:1]   <= blended[2:0];
            answer_valid <= asks[3] && compared.mask != '0 && !rst;
            answer_lanes <= passing;
        end

        // The code of a blended pixel becomes 0 in the output register of its delay.
        wide_delay #(.WIDTH($bits(pixels.codes)), .CLOCKS(3)) codes_wait (.clk, .zero(blended[2]), .in(pixels.codes), .out(comparing.codes));
        wide_delay #(.WIDTH($bits(pixels) - $bits(pixels.codes)), .CLOCKS(3)) pixels_wait (
            .clk, .zero(1'b0), .in({pixels.halves, pixels.colours}), .out({comparing.halves, comparing.colours})
        );

        assign write_lanes  = blended[3] ? compared.mask : asks[3] ? '0 : passing;
        assign write_depths = blended[3] ? compared.mask & ~stored_written : asks[3] ? '0 : passing;
        assign drawn_lanes  = blended[3] ? '0 : passing;
    end else begin : plain
        wide_delay #(.WIDTH($bits(pixels)), .CLOCKS(3)) pixels_wait (.clk, .zero(1'b0), .in(pixels), .out(comparing));

        assign write_lanes  = passing;
        assign write_depths = passing;
        assign drawn_lanes  = passing;

        assign {answer_valid, answer_lanes} = '0;

        wire _unused = &{1'b0, group_asks, group_blended};
    end

    assign write_row     = compared.row;
    assign write_halves  = comparing.halves;
    assign write_codes   = comparing.codes;
    assign write_colours = comparing.colours;
endmodule

`default_nettype wire

// Computes the direction D of the ray of each pixel of a frame, one per clock (docs/formats/raymarch.md, "Rays").
//
//   columns, lines ─▶ D = first + x·across + y·down, exactly, by 32-bit additions
//
// Pixels are output band by band, each band line by line from the top, each line from the left. With `stereo` each line is output first for
// the left eye, then for the right eye.
//
// `start` (one clock, not while `busy`) begins the frame; the parameters must hold until the frame has ended. `valid` is high in each clock
// with a pixel; a pixel needs a `credit`. `busy` falls after the last pixel. `rst` ends the frame.

`default_nettype none

module ray_pixels #(
    parameter bit STEREO = 1'b1
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       start,
    output logic                      busy,
    // Frame: numbers of its last column, of the last line of a band, and of its last band, counted from 0.
    input  wire  [10:0]               last_column,
    input  wire  [5:0]                last_line,
    input  wire  [5:0]                last_band,
    input  wire                       stereo,
    input  wire  [1:0][2:0][31:0]     first,
    input  wire  [2:0][31:0]          across,
    input  wire  [2:0][31:0]          down,
    // Pixels. `running` is high while pixels are left.
    input  wire                       credit,
    output logic                      running,
    output logic                      valid,
    output raymarch_pkg::place_t      place,
    output logic [2:0][27:0]          direction
);
    logic             starts, begins, loads, fresh, ends_line, ends_eye, ends_band, ends;
    logic [5:0]       band;
    logic [2:0][31:0] d, inverted_row, inverted_start;

    assign ends_line = place.column == last_column;
    assign ends_eye  = ends_line && (!STEREO || !stereo || place.eye);
    assign ends_band = ends_eye && place.line == last_line;
    assign ends      = ends_band && band == last_band;
    assign valid     = running && credit;
    assign busy      = starts || begins || running;

    // `inverted_row` is ~(y·down). `inverted_start` is ~D at the first column of the next line (of the right eye if `next_eye` is high),
    // and is computed as `inverted_row` minus `first`. The complements turn the sum D into a subtraction: Yosys puts the selection of the
    // subtracted value into the LUTs of the subtraction, but uses separate LUTs for the selection of a summand. `inverted_row` and
    // `inverted_start` are computed in the first two clocks of a line (`fresh` is high in the first), so a line must have at least three
    // columns.
    logic next_eye;

    assign next_eye = STEREO && stereo && !place.eye && !starts;
    assign loads    = begins || valid && ends_line;

    always_ff @(posedge clk) begin
        starts <= start;
        begins <= starts;
        fresh  <= loads;
        if (start)                   inverted_row <= '1;
        else if (fresh && !next_eye) for (int i = 0; i < 3; i++) inverted_row[i] <= inverted_row[i] - down[i];
        for (int i = 0; i < 3; i++) begin
            inverted_start[i] <= inverted_row[i] - first[next_eye][i];
            if (loads)      d[i] <= ~inverted_start[i];
            else if (valid) d[i] <= d[i] + across[i];
        end
        if (start) begin
            place <= '0;
            band  <= '0;
        end
        if (begins) running <= 1'b1;
        if (valid) begin
            place.column <= ends_line ? '0 : place.column + 1'b1;
            if (ends_line) place.eye <= !ends_eye;
            if (ends_eye) place.line <= ends_band ? '0 : place.line + 1'b1;
            if (ends_band) begin
                place.odd <= !place.odd;
                band      <= band + 1'b1;
            end
            if (ends) running <= 1'b0;
        end

        if (rst) begin
            starts  <= 1'b0;
            begins  <= 1'b0;
            running <= 1'b0;
        end
    end

    always_comb
        for (int i = 0; i < 3; i++) direction[i] = d[i][30:3];

    wire _unused = &{1'b0, d[0][31], d[0][2:0], d[1][31], d[1][2:0], d[2][31], d[2][2:0]};
endmodule

`default_nettype wire

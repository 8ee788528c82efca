// The texels of a step: their colours, in the order that filtering needs.
//
//   values of quarters ─┬─▶ palettes ──────────────▶ colours ─▶ of each neighbour
//                       └─▶ transparent? ─▶ quarter of each neighbour ──┘
//
// A transparent neighbour takes the colour of the nearest texel. Latency 3 clocks; the pipeline cannot be stopped.

`default_nettype none

module texture_texels (
    input  wire                        clk,
    input  wire  [1:0]                 format,
    input  wire                        cut_out,
    input  wire  [15:0]                key,
    input  wire                        palette_write,
    input  wire  [7:0]                 palette_index,
    input  wire  [15:0]                palette_colour,
    // Indices: copy, quarter, as in texture_store.
    input  wire  [1:0][3:0][15:0]      in_values,
    input  wire  [1:0][15:0]           in_seconds,
    // One clock later: the quarter of each neighbour. With nearest filtering, the first neighbour is the texel.
    input  wire  [1:0][3:0][1:0]       in_quarters,
    input  wire  [1:0][1:0]            in_nearest,  // the neighbour that is the nearest texel
    output logic [1:0][3:0][15:0]      out_neighbours,
    output logic [1:0][15:0]           out_seconds,
    output logic [1:0]                 out_opaque,  // of the nearest texel
    output logic [1:0]                 out_seconds_opaque
);
    logic is_colour;

    assign is_colour = format == 2'd0;

    logic [1:0][3:0]       transparent; // copy, quarter
    logic [1:0]            seconds_transparent, opaque, seconds_opaque;
    logic [1:0][15:0]      second_palette, late_seconds;
    logic [1:0][3:0][15:0] values, palette, colours;
    logic [1:0][15:0]      seconds;
    logic [1:0][3:0][1:0]  quarters;
    logic [1:0][1:0]       nearest;

    for (genvar j = 0; j < 2; j++) begin : copies
        logic seconds_low, seconds_high;

        equal #(.WIDTH(8)) low (.a(in_seconds[j][7:0]), .b(key[7:0]), .same(seconds_low));
        equal #(.WIDTH(8)) high (.a(in_seconds[j][15:8]), .b(key[15:8]), .same(seconds_high));

        assign nearest[j] = in_quarters[j][in_nearest[j]];

        for (genvar q = 0; q < 4; q++) begin : each_quarter
            logic same_low, same_high;

            equal #(.WIDTH(8)) low (.a(in_values[j][q][7:0]), .b(key[7:0]), .same(same_low));
            equal #(.WIDTH(8)) high (.a(in_values[j][q][15:8]), .b(key[15:8]), .same(same_high));

            always_ff @(posedge clk) begin
                quarters[j][q]       <= transparent[j][in_quarters[j][q]] ? nearest[j] : in_quarters[j][q];
                transparent[j][q]    <= cut_out && same_low && (!is_colour || same_high);
                colours[j][q]        <= is_colour ? values[j][q] : palette[j][q];
                out_neighbours[j][q] <= colours[j][quarters[j][q]];
            end
        end

        for (genvar k = 0; k < 2; k++) begin : palettes
            texture_palette colours_of (
                .clk, .write(palette_write), .write_index(palette_index), .write_colour(palette_colour),
                .first(in_values[j][2*k][7:0]), .second(in_values[j][2*k+1][7:0]),
                .first_colour(palette[j][2*k]), .second_colour(palette[j][2*k+1])
            );
        end

        always_ff @(posedge clk) begin
            opaque[j]              <= !transparent[j][nearest[j]];
            seconds_transparent[j] <= cut_out && seconds_low && (!is_colour || seconds_high);
            seconds_opaque[j]      <= !seconds_transparent[j];
            late_seconds[j]        <= is_colour ? seconds[j] : second_palette[j];
        end
    end

    texture_palette of_seconds (
        .clk, .write(palette_write), .write_index(palette_index), .write_colour(palette_colour),
        .first(in_seconds[0][7:0]), .second(in_seconds[1][7:0]), .first_colour(second_palette[0]), .second_colour(second_palette[1])
    );

    always_ff @(posedge clk) begin
        values             <= in_values;
        seconds            <= in_seconds;
        out_seconds        <= late_seconds;
        out_opaque         <= opaque;
        out_seconds_opaque <= seconds_opaque;
    end
endmodule

`default_nettype wire

// Stores the blocks of the cache: writes the words of a missing block, and reads the texels of a step (texture_pkg::step_t).
//
//   head of the queue ─▶ addresses ─▶ two copies of four quarters ─▶ texels
//
// A quarter contains the texels whose columns have one parity and whose rows have one parity, in the layout of the words in memory. With
// nearest filtering, each copy serves two pixels, one on each port. With bilinear filtering, each copy serves one pixel, whose four
// neighbours are in different quarters or are the same texel. A fill writes a word to both copies; each port writes one half of each
// quarter.
//
// Latency 4 clocks from the head to the texels, throughput one step or word per clock. Outputs: from the first port the values of all
// quarters, from the second port the value of the quarter that contains the pixel's texel. Bits 15:8 of a value are only used for RGB565
// colours, and bits 7:4 are zero for indices of 16 colours.

`default_nettype none

module texture_store (
    input  wire                         clk,
    input  wire  [1:0]                  format,
    input  wire                         bilinear,
    input  wire                         fills,
    input  wire  [1:0]                  fill_class,
    input  wire                         fill_second,
    input  wire  [127:0]                data,
    input  wire  [1:0][3:0]             parity,      // axis, slot
    input  wire  [3:0][2:0]             x,
    input  wire  [3:0][2:0]             y,
    input  wire  [3:0][6:0]             places,      // in the cache, by class
    output logic [1:0][3:0][15:0]       out_values,  // copy, quarter
    output logic [1:0][15:0]            out_seconds  // copy
);
    // A word of memory contains 32 bits for each quarter: two halves, of which a port reads one. A half has two bytes, a byte two digits of
    // four bits.
    localparam int unsigned ADDRESS_BITS = 11;

    logic         is_colour, is_digit, write;
    logic [127:0] filled;

    assign is_colour = format == 2'd0;
    assign is_digit  = format[1];

    always_ff @(posedge clk) begin
        filled <= data;
        write  <= fills;
    end

    // The position of a texel in its block. The row selects the half for indices of 16 colours, and the column for the other formats.
    logic [3:0] word, half_across, half_down, byte_of, digit;

    for (genvar i = 0; i < 4; i++) begin : slots
        assign word[i]        = is_digit ? y[i][2] : y[i][1];
        assign half_across[i] = is_colour ? x[i][1] : x[i][2];
        assign half_down[i]   = y[i][1];
        assign byte_of[i]     = !is_colour && (is_digit ? x[i][2] : x[i][1]);
        assign digit[i]       = is_digit && x[i][1];
    end

    function automatic logic [15:0] value(input logic [15:0] half, input logic second_byte, input logic second_digit, input logic digits);
        logic [7:0] of_byte;

        of_byte = second_byte ? half[15:8] : half[7:0];
        value   = {half[15:8], digits ? 4'd0 : of_byte[7:4], second_digit ? of_byte[7:4] : of_byte[3:0]};
    endfunction

    logic [1:0][3:0][15:0] firsts, seconds; // copy, quarter: what the ports read

    for (genvar j = 0; j < 2; j++) begin : copies
        localparam int unsigned LOWER = 2 * j, UPPER = 2 * j + 1;

        // The second port.
        logic [1:0]              class_of, quarter_1, quarter_2, quarter_3;
        logic [3:0]              bytes, digits; // of steps that were at the head 1 to 4 clocks ago
        logic [ADDRESS_BITS-1:0] address;
        logic [15:0]             second;

        assign class_of = fills ? fill_class : {parity[1][UPPER], parity[0][UPPER]};

        always_ff @(posedge clk) begin
            address   <= {class_of, places[class_of], fills ? fill_second : word[UPPER],
                          fills || (is_digit ? half_down[UPPER] : half_across[UPPER])};
            quarter_1 <= {y[UPPER][0], x[UPPER][0]};
            quarter_2 <= quarter_1;
            quarter_3 <= quarter_2;
            bytes     <= {bytes[2:0], byte_of[UPPER]};
            digits    <= {digits[2:0], digit[UPPER]};
            second    <= seconds[j][quarter_3];
        end

        assign out_seconds[j] = value(second, bytes[3], digits[3], is_digit);

        // The first port: a quarter reads the neighbour whose column and row have the parities of the quarter.
        for (genvar q = 0; q < 4; q++) begin : quarters
            logic                    right, below;
            logic [2:0]              first_bytes, first_digits;
            logic [1:0]              first_class;
            logic [ADDRESS_BITS-1:0] first_address;

            assign right       = bilinear && x[LOWER][0] != 1'(q % 2);
            assign below       = bilinear && y[LOWER][0] != 1'(q / 2);
            assign first_class = fills ? fill_class : {parity[1][below ? UPPER : LOWER], parity[0][right ? UPPER : LOWER]};

            always_ff @(posedge clk) begin
                first_address <= {first_class, places[first_class], fills ? fill_second : word[below ? UPPER : LOWER],
                                  !fills && (is_digit ? half_down[below ? UPPER : LOWER] : half_across[right ? UPPER : LOWER])};
                first_bytes   <= {first_bytes[1:0], byte_of[right ? UPPER : LOWER]};
                first_digits  <= {first_digits[1:0], digit[right ? UPPER : LOWER]};
            end

            texture_memory #(.ADDRESS_BITS(ADDRESS_BITS)) memory (
                .clk, .write, .first(first_address), .second(address), .in(filled[32*q +: 32]),
                .first_out(firsts[j][q]), .second_out(seconds[j][q])
            );

            always_ff @(posedge clk) out_values[j][q] <= value(firsts[j][q], first_bytes[2], first_digits[2], is_digit);
        end
    end
endmodule

`default_nettype wire

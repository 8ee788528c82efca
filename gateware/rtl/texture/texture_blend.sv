// Blends the pixels of groups with the colours behind them, which the band buffer stores (docs/formats/texture.md, "Blending").
//
//   group ─▶ asks the band buffer ─▶ answer: lanes that pass ─▶ one lane per clock ─▶ source, behind ─▶ blend ─▶ pixel
//
// A group with `in_blend` 0 passes unchanged. Any other group is first sent to the band buffer with `out_asks` high. The answer is the mask
// of the lanes that pass the depth test. Each pixel of these lanes is then blended, and sent as a group of one pixel, with `out_blended`
// high; the band buffer always accepts it. `lane` selects the colour `behind`, which arrives one clock later. The group itself is taken in
// the clock of its last pixel, or, if no lane passes, two clocks after the answer. The other fields of a group do not pass through this
// module. Throughput: a group of which n pixels pass takes n + 8 clocks, from its first clock to the first clock of the next group; a group
// of which no pixel passes takes 9.

`default_nettype none

module texture_blend (
    input  wire              clk,
    input  wire              rst,
    input  wire              in_valid,
    output logic             in_ready,
    // 1 to 7: opacity of the group in eighths. 8 and above: the sum of both colours.
    input  wire  [3:0]       in_blend,
    input  wire  [7:0]       in_mask,
    input  wire  [7:0][15:0] in_colours,
    output logic             out_valid,
    input  wire              out_ready,
    output logic [7:0]       out_mask,
    output logic [7:0][15:0] out_colours,
    output logic             out_asks,
    output logic             out_blended,
    input  wire              answer_valid,
    input  wire  [7:0]       answer_lanes,
    output logic [2:0]       lane,
    input  wire  [15:0]      behind
);
    // The blended pixel, valid for one clock. `gone` is high in the clock of the group's last pixel.
    logic        is_blended, asks, gone, pixel_valid;
    logic [7:0]  pixel_mask;
    logic [15:0] pixel_colour;

    assign is_blended  = in_blend != '0;
    assign out_valid   = is_blended ? asks || pixel_valid : in_valid;
    assign in_ready    = is_blended ? gone : out_ready;
    assign out_mask    = pixel_valid ? pixel_mask : in_mask;
    assign out_colours = pixel_valid ? {8{pixel_colour}} : in_colours;
    assign out_asks    = is_blended && !pixel_valid;
    assign out_blended = pixel_valid;

    typedef enum logic [1:0] {ASK, ANSWER, PICK, END} state_t;
    state_t state;

    // The lanes that are not picked yet, the lowest of these lanes, and whether at most one lane is left.
    logic [7:0] left, lowest;
    logic       is_last;

    assign asks    = in_valid && is_blended && state == ASK;
    assign lowest  = left & (~left + 1'b1);
    assign is_last = left == lowest;

    always_comb begin
        lane[0] = |(lowest & 8'b1010_1010);
        lane[1] = |(lowest & 8'b1100_1100);
        lane[2] = |(lowest & 8'b1111_0000);
    end

    // The picked pixel.
    logic        picked_valid, picked_last;
    logic [7:0]  picked;
    logic [15:0] source;
    // `keep` prevents synthesis from merging the two selections: the selection of one of four lanes takes one LUT per bit.
    (* keep *) logic [1:0][15:0] colours;

    for (genvar half = 0; half < 2; half++) begin : halves
        assign colours[half] = in_colours[4*half + 32'(lane[1:0])];
    end

    always_ff @(posedge clk) begin
        case (state)
            ASK:     if (asks && out_ready) state <= ANSWER;
            ANSWER:  if (answer_valid) state <= PICK;
            PICK:    if (is_last) state <= END;
            default: if (gone) state <= ASK;
        endcase

        left         <= state == ANSWER ? answer_lanes : left ^ lowest;
        picked_valid <= state == PICK && left != '0;
        picked_last  <= state == PICK && is_last;
        picked       <= lowest;
        source       <= lane[2] ? colours[1] : colours[0];
        pixel_valid  <= picked_valid;
        pixel_mask   <= picked;
        gone         <= picked_last;

        if (rst) begin
            state        <= ASK;
            picked_valid <= 1'b0;
            picked_last  <= 1'b0;
            pixel_valid  <= 1'b0;
            gone         <= 1'b0;
        end
    end

    // Blue, green and red. Each bit of the opacity selects one of the two colours, with the weight of the bit. The sum of these terms, and
    // of the colour behind once more, is the blended colour in eighths.
    for (genvar channel = 0; channel < 3; channel++) begin : channels
        localparam int unsigned LOW  = channel == 0 ? 0 : channel == 1 ? 5 : 11;
        localparam int unsigned BITS = channel == 1 ? 6 : 5;

        logic [BITS-1:0] over, under, blended;
        logic [BITS:0]   ones;
        logic [BITS+2:0] sum;

        assign over  = source[LOW +: BITS];
        assign under = behind[LOW +: BITS];
        assign ones  = {1'b0, under} + {1'b0, in_blend[0] || in_blend[3] ? over : under};
        assign sum   = {2'b0, ones} + {2'b0, in_blend[1] ? over : under, 1'b0} + {1'b0, in_blend[2] ? over : under, 2'b0}
                     + (BITS+3)'(4);

        always_ff @(posedge clk) blended <= in_blend[3] ? ones[BITS-1:0] | {BITS{ones[BITS]}} : sum[BITS+2:3];

        assign pixel_colour[LOW +: BITS] = blended;

        wire _unused = &{1'b0, sum[2:0]};
    end
endmodule

`default_nettype wire

// Divides items into steps. The pixels of a step need blocks in at most two neighbouring block columns and two neighbouring block rows, one
// even and one odd of each, so a step looks up at most one block of each class.
//
//   item ─▶ which slots are in the same block column or row ─▶ FIFO ─▶ first pixels that fit together ─▶ step
//                                                                            ▲       │ the others
//                                                                            └───────┘
//
// The first waiting pixel is always in the step. Any other waiting pixel is in the step if each of its slots is in the same block column
// and block row as the first waiting slot of equal parity. While items are waiting, a step is sent in each clock with `step_room`. Latency
// 2 clocks, throughput one step per clock.
//
// Items come from a pipeline that cannot be stopped. As in credit_fifo, `sent` is high for one clock for each item that enters the
// pipeline. A pipeline of more than 28 clocks would have to wait for credits. The first of two items in successive clocks
// enters only while `credit` is high, the second item even if `credit` is low. `busy` is high while an item is in the pipeline or in this
// module.

`default_nettype none

module texture_choice (
    input  wire                    clk,
    input  wire                    rst,
    input  wire  [1:0]             format,
    input  wire                    bilinear,
    output logic                   busy,
    output logic                   credit,
    input  wire                    sent,
    input  wire                    in_valid,
    input  texture_pkg::item_t     in_item,
    input  wire                    step_room,
    output logic                   out_valid,
    output texture_pkg::step_t     out_step,
    // Columns and rows of the step's slots, without their lowest two bits.
    output logic [1:0][3:0][7:0]   out_places,
    output logic [3:0]             out_level
);
    localparam int unsigned ITEMS = 32;

    // A block has four or eight columns, and four or eight rows.
    logic [1:0]      wide;
    // Indices: axis, then the slot, or the pair of slots in the order 01, 02, 12, 03, 13, 23. `differ`: both slots of a pair have the same
    // parity, but are in different block columns or rows. `same`: they are in the same block column or row.
    logic [1:0][3:0] parity, item_parity;
    logic [1:0][5:0] differ, same, item_differ;
    logic [1:0][2:0] item_same;   // 02, 03, 13
    logic [1:0][3:0][6:0] rests;

    assign wide = {format[1], format != 2'd0};

    for (genvar axis = 0; axis < 2; axis++) begin : compared
        for (genvar i = 0; i < 4; i++) begin : slots
            assign parity[axis][i] = wide[axis] ? in_item.texels[axis][i][3] : in_item.texels[axis][i][2];
            assign rests[axis][i]  = {!wide[axis] && in_item.texels[axis][i][3], in_item.texels[axis][i][9:4]};
        end
        for (genvar j = 1; j < 4; j++) begin : seconds
            for (genvar i = 0; i < j; i++) begin : firsts
                localparam int unsigned PAIR = j * (j - 1) / 2 + i;
                logic equal_rests;

                equal #(.WIDTH(7)) compared (.a(rests[axis][i]), .b(rests[axis][j]), .same(equal_rests));

                assign differ[axis][PAIR] = parity[axis][i] == parity[axis][j] && !equal_rests;
                assign same[axis][PAIR]   = parity[axis][i] == parity[axis][j] && equal_rests;
            end
        end
    end

    // The fields that determine the pixels of a step are in the output register of the FIFO `fits`; the other fields are read from LUT
    // memory.
    localparam int unsigned FITS_BITS = 4 + 2 * (4 + 6 + 3);

    logic               ends, item_valid, items_room, fits_room, fits_valid, more;
    logic [3:0]         mask, waiting, rest, left, served;
    texture_pkg::item_t item;

    fifo #(.WIDTH($bits(in_item)), .DEPTH(ITEMS), .DIRECT(1'b1)) items (
        .clk, .rst, .in_valid, .in_ready(items_room), .in_data(in_item), .out_valid(item_valid), .out_ready(ends), .out_data(item)
    );

    fifo #(.WIDTH(FITS_BITS), .DEPTH(ITEMS)) fits (
        .clk, .rst, .in_valid, .in_ready(fits_room),
        .in_data({in_item.mask, parity, differ, same[1][4:3], same[1][1], same[0][4:3], same[0][1]}),
        .out_valid(fits_valid), .out_ready(ends), .out_data({mask, item_parity, item_differ, item_same})
    );

    // Number of free FIFO entries. `credit` requires two free entries, because a quad may consist of two items.
    typedef logic [$clog2(ITEMS + 1)-1:0] count_t;
    count_t credits;

    assign credit = credits > count_t'(1);

    always_ff @(posedge clk) begin
        credits <= credits - count_t'(sent) + count_t'(ends);
        busy    <= sent || credits != count_t'(ITEMS);
        if (rst) begin
            credits <= count_t'(ITEMS);
            busy    <= 1'b0;
        end
    end

    assign out_valid = fits_valid && step_room;
    assign waiting   = more ? rest : mask;
    assign left      = waiting & ~served;
    assign ends      = out_valid && left == '0;

    // For each axis and slot: whether the slot is in the same block column or row as the first waiting slot of equal parity.
    logic [2:0]      slots;
    logic [1:0][3:1] fit;

    assign slots = bilinear ? {waiting[1], {2{waiting[0]}}} : waiting[2:0];

    for (genvar axis = 0; axis < 2; axis++) begin : fitting
        logic [5:0] d;
        logic [2:0] s;

        assign d            = item_differ[axis];
        assign s            = item_same[axis];
        assign fit[axis][1] = !(slots[0] && d[0]);
        assign fit[axis][2] = slots[0] && s[0] || !(slots[0] && d[1]) && !(slots[1] && d[2]);
        assign fit[axis][3] = slots[0] && s[1] || !(slots[0] && d[3]) && (slots[1] && s[2] || !(slots[1] && d[4]) && !(slots[2] && d[5]));
    end

    logic [3:1] both;

    assign both      = fit[0] & fit[1];
    assign served[0] = waiting[0];
    assign served[1] = waiting[1] && (bilinear ? both[2] && both[3] : both[1]);
    assign served[2] = waiting[2] && both[2];
    assign served[3] = waiting[3] && both[3];

    always_ff @(posedge clk) begin
        if (out_valid) begin
            rest <= left;
            more <= left != '0;
        end
        if (rst) more <= 1'b0;
    end

    assign out_level = item.level;

    always_comb begin
        out_step.served  = served;
        out_step.half    = item.half;
        out_step.last    = item.last && left == '0;
        out_step.second  = item.second;
        out_step.weights = item.weights;
        out_step.upper   = item.upper;
        out_step.parity  = item_parity;
        for (int i = 0; i < 4; i++) begin
            out_step.x[i]    = item.texels[0][i][2:0];
            out_step.y[i]    = item.texels[1][i][2:0];
            out_places[0][i] = item.texels[0][i][9:2];
            out_places[1][i] = item.texels[1][i][9:2];
        end
    end

    wire _unused = &{1'b0, items_room, fits_room, item_valid, item.mask, same};
endmodule

`default_nettype wire

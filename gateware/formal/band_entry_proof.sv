// Proof of band_entry, which places each triangle at its first row in a band, with any pattern of valid and ready on its input
// and output. Triangles are numbered, and every field of a triangle contains its number. Each triangle with a row in its band is output
// once, in order, with all its fields and computed results; a triangle without such a row is never output. Every wait of a triangle is
// bounded. A bit of `holds` is high while a triangle with a row in its band is inside the module.

`default_nettype none

module band_entry_proof (
    input wire clk,
    input wire in_valid,
    input wire in_odd,
    // High when the triangle has a row in its band.
    input wire in_kept,
    input wire out_ready
);
    localparam int unsigned BITS = 4;

    logic rst = 1'b1;
    always_ff @(posedge clk) rst <= 1'b0;

    logic            in_ready, out_valid, out_odd, taken, goes, right, late_right;
    logic [1:0]      holds;
    logic [BITS-1:0] kept = '0, went = '0, number;
    logic [BITS-1:0] in_band_0 = '0, in_band_1 = '0;
    logic [3:0]      unseen = '0, refused = '0;

    // The triangle at the output in the previous clock, whose late fields are valid now.
    logic            was_valid = 1'b0, was_odd;
    logic [BITS-1:0] was_number;

    records_pkg::descriptor_t descriptor;
    raster_pkg::placed_t       placed;
    raster_pkg::placed_late_t  late;

    // Triangles without a row in their band have the number `'1`, which must never reach the output.
    assign number = in_kept ? kept : '1;

    always_comb begin
        descriptor              = '0;
        descriptor.colour       = {11'd0, in_odd, number};
        descriptor.group_start  = {4'd0, number};
        descriptor.group_left   = {4'd1, number};
        descriptor.group_right  = {4'd2, number};
        descriptor.top          = in_kept ? 10'd8 : 10'd2;
        descriptor.bottom       = in_kept ? 10'd9 : 10'd3;
        descriptor.depth_start  = {28'd3, number};
        descriptor.depth_step_x = {28'd4, number};
        descriptor.depth_step_y = {28'd5, number};
        for (int k = 0; k < 3; k++) begin
            descriptor.start[k] = {28'd0, 2'(k), number};
            descriptor.steps[k] = {15'd6, 2'(k), number, 15'd7, 2'(k), number};
        end
    end

    always_comb begin
        right = placed.group_start == {4'd0, went} && placed.group_left == {4'd1, went}
             && placed.group_right == {4'd2, went} && placed.rows == 6'd1;
        late_right = late.colour == {11'd0, was_odd, was_number} && late.depth == {28'd3, was_number} + 32'd8192
                  && late.depth_step_x == {28'd4, was_number} && late.depth_step_y == {28'd5, was_number} && late.line == '0;
        for (int k = 0; k < 3; k++)
            if (placed.best[k] != {28'd0, 2'(k), went} || placed.beside_fails[k]
                || placed.slope[k] != {14'd7, 2'(k), went} || placed.step_y[k] != {15'd6, 2'(k), went}
                || !placed.rises[k] || placed.falls[k]) right = 1'b0;
    end

    band_entry dut (
        .clk, .rst, .rows(6'd12), .holds,
        .in_valid, .in_ready, .in_y0(10'd8), .in_odd, .in_descriptor(descriptor),
        .out_valid, .out_ready, .out_odd, .out_triangle(placed), .out_late(late)
    );

    stream_checker #(.WIDTH(2), .GIVEN(1)) given (
        .clk, .rst, .valid(in_valid), .ready(in_ready), .data({in_kept, in_odd})
    );
    // Checking these fields of the output is enough: the module loads all fields of a triangle at once.
    stream_checker #(.WIDTH(9)) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data({out_odd, placed.group_start})
    );

    assign taken = in_valid && in_ready;
    assign goes  = out_valid && out_ready;

    always_ff @(posedge clk) if (!rst) begin
        if (taken && in_kept) kept <= kept + 1'b1;
        if (goes)             went <= went + 1'b1;
        {was_valid, was_odd, was_number} <= {out_valid, out_odd, went};
        in_band_0 <= in_band_0 + BITS'(taken && in_kept && !in_odd) - BITS'(goes && !out_odd);
        in_band_1 <= in_band_1 + BITS'(taken && in_kept && in_odd) - BITS'(goes && out_odd);
        unseen    <= kept != went && !out_valid ? unseen + 1'b1 : '0;
        refused   <= in_valid && !in_ready && !(out_valid && !out_ready) ? refused + 1'b1 : '0;

        assume (kept != '1);
        nothing_made_up:  assert (!out_valid || kept != went);
        in_order:         assert ((!out_valid || right) && (!was_valid || late_right));
        nothing_too_many: assert (kept - went <= BITS'(3));
        held_is_told:     assert ((holds[0] || in_band_0 == '0) && (holds[1] || in_band_1 == '0));
        shown_in_time:    assert (unseen < 4'd13);
        taken_in_time:    assert (refused < 4'd8);

        three_inside:      cover (kept - went == BITS'(3) && !in_ready);
        both_bands:        cover (holds == 2'b11 && out_valid && out_odd);
        drawn_after_drop:  cover (in_valid && in_ready && !in_kept && went == BITS'(1));
    end
endmodule

`default_nettype wire

// Proof that the ray generator outputs the rays of a small frame for any pattern of `out_ready`. Each ray is output once, in order,
// unchanged while it waits, and in time. Rays leave empty prisms; reciprocals and quotients are arbitrary.

`default_nettype none

module ray_generator_proof (
    input wire clk,
    input wire out_ready
);
    localparam int unsigned COLUMNS = 3;

    logic rst = 1'b1, start = 1'b0, begun = 1'b0;

    always_ff @(posedge clk) begin
        rst   <= 1'b0;
        start <= rst;
        begun <= begun || start;
    end

    // The frame has one eye or two eyes, one or two bands, and one or two lines per band.
    (* anyconst *) logic stereo, two_lines, two_bands;

    logic               busy, out_valid, ends_eye, ends_band;
    exit_pkg::ray_t     ray;
    raymarch_pkg::place_t its_place;

    assign its_place = ray.place;

    ray_generator #(.PLACES(4)) dut (
        .clk, .rst, .start, .busy, .last_column(11'(COLUMNS - 1)), .last_line({5'd0, two_lines}), .last_band({5'd0, two_bands}),
        .stereo, .exits(1'b1), .first('0), .across('0), .down('0), .near_limit('0), .far_limit('1), .choice('0), .distances('0), .there('0), .away('0), .last('0), .nexts('0),
        .diagonals(1'b0), .sum_distances('0), .sum_there('0), .sum_away('0), .out_valid, .out_ready, .out_ray(ray)
    );

    stream_checker #(.WIDTH($bits(ray))) shown (
        .clk, .rst, .valid(out_valid), .ready(out_ready), .data(ray)
    );

    // The position of the next ray.
    raymarch_pkg::place_t place = '0;
    logic                 finished = 1'b0, was_finished = 1'b0;
    logic [5:0]           unseen = '0;

    assign ends_eye  = place.column == 11'(COLUMNS - 1) && (place.eye || !stereo);
    assign ends_band = ends_eye && place.line == {5'd0, two_lines};

    always_ff @(posedge clk) if (!rst) begin
        if (out_valid && out_ready) begin
            place.column <= place.column == 11'(COLUMNS - 1) ? '0 : place.column + 1'b1;
            if (place.column == 11'(COLUMNS - 1)) place.eye <= stereo && !place.eye;
            if (ends_eye) place.line <= ends_band ? '0 : place.line + 1'b1;
            if (ends_band) place.odd <= !place.odd;
            if (ends_band && place.odd == two_bands) finished <= 1'b1;
        end
        was_finished <= finished;
        unseen <= begun && !finished && !out_valid ? unseen + 1'b1 : '0;

        nothing_made_up:   assert (!out_valid || begun && !finished);
        in_order:          assert (!out_valid || its_place == place);
        busy_to_the_end:   assert (busy || !begun || finished);
        idle_afterwards:   assert (!busy || !was_finished);
        shown_in_time:     assert (unseen < 6'd30);

        all_came: cover (finished && !busy);
        // Rays enter the pipeline while credits are left, one for each place of the FIFO after the pipeline.
        waits:    cover (begun && out_valid && !out_ready && place.column == 11'd1 && stereo);
    end
endmodule

`default_nettype wire

// Determines which hits on faces are in the shadow of the first light (docs/raymarch-exits.md, "Shadows").
//
//         ┌─ hit on a face that the light shines on ─▶ origin ─▶ exit_lane ─┐
//   ends ─┤                                                                 ├─▶ ends
//         └─ any other end ─▶ skid_buffer ──────────────────────────────────┘
//
// For a hit on a face that the light shines on, a second ray is sent from the face to the light. The hit is in the shadow if this ray hits
// the solid. The field `height` of a hit becomes 1 in the shadow and 0 in the light. Ends may overtake each other. The light is infinitely
// far away, so all rays to it have the same direction, and the magnitudes of its components and their reciprocals are constants of the
// frame.
//
// The distance of the face's plane from the solid's lower corner is a multiple of 2^9 units of 2^-12. The hit has rounded coordinates and
// is therefore moved onto this plane, so that the ray starts in the empty interval before the face. In repeated solids the origin is moved
// to the equivalent position in the middle cell.
//
// Throughput one end per clock, and one evaluation per clock; latency 2 clocks without a ray to the light. Streams are valid/ready. Parameters
// hold while ends are inside. `rst` discards all ends.

`default_nettype none

module exit_shadow #(
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1,
    // Number of low bits of an end that the build uses.
    parameter int unsigned KEPT_BITS = exit_pkg::FLAT_END_BITS
) (
    input  wire                                        clk,
    input  wire                                        rst,
    input  wire exit_pkg::solid_t                      solid,
    input  wire raymarch_registers_pkg::shadow_t       shadow,
    // Ends.
    input  wire                                        in_valid,
    output logic                                       in_ready,
    input  wire exit_pkg::end_t                        in_end,
    // Ends in light and shadow.
    output logic                                       out_valid,
    input  wire                                        out_ready,
    output exit_pkg::end_t                             out_end,
    // Events.
    output logic                                       evaluates,
    output logic                                       waits
);
    // The direction to the light, and whether the solid is repeated; registered, because these signals have many loads.
    exit_pkg::ray_t ray;
    logic [2:0]     down;
    logic           is_repeated, enable;

    for (genvar i = 0; i < 3; i++) begin : directions
        logic [15:0] part;
        logic [14:0] size;

        assign part = shadow.direction[16*i +: 16];
        assign size = part[15] ? -part[14:0] : part[14:0];

        always_ff @(posedge clk) begin
            ray.speed[i]   <= {size, 8'd0};
            ray.inverse[i] <= shadow.inverse[32*i +: 32];
            down[i]        <= part[15];
        end
    end

    always_ff @(posedge clk) begin
        enable      <= shadow.enable;
        is_repeated <= solid.rule == exit_pkg::CUBES;
    end

    assign ray.down           = down;
    assign ray.sphere         = '0;
    assign ray.inverse_square = '0;
    assign ray.length         = '0;
    assign ray.down_sum       = 1'b0;
    assign ray.over           = 1'b0;
    assign ray.place          = '0;
    assign ray.start          = '0;
    assign ray.axis           = 2'd2;
    assign ray.reached        = '0;
    assign ray.height         = '0;

    // Whether the next end needs a ray to the light.
    logic                 wants, lane_ready, pass_ready;
    logic [KEPT_BITS-1:0] kept;

    assign wants    = enable && in_end.hit && !in_end.round && in_end.axis != 2'd3 && in_end.positive != down[in_end.axis];
    assign in_ready = wants ? lane_ready : pass_ready;

    // The origin of this ray, relative to the solid's centre.
    logic [2:0][exit_pkg::PLANE_BITS-1:0] origin;

    for (genvar i = 0; i < 3; i++) begin : axes
        logic [exit_pkg::SPOT_BITS-1:0]  at, place;
        logic [exit_pkg::PLANE_BITS-1:0] half;
        logic                            mirrored;

        assign at       = in_end.spot.at[i];
        assign mirrored = in_end.spot.down[i];
        assign half     = exit_pkg::PLANE_BITS'(solid.half[i]);

        always_comb begin
            place = at;
            if (in_end.axis == 2'(i)) place = {at[exit_pkg::SPOT_BITS-1:9] + (exit_pkg::SPOT_BITS-9)'(at[8]), 9'd0};
            if (is_repeated) place[exit_pkg::SPOT_BITS-1] = 1'b0;
        end

        assign origin[i] = (mirrored ? half : exit_pkg::PLANE_BITS'(place)) + ~(mirrored ? exit_pkg::PLANE_BITS'(place) : half) + 1'b1;
    end

    // Rays to the light carry their end.
    logic                               found_valid, passed_valid;
    exit_pkg::end_t                     found, ending;
    logic [exit_pkg::FLAT_END_BITS-1:0] carried;

    exit_lane #(
        .LEVELS(LEVELS), .BOXES(BOXES), .STEREO(1'b0), .CARRIED(exit_pkg::FLAT_END_BITS)
    ) lane (
        .clk, .rst, .origins('0), .solid, .far_t(~(exit_pkg::T_BITS)'(1)), .in_valid(in_valid && wants), .in_ready(lane_ready),
        .in_ray(ray), .in_origin(origin), .in_carried(in_end[exit_pkg::FLAT_END_BITS-1:0]),
        .out_valid(found_valid), .out_ready(out_ready && is_found), .out_end(found), .out_carried(carried), .evaluates, .waits
    );

    skid_buffer #(.WIDTH(KEPT_BITS)) passing (
        .clk, .rst, .in_valid(in_valid && !wants), .in_ready(pass_ready), .in_data(in_end[KEPT_BITS-1:0]),
        .out_valid(passed_valid), .out_ready(out_ready && !is_found), .out_data(kept)
    );

    // Ends of rays to the light have priority, but an end that is already offered at the output stays there until it is taken.
    logic is_found, was_found, stays;

    assign is_found  = stays ? was_found : found_valid;
    assign out_valid = found_valid || passed_valid;
    assign ending    = is_found ? exit_pkg::END_BITS'(carried) : exit_pkg::END_BITS'(kept);

    always_ff @(posedge clk) begin
        was_found <= is_found;
        stays     <= out_valid && !out_ready && !rst;
    end

    always_comb begin
        out_end = ending;
        if (is_found || ending.hit) out_end.height = {7'd0, is_found && found.hit};
    end

    wire _unused = &{1'b0, found, ending, in_end};
endmodule

`default_nettype wire

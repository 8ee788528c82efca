// The distance field of a lane: a sponge or a box, and spheres, joined by a fillet.
//
// Latency raymarch_pkg::field_clocks(LEVELS), throughput one point per clock, no handshake. `solid` must hold during a frame.
//
// Spheres are evaluated one after the other: a point passes through the unit once for each sphere. `pass` is the number of the sphere, and
// must arrive one clock before the point. `so_far` is the nearest sphere in the earlier passes of the point; `nearest` also includes the
// sphere of this pass. The distance is valid in the last pass. `surface` is the number of the nearest sphere, `face` the surface of the
// flat field, and `share` the weight of the sphere's colour.

`default_nettype none

module field_unit #(
    // Levels of the sponge, 0 for a build without sponges, and whether there are boxes.
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b1
) (
    input  wire                     clk,
    input  wire raymarch_registers_pkg::solid_t solid,
    input  wire                     sphere_write,
    input  wire  [2:0]              sphere_number,
    input  wire raymarch_registers_pkg::sphere_t sphere,
    input  wire  [2:0]              pass,
    input  wire  [2:0][21:0]        point,
    input  wire raymarch_pkg::nearest_t so_far,
    output logic signed [21:0]      distance,
    output logic [2:0]              surface,
    output logic [2:0]              face,
    output logic [7:0]              share,
    output raymarch_pkg::nearest_t     nearest
);
    localparam int unsigned FLAT_CLOCKS = raymarch_pkg::flat_clocks(LEVELS);
    // KNOWN: clock in which the nearest sphere is valid. BOTH: first clock in which the nearest sphere and the distance to the flat field
    // are both valid.
    localparam int unsigned KNOWN = 19;
    localparam int unsigned BOTH  = FLAT_CLOCKS > KNOWN ? FLAT_CLOCKS : KNOWN;

    logic signed [21:0]     flat_distance, flat_distance_both, distance_18;
    logic [2:0]             flat_surface, flat_surface_both, pass_18;
    raymarch_pkg::nearest_t so_far_18, known, nearest_both;

    if (LEVELS != 0) begin : menger
        field_menger #(.LEVELS(LEVELS), .BOX(BOXES)) flat (
            .clk, .levels(solid.levels[LEVELS-1:0]), .half(solid.half), .point, .distance(flat_distance), .surface(flat_surface)
        );
    end else begin : box
        field_box flat (.clk, .half(solid.half), .point, .distance(flat_distance), .surface(flat_surface));
    end

    field_sphere field (.clk, .sphere_write, .sphere_number, .sphere, .number(pass), .point, .distance(distance_18));
    delay #(.WIDTH(3), .CLOCKS(KNOWN)) number (.clk, .enable(1'b1), .in(pass), .out(pass_18));
    delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(KNOWN - 1)) others (.clk, .enable(1'b1), .in(so_far), .out(so_far_18));

    always_ff @(posedge clk) known <= distance_18 < $signed(so_far_18.distance) ? {distance_18, pass_18} : so_far_18;

    if (BOTH > KNOWN) begin : wait_for_flat
        delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(BOTH - KNOWN)) waiting (
            .clk, .enable(1'b1), .in(known), .out(nearest_both)
        );
    end else begin : sphere_at_once
        assign nearest_both = known;
    end

    if (BOTH > FLAT_CLOCKS) begin : wait_for_spheres
        delay #(.WIDTH(25), .CLOCKS(BOTH - FLAT_CLOCKS)) waiting (
            .clk, .enable(1'b1), .in({flat_distance, flat_surface}), .out({flat_distance_both, flat_surface_both})
        );
    end else begin : flat_at_once
        assign {flat_distance_both, flat_surface_both} = {flat_distance, flat_surface};
    end

    blend_unit blend (
        .clk, .solid, .flat_distance(flat_distance_both), .flat_surface(flat_surface_both), .known(nearest_both), .distance, .surface, .face,
        .share, .nearest
    );

    wire _unused = &{1'b0, solid};
endmodule

`default_nettype wire

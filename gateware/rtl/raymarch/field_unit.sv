// The distance field of a lane: computes all fields of the build in parallel, and selects one of their distances by `solid`.
//
// Latency raymarch_pkg::field_clocks(LEVELS, FIELDS, ROUND, BLEND), throughput one point per clock, no handshake. `solid` must
// hold during a frame. A field that is not in the build takes no LUTs; a single field needs no multiplexer.
//
// Spheres are evaluated one after the other, one in each pass of a point. `pass` is the number of the sphere, and must arrive one clock
// before the point. `so_far` is the nearest sphere in the earlier passes of the point; `nearest` also includes the sphere of this pass. The
// distance is valid in the last pass; it is the distance to the nearest sphere or to the flat field. BLEND requires spheres and a flat
// field, and adds a fillet between them. With a fillet `round` is high, `face` is the surface of the flat field, and `share` is the weight
// of the sphere's colour. Without a fillet `share` is all ones.

`default_nettype none

module field_unit #(
    // LEVELS: levels of the Menger sponge, 0 for a build without it. FIELDS: a bit for each flat field of the build, by its
    // number. ROUND: spheres. BLEND: fillets.
    parameter int unsigned LEVELS = 4,
    parameter int unsigned FIELDS = 1,
    parameter bit          ROUND  = 1'b0,
    parameter bit          BLEND  = 1'b0
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
    output logic                    round,
    output logic [2:0]              surface,
    output logic [2:0]              face,
    output logic [7:0]              share,
    output raymarch_pkg::nearest_t     nearest
);
    localparam int unsigned FLAT_CLOCKS = fields_pkg::flat_clocks(LEVELS, FIELDS);
    localparam bit          FLAT        = FIELDS != 0;

    logic signed [21:0] flat_distance;
    logic [2:0]         flat_surface;

    if (FLAT) begin : flat
        flat_fields #(.LEVELS(LEVELS), .FIELDS(FIELDS)) fields (.clk, .solid, .point, .distance(flat_distance), .surface(flat_surface));
    end else begin : no_flat
        assign flat_distance = '0;
        assign flat_surface  = '0;
    end

    if (ROUND) begin : spheres
        // KNOWN: clock in which the nearest sphere is valid. BOTH: first clock in which the nearest sphere and the distance to the flat
        // field are both valid.
        localparam int unsigned KNOWN = 19;
        localparam int unsigned BOTH  = FLAT_CLOCKS > KNOWN ? FLAT_CLOCKS : KNOWN;

        logic signed [21:0]  distance_18;
        logic [2:0]          pass_18;
        raymarch_pkg::nearest_t so_far_18, known, nearest_both;

        field_sphere field (
            .clk, .repeated(solid.spheres_repeated), .sphere_write, .sphere_number, .sphere, .number(pass), .point, .distance(distance_18)
        );
        delay #(.WIDTH(3), .CLOCKS(KNOWN)) number (.clk, .enable(1'b1), .in(pass), .out(pass_18));
        delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(KNOWN - 1)) others (.clk, .enable(1'b1), .in(so_far), .out(so_far_18));

        always_ff @(posedge clk) known <= distance_18 < $signed(so_far_18.distance) ? {distance_18, pass_18} : so_far_18;

        if (BOTH > KNOWN) begin : wait_for_flat
            delay #(.WIDTH(raymarch_pkg::NEAREST_BITS), .CLOCKS(BOTH - KNOWN)) waiting (
                .clk, .enable(1'b1), .in(known), .out(nearest_both)
            );
        end else begin : at_once
            assign nearest_both = known;
        end

        if (FLAT) begin : both
            logic signed [21:0] flat_distance_both;
            logic [2:0]         flat_surface_both;

            if (BOTH > FLAT_CLOCKS) begin : wait_for_spheres
                delay #(.WIDTH(25), .CLOCKS(BOTH - FLAT_CLOCKS)) waiting (
                    .clk, .enable(1'b1), .in({flat_distance, flat_surface}), .out({flat_distance_both, flat_surface_both})
                );
            end else begin : at_once
                assign {flat_distance_both, flat_surface_both} = {flat_distance, flat_surface};
            end

            logic is_nearer, takes_round;

            assign is_nearer   = $signed(nearest_both.distance) < flat_distance_both;
            assign takes_round = solid.is_round && (!solid.flat_too || is_nearer);

            if (BLEND) begin : fillet
                blend_unit blend (
                    .clk, .solid, .flat_distance(flat_distance_both), .flat_surface(flat_surface_both), .known(nearest_both),
                    .takes_round, .distance, .round, .surface, .face, .share, .nearest
                );
            end else begin : sharp
                always_ff @(posedge clk) begin
                    distance <= takes_round ? nearest_both.distance : flat_distance_both;
                    surface  <= takes_round ? nearest_both.number : flat_surface_both;
                    round    <= takes_round;
                    nearest  <= nearest_both;
                end
                assign face  = '0;
                assign share = '1;
            end
        end else begin : only_spheres
            assign {distance, surface} = nearest_both;
            assign round               = 1'b1;
            assign face                = '0;
            assign share               = '1;
            assign nearest             = nearest_both;
        end
    end else begin : only_flat
        assign distance = flat_distance;
        assign surface  = flat_surface;
        assign round    = 1'b0;
        assign face     = '0;
        assign share    = '1;
        assign nearest  = '0;
    end

    wire _unused = &{1'b0, solid, flat_distance, flat_surface, sphere_write, sphere_number, sphere, pass, so_far};
endmodule

`default_nettype wire

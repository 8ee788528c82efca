// The raymarcher: computes the pixels of a field (docs/formats/raymarch.md), band by band, for the band buffer. A band is a horizontal
// strip of the picture.
//
//                    ┌─▶ lane ─┐            ┌──────────────────┐
//   ray_generator ───┼─▶ lane ─┼─▶ ends ─┬──┴▶ ray_paint ─▶ groups of one pixel
//                    └─▶ ...  ─┘         └▶ waiting ─┘
//                                     of the next band
//
// Each lane has an exit_lane, which finds the ends of rays by exits; the first lane also has a ring_lane, which finds the ends of marching
// rays. A build contains only the kinds of lanes that its fields need; `exits` selects the kind for a frame.
//
// `start` (one clock, not while `busy`) begins a frame; its parameters must hold until the frame has ended. The pixels of a
// band are sent while `band_open` is high, in any order, each pixel once, or with `stereo` once for each eye. `band_done` is
// high when all pixels of the band have been taken. `band_next` (one clock, only while `band_done` is high) then ends the band
// and begins the next one; after the last band it ends the frame.
//
// While the last rays of a band are still in the lanes, up to EARLY rays of the next band already enter the lanes. The ends of these early
// rays wait in a FIFO in block RAM. The lanes therefore have empty slots only at the end of the frame, or when the rays at the end of a
// band need very different numbers of evaluations.
//
// With ROUND a field may have spheres, and with BLEND fillets between the spheres and flat surfaces. The generator intersects rays by
// exits with the spheres of a list, before the rays enter a lane; with LATTICE, a lane also finds hits on spheres of a lattice.
// round_light then precedes ray_paint, and takes one clock per pass for a pixel on a sphere or fillet: with NORMALS one for each axis,
// then one for each light, and with HIGHLIGHT one for a highlight.
//
// Each lane makes one evaluation of the field per clock; marching rays use only the first lane.
// `restart` and reset cancel the frame. Groups are a valid/ready stream, whose payload holds until
// the transfer. `events` holds the increment of each counter in this clock.

`default_nettype none

module raymarcher #(
    parameter int unsigned LANES  = 2,
    parameter int unsigned LEVELS = 6,
    parameter int unsigned FIELDS = fields_pkg::ALL,
    parameter bit          ROUND   = 1'b1,
    parameter bit          LATTICE = 1'b1,
    parameter bit          BLEND   = 1'b1,
    parameter bit          STEREO  = 1'b1,
    parameter bit          NORMALS   = 1'b1,
    parameter bit          HIGHLIGHT = 1'b1,
    parameter bit          CONE      = 1'b1,
    parameter bit          SHADOW    = 1'b1,
    // A power of two.
    parameter int unsigned EARLY   = BLEND ? 1024 : 512
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       restart,
    input  wire                       start,
    output logic                      busy,
    // Parameters of the frame. `size` is 0 for 320x180, 1 for 640x360 and 2 for 1280x720.
    input  wire  [1:0]                size,
    input  wire                       stereo,
    // Whether colours are dithered.
    input  wire                       dither,
    input  wire                       exits,
    // Rays of both eyes, the left eye first, and the limits of their parameters T.
    input  wire  [1:0][2:0][31:0]     first,
    input  wire  [2:0][31:0]          across,
    input  wire  [2:0][31:0]          down,
    input  wire  [exit_pkg::T_BITS-1:0] near_limit,
    input  wire  [exit_pkg::T_BITS-1:0] far_limit,
    // Positions of both eyes.
    input  wire  [1:0][2:0][24:0]     origins,
    // Rays by exits: the solid (exit_pkg::solid_t), and for both eyes and both directions along each axis the prism around the eye
    // (exit_start).
    input  wire  [1:0]                rule,
    input  wire  [2:0]                levels,
    input  wire  [2:0][exit_pkg::HALF_BITS-1:0]               halves,
    input  wire  [2:0][exit_pkg::BORDER_BITS-1:0]             borders,
    input  wire  [1:0][1:0]                choice,
    input  wire  [1:0][1:0][2:0][exit_pkg::PLANE_BITS-1:0]   distances,
    input  wire  [1:0][1:0][2:0]      there,
    input  wire  [1:0][1:0][2:0]      away,
    input  wire  [1:0][1:0][2:0]      last,
    input  wire  [1:0][1:0][2:0][exit_pkg::INTERVAL_BITS-1:0] nexts,
    // The fourth axis of an octahedron.
    input  wire  [1:0][1:0][exit_pkg::PLANE_BITS-1:0]        sum_distances,
    input  wire  [1:0][1:0]           sum_there,
    input  wire  [1:0][1:0]           sum_away,
    // Marching rays: the box around the field (docs/formats/raymarch.md, "Marching rays").
    input  wire  [2:0][20:0]          bounds,
    input  wire raymarch_registers_pkg::solid_t solid,
    input  wire raymarch_registers_pkg::tuning_t tuning,
    // Spheres of the field, written one by one between frames, and lights on them. Used with ROUND.
    input  wire                       sphere_write,
    input  wire  [2:0]                sphere_number,
    input  wire raymarch_registers_pkg::sphere_t sphere,
    input  wire raymarch_registers_pkg::lights_t lights,
    // Shadows of the first light on faces of the solid. Used with SHADOW.
    input  wire raymarch_registers_pkg::shadow_t shadow,
    // Cones in which the eyes see the spheres (sphere_unit), for rays by exits.
    input  wire  [1:0][3:0]           last_cone,
    input  wire                       cone_write,
    input  wire  [8:0]                cone_address,
    input  wire  [31:0]               cone_value,
    // Scale of the depth codes, fog and colours of the pixels: inputs of ray_paint.
    input  wire  [16:0]               depth_mantissa,
    input  wire  signed [5:0]         depth_exponent,
    input  wire  [2:0]                fog_shift,
    input  wire raymarch_registers_pkg::palette_t palette,
    input  wire  [23:0]               horizon,
    input  wire                       table_write,
    input  wire  [8:0]                table_entry,
    input  wire  [7:0]                table_part,
    // Bands.
    input  wire                       band_open,
    output logic                      band_done,
    input  wire                       band_next,
    // Groups.
    output logic                      group_valid,
    input  wire                       group_ready,
    output logic                      group_eye,
    output logic [10:0]               group_row,
    output logic [5:0]                group_line,
    output logic [7:0]                group_column,
    output logic [7:0]                group_mask,
    output logic [17:0]               group_code,
    output logic [15:0]               group_colour,
    // Increment of each counter in this clock, 0 when no frame is drawn.
    output raymarch_registers_pkg::events_t events
);
    localparam int unsigned EARLY_LOG2 = $clog2(EARLY);
    // Whether the build has rays by exits, octahedra, marching rays, and light on spheres.
    localparam bit          LEAVES     = FIELDS != 0 || LATTICE;
    localparam bit          OCTAHEDRON = (FIELDS & fields_pkg::OCTANTS) != 0;
    localparam bit          MARCH      = BLEND && (FIELDS & fields_pkg::MARCHED) != 0;
    localparam bit          LIT        = ROUND || LATTICE;
    localparam int unsigned KEPT_BITS  = raymarch_pkg::end_bits(LIT, BLEND);

    // Values derived from `size`: the number of the last band, and the numbers of lines of a band, of columns (eight pixels wide) of a
    // line, of rows (of eight pixels) of a band, and of rays of a band.
    logic [5:0]  last_band, lines;
    logic [7:0]  stride;
    logic [10:0] rows;
    logic [14:0] band_rays;

    assign {last_band, lines, stride, rows} = band_pkg::cut(size);
    assign band_rays = STEREO && stereo ? {rows, 4'd0} : {1'b0, rows, 3'd0};

    logic reset;
    assign reset = rst || restart;

    // The number of the current band (`band`), its parity (`odd`), and the number of its pixels that have not been taken (`left`).
    // `early` is the number of rays of the next band that have entered the lanes. A negative value is the number of rays of the current
    // band that have not entered yet, negated. Whether the next ray may enter depends on `early` alone, which is a register; the ray itself
    // comes from LUT memory.
    logic                  odd, may_enter;
    logic [5:0]            band;
    logic [14:0]           left;
    logic [15:0]           early, change;
    logic                  ray_moves, group_moves, unused_carry;

    logic                  generating, ray_valid, ray_ready, by_exits;
    exit_pkg::ray_t        ray;

    // Numbers of the last column, of the last line of a band and of the last row of the frame, counted from 0.
    logic [10:0] column_ends;
    logic [5:0]  line_ends;
    logic [9:0]  row_ends;

    always_ff @(posedge clk) begin
        column_ends <= {stride, 3'd0} - 11'd1;
        line_ends   <= lines - 6'd1;
        row_ends    <= (10'd180 << size) - 10'd1;
    end

    // Whether the solid is an octahedron.
    logic diagonals;

    assign by_exits = !MARCH || exits;

    always_ff @(posedge clk) diagonals <= OCTAHEDRON && rule == exit_pkg::BOX && levels[0];

    ray_generator #(
        .MARCH(MARCH), .ROUND(ROUND), .LATTICE(LATTICE), .OCTAHEDRON(OCTAHEDRON), .STEREO(STEREO), .CONE(CONE)
    ) generator (
        .clk, .rst(reset), .start, .busy(generating), .last_column(column_ends), .last_line(line_ends), .last_band, .last_row(row_ends),
        .stereo, .exits,
        .first, .across, .down, .near_limit, .far_limit, .choice, .distances,
        .there, .away, .last, .nexts, .diagonals, .sum_distances, .sum_there, .sum_away, .last_cone, .cone_write, .cone_address, .cone_value,
        .out_valid(ray_valid), .out_ready(ray_ready), .out_ray(ray)
    );

    assign may_enter   = early[15] || !early[EARLY_LOG2];
    assign ray_moves   = ray_valid && ray_ready;
    assign group_moves = group_valid && group_ready;
    assign band_done   = busy && left == '0;
    assign change      = start || band_next ? -(16'(band_rays)) : '0;

    always_ff @(posedge clk) begin
        {early, unused_carry} <= {start ? 16'd0 : early, 1'b1} + {change, ray_moves};
        if (group_moves) left <= left - 1'b1;
        if (band_next) begin
            odd   <= !odd;
            left  <= band_rays;
            band  <= band + 1'b1;
            if (band == last_band) busy <= 1'b0;
        end
        if (start) begin
            busy  <= 1'b1;
            odd   <= 1'b0;
            left  <= band_rays;
            band  <= '0;
        end
        if (reset) busy <= 1'b0;
    end

    // The lowest bits of the number of the band's first line.
    logic [1:0] first_line;

    always_ff @(posedge clk) if (start || band_next) first_line <= start ? '0 : first_line + lines[1:0];

    // Sends a ray to the first lane that can accept a ray.
    logic [LANES-1:0] lane_ready, lane_valid, idles, evaluates, waits;

    always_comb
        for (int i = 0; i < LANES; i++)
            lane_valid[i] = ray_valid && may_enter && (lane_ready & ((LANES'(1) << i) - 1'b1)) == '0;
    assign ray_ready = may_enter && lane_ready != '0;

    // The first 18 bits of D.
    logic [2:0][exit_pkg::DIRECTION_BITS-1:0] short_direction;

    always_comb
        for (int axis = 0; axis < 3; axis++)
            short_direction[axis] = {1'b0, ray.speed[axis][exit_pkg::SPEED_BITS-1 -: exit_pkg::DIRECTION_BITS-1]}
                                    ^ {exit_pkg::DIRECTION_BITS{ray.down[axis]}};

    // The ends of rays by exits, and of marching rays.
    logic [LANES-1:0][exit_pkg::END_BITS-1:0]      found;
    logic [LANES-1:0][raymarch_pkg::END_BITS-1:0]  ring_end;
    logic [LANES-1:0]                              exit_valid, exit_taken, ring_valid, ring_taken;

    // The positions of the eyes relative to the solid. For a repeated solid this is the equivalent position in the cell around the origin.
    // The spheres of a list use the positions in the world.
    logic [1:0][2:0][exit_pkg::PLANE_BITS-1:0] places;

    if (ROUND && ((FIELDS & fields_pkg::BOX) != 0 || LATTICE)) begin : cells
        always_ff @(posedge clk) begin
            places <= origins;
            for (int eye = 0; eye < 2; eye++)
                for (int axis = 0; axis < 3; axis++)
                    if (rule == exit_pkg::CUBES) places[eye][axis][24:18] <= {7{origins[eye][axis][17]}};
        end
    end else begin : one_cell
        assign places = origins;
    end

    for (genvar i = 0; i < LANES; i++) begin : lanes
        // Signals of the exit_lane and of the ring_lane.
        logic exit_ready, exit_evaluates, exit_waits, ring_ready, ring_idles, ring_evaluates, ring_waits;

        if (LEAVES) begin : leaving
            exit_pkg::end_t ending;
            logic           nothing;

            assign found[i] = ending;
            wire _unused = nothing;

            exit_lane #(
                .LEVELS((FIELDS & fields_pkg::MENGER) != 0 ? LEVELS : 0), .BOXES((FIELDS & fields_pkg::BOX) != 0 || LATTICE || OCTAHEDRON),
                .STEREO(STEREO), .ROUND(ROUND), .LATTICE(LATTICE), .OCTAHEDRON(OCTAHEDRON), .SPOT(SHADOW)
            ) lane (
                .clk, .rst(reset), .origins(places), .solid({rule, levels, halves, borders}), .far_t(far_limit),
                .in_valid(lane_valid[i] && by_exits), .in_ready(exit_ready), .in_ray(ray), .in_origin('0), .in_carried('0),
                .out_valid(exit_valid[i]), .out_ready(exit_taken[i]), .out_end(ending), .out_carried(nothing),
                .evaluates(exit_evaluates), .waits(exit_waits)
            );
        end else if (ROUND) begin : passing
            // Without a flat solid, a ray ends where it meets a sphere.
            exit_pkg::end_t                      ending;
            logic [exit_pkg::ROUND_END_BITS-1:0] kept;

            always_comb begin
                ending        = '0;
                ending.place  = ray.place;
                ending.t      = ray.sphere.t;
                ending.height = ray.height;
                ending.met    = ray.sphere.met;
                ending.number = ray.sphere.number;
                ending.direction = short_direction;
            end

            skid_buffer #(.WIDTH(exit_pkg::ROUND_END_BITS)) waiting (
                .clk, .rst(reset), .in_valid(lane_valid[i] && by_exits), .in_ready(exit_ready), .in_data(exit_pkg::ROUND_END_BITS'(ending)),
                .out_valid(exit_valid[i]), .out_ready(exit_taken[i]), .out_data(kept)
            );
            assign found[i] = exit_pkg::END_BITS'(kept);
            wire _unused = &{1'b0, ending};
            assign {exit_evaluates, exit_waits} = '0;
        end else begin : no_leaving
            assign {exit_ready, exit_valid[i], exit_evaluates, exit_waits} = '0;
            assign found[i] = '0;
        end

        if (MARCH && i == 0) begin : marching
            // Rays of fields with fillets march, in one lane only, because a ring_lane is larger than an exit_lane. The ring holds enough
            // rays to keep the lane busy when rays with one evaluation follow rays with many.
            raymarch_pkg::end_t ending;

            assign ring_end[i] = ending;
            assign ring_idles  = ring_ready && !lane_valid[i];

            ring_lane #(
                .LEVELS((FIELDS & fields_pkg::MENGER) != 0 ? LEVELS : 0), .BOXES((FIELDS & fields_pkg::BOX) != 0), .STEREO(STEREO)
            ) lane (
                .clk, .rst(reset), .origins, .bounds, .solid, .tuning, .sphere_write,
                .sphere_number, .sphere,
                .in_valid(lane_valid[i] && !by_exits), .in_ready(ring_ready), .in_ray({ray.over, ray.start[exit_pkg::T_BITS-1:4], ray.place, ray.height, short_direction}),
                .out_valid(ring_valid[i]), .out_ready(ring_taken[i]), .out_end(ending),
                .evaluates(ring_evaluates), .waits(ring_waits)
            );
        end else begin : no_marching
            assign {ring_ready, ring_valid[i], ring_idles, ring_evaluates, ring_waits} = '0;
            assign ring_end[i] = '0;
        end

        assign lane_ready[i] = by_exits ? exit_ready : ring_ready;
        assign idles[i]      = by_exits ? exit_ready && !lane_valid[i] : ring_idles;
        assign evaluates[i]  = by_exits ? exit_evaluates : ring_evaluates;
        assign waits[i]      = by_exits ? exit_waits : ring_waits;
    end

    // In each clock one lane, chosen in rotation, may output the end of a ray. This rate suffices, because the generator produces at most
    // one ray per clock.
    localparam int unsigned TURN_BITS = LANES == 1 ? 1 : $clog2(LANES);
    logic [TURN_BITS-1:0] turn;
    logic                 next_valid, next_now, next_taken, waiting_valid, waiting_now, waiting_ready, room, paint_valid, paint_ready;
    raymarch_pkg::end_t      next_end, waiting_end, paint_end;
    logic [KEPT_BITS-1:0] kept;

    always_ff @(posedge clk) turn <= reset || turn == TURN_BITS'(LANES - 1) ? '0 : turn + 1'b1;

    // The next end by exits: exit_shadow finds the shadows on faces, and exit_landing completes ends on spheres of a lattice.
    exit_pkg::end_t     shaded, landed;
    raymarch_pkg::end_t exit_end;
    logic               found_taken, shaded_valid, shaded_taken, landed_valid, landed_taken, shadow_evaluates, shadow_waits;

    assign landed_taken = next_taken && by_exits;

    if (SHADOW && LEAVES) begin : shadows
        exit_shadow #(
            .LEVELS((FIELDS & fields_pkg::MENGER) != 0 ? LEVELS : 0), .BOXES((FIELDS & fields_pkg::BOX) != 0),
            .KEPT_BITS(exit_pkg::end_bits(ROUND, LATTICE))
        ) shade (
            .clk, .rst(reset), .solid({rule, levels, halves, borders}), .shadow, .in_valid(exit_valid[turn]), .in_ready(found_taken),
            .in_end(found[turn]), .out_valid(shaded_valid), .out_ready(shaded_taken), .out_end(shaded),
            .evaluates(shadow_evaluates), .waits(shadow_waits)
        );
    end else begin : no_shadows
        assign shaded       = found[turn];
        assign shaded_valid = exit_valid[turn];
        assign found_taken  = shaded_taken;
        assign {shadow_evaluates, shadow_waits} = '0;
        wire _unused = &{1'b0, shadow};
    end

    if (LATTICE) begin : landing
        exit_landing #(.ROUND(ROUND)) land (
            .clk, .rst(reset), .far_t(far_limit), .in_valid(shaded_valid), .in_ready(shaded_taken), .in_end(shaded),
            .out_valid(landed_valid), .out_ready(landed_taken), .out_end(landed)
        );
    end else begin : no_landing
        assign landed       = shaded;
        assign landed_valid = shaded_valid;
        assign shaded_taken = landed_taken;
    end

    always_comb begin
        exit_end           = '0;
        exit_end.place     = landed.place;
        exit_end.t         = landed.hit || landed.met ? landed.t : raymarch_pkg::END_T_BITS'(landed.height);
        exit_end.steps     = landed.steps;
        exit_end.state     = landed.hit || landed.met ? raymarch_pkg::HIT : raymarch_pkg::MISS;
        if (SHADOW && landed.hit && !landed.round && landed.height[0]) exit_end.state = raymarch_pkg::SHADED;
        exit_end.surface   = !landed.hit ? landed.number : landed.round ? '0
                             : diagonals ? exit_pkg::octant(landed.axis, landed.positive) : {landed.axis, landed.positive};
        exit_end.round     = !landed.hit || landed.round;
        // The base of a cone is a face with the normal -z.
        if (CONE && lights.cone && !landed.hit && landed.number == '1) begin
            exit_end.surface = 3'd4;
            exit_end.round   = 1'b0;
        end
        exit_end.direction = landed.direction;
        // An end on a sphere has the colour of the sphere only; fillets are drawn by marching rays.
        exit_end.share     = '1;
    end

    assign next_end   = by_exits ? exit_end : ring_end[turn];
    assign next_valid = by_exits ? landed_valid : ring_valid[turn];

    // Ends that have waited in the FIFO are painted first. An end of the next band is stored in the FIFO, which is never full, because at
    // most EARLY rays of the next band enter the lanes.
    assign next_now      = next_valid && next_end.place.odd == odd;
    assign waiting_end   = raymarch_pkg::END_BITS'(kept);
    assign waiting_now   = waiting_valid && waiting_end.place.odd == odd;
    assign waiting_ready = waiting_now && band_open && paint_ready;
    assign next_taken    = next_now ? band_open && paint_ready && !waiting_now : room;
    assign paint_valid   = band_open && (waiting_now || next_now);
    assign paint_end     = waiting_now ? waiting_end : next_end;

    always_comb begin
        exit_taken       = '0;
        ring_taken       = '0;
        exit_taken[turn] = found_taken;
        ring_taken[turn] = next_taken && !by_exits;
    end

    fifo #(.WIDTH(KEPT_BITS), .DEPTH(EARLY), .BLOCK(1'b1)) waiting (
        .clk, .rst(reset), .in_valid(next_valid && !next_now), .in_ready(room), .in_data(next_end[KEPT_BITS-1:0]),
        .out_valid(waiting_valid), .out_ready(waiting_ready), .out_data(kept)
    );

    // Computes the light of the ends on spheres and fillets before they are painted.
    logic            lit_valid, lit_ready;
    raymarch_pkg::end_t lit_end;
    logic [23:0]     lit_colour;

    if (LIT) begin : light
        round_light #(.BLEND(BLEND), .STEREO(STEREO), .NORMALS(NORMALS), .HIGHLIGHT(HIGHLIGHT), .CONE(CONE)) shine (
            .clk, .rst(reset), .origins, .stereo, .repeated(solid.spheres_repeated), .lights, .palette(palette.faces[5:0]),
            .sphere_write, .sphere_number, .sphere,
            .in_valid(paint_valid), .in_ready(paint_ready), .in_end(paint_end),
            .out_valid(lit_valid), .out_ready(lit_ready), .out_end(lit_end), .out_colour(lit_colour)
        );
    end else begin : no_light
        assign lit_valid   = paint_valid;
        assign paint_ready = lit_ready;
        assign lit_end     = paint_end;
        assign lit_colour  = '0;
        wire _unused = &{1'b0, lights};
    end

    ray_paint #(.ROUND(LIT), .OCTANTS((FIELDS & fields_pkg::OCTANTS) != 0), .SHADOW(SHADOW)) paint (
        .clk, .rst(reset), .stereo, .dither, .first_line, .stride, .depth_mantissa, .depth_exponent, .fog_shift, .palette, .horizon,
        .table_write, .table_entry, .table_part,
        .in_valid(lit_valid), .in_ready(lit_ready), .in_end(lit_end), .in_colour(lit_colour),
        .out_valid(group_valid), .out_ready(group_ready), .out_eye(group_eye), .out_row(group_row), .out_line(group_line),
        .out_column(group_column), .out_mask(group_mask), .out_code(group_code), .out_colour(group_colour)
    );

    logic ended;

    function automatic logic [2:0] ones(input logic [LANES-1:0] which);
        ones = '0;
        for (int i = 0; i < LANES; i++) ones = ones + 3'(which[i]);
    endfunction

    assign ended = paint_valid && paint_ready;

    always_comb begin
        events = '0;
        events.cycles_busy    = busy;
        events.cycles_stalled = waits != '0 || shadow_waits;
        events.items_in       = ray_moves;
        events.items_out      = group_moves;
        events.cycles_idle    = busy ? ones(idles) : '0;
        events.evaluations    = ones(evaluates) + 3'(shadow_evaluates);
        events.hits           = ended && paint_end.state[0];
        events.misses         = ended && paint_end.state == raymarch_pkg::MISS;
        events.undecided      = ended && paint_end.state == raymarch_pkg::UNDECIDED;
    end

    wire _unused = &{1'b0, generating, unused_carry, sum_distances, sum_there, sum_away, exit_taken, ring_taken, ray, short_direction, landed, found, ring_end, places,
                     last_cone, cone_write, cone_address, cone_value, exits, rule, levels, halves, borders, origins, bounds, solid, tuning, sphere_write, sphere_number, sphere};
endmodule

`default_nettype wire

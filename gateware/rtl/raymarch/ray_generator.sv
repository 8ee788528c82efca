// Generates the rays of a frame, one per clock.
//
//   ray_pixels ─▶ exit_start ─▶ FIFO ─┬─▶ rays
//                       sphere_unit ──┘
//
// The order of bands, lines and eyes is that of ray_pixels. With ROUND, sphere_unit finds the first sphere that each ray by exits meets. A
// ray that starts beyond its sphere hits no flat solid (`over`). With MARCH there are also frames of marching rays, in which `exits` is
// low. Only the fields `place`, `start`, `over`, `height`, `down` and `speed` of a marching ray have a meaning.
//
// The pipelines cannot be stopped: valid bits travel with the rays, and credit_fifo at their end limits the number of rays inside. Without
// a credit, only D and the position counters stop.
//
// `start` (one clock, not while `busy`) begins the frame; the parameters must hold until the frame has ended. Latency 26
// clocks; throughput one ray per clock. `busy` falls two clocks after the last ray has left. The output is a valid/ready stream; a ray stays
// until its transfer. `rst` ends the frame.

`default_nettype none

module ray_generator #(
    parameter bit MARCH  = 1'b0,
    parameter bit ROUND  = 1'b0,
    parameter bit STEREO = 1'b1,
    // Whether rays by exits include the square of D's length.
    parameter bit LATTICE = 1'b0,
    // Whether rays by exits may have the fourth axis of an octahedron.
    parameter bit OCTAHEDRON = 1'b0,
    // Whether the list may include a solid cone. Requires ROUND.
    parameter bit CONE = 1'b0,
    // Depth of the FIFO of rays after the pipeline.
    parameter int unsigned PLACES = 32
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       start,
    output logic                      busy,
    // Frame: numbers of its last column, of the last line of a band, and of its last band, counted from 0.
    input  wire  [10:0]               last_column,
    input  wire  [5:0]                last_line,
    input  wire  [5:0]                last_band,
    input  wire  [9:0]                last_row,
    input  wire                       stereo,
    input  wire                       exits,
    input  wire  [1:0][2:0][31:0]     first,
    input  wire  [2:0][31:0]          across,
    input  wire  [2:0][31:0]          down,
    // Constants of exit_start.
    input  wire  [exit_pkg::T_BITS-1:0] near_limit,
    input  wire  [exit_pkg::T_BITS-1:0] far_limit,
    input  wire  [1:0][1:0]                choice,
    input  wire  [1:0][1:0][2:0][exit_pkg::PLANE_BITS-1:0]   distances,
    input  wire  [1:0][1:0][2:0]      there,
    input  wire  [1:0][1:0][2:0]      away,
    input  wire  [1:0][1:0][2:0]      last,
    input  wire  [1:0][1:0][2:0][exit_pkg::INTERVAL_BITS-1:0] nexts,
    input  wire                       diagonals,
    input  wire  [1:0][1:0][exit_pkg::PLANE_BITS-1:0]        sum_distances,
    input  wire  [1:0][1:0]           sum_there,
    input  wire  [1:0][1:0]           sum_away,
    // Constants of sphere_unit.
    input  wire  [1:0][3:0]           last_cone,
    input  wire                       cone_write,
    input  wire  [8:0]                cone_address,
    input  wire  [31:0]               cone_value,
    // Rays.
    output logic                      out_valid,
    input  wire                       out_ready,
    output exit_pkg::ray_t            out_ray
);
    logic                 walking, running, credit, empty, valid;
    raymarch_pkg::place_t place;
    logic [2:0][27:0]     direction;

    assign busy = walking || !empty;

    ray_pixels #(.STEREO(STEREO)) pixels (
        .clk, .rst, .start, .busy(walking), .last_column, .last_line, .last_band, .stereo, .first, .across, .down,
        .credit, .running, .valid, .place, .direction
    );

    logic           started;
    exit_pkg::ray_t ray_in;

    exit_start #(.STEREO(STEREO), .LATTICE(LATTICE), .OCTAHEDRON(OCTAHEDRON)) starts (
        .clk, .rst, .near_limit, .far_limit, .choice, .distances, .there, .away, .last, .nexts,
        .diagonals, .sum_distances, .sum_there, .sum_away,
        .in_valid(valid), .in_place(place), .in_direction(direction), .out_valid(started), .out_ray(ray_in)
    );

    localparam int unsigned KEPT_BITS = LATTICE ? exit_pkg::LATTICE_RAY_BITS : OCTAHEDRON ? exit_pkg::DIAGONAL_RAY_BITS : exit_pkg::RAY_BITS;

    logic                 kept_valid, kept_ready;
    logic [KEPT_BITS-1:0] kept;

    credit_fifo #(.WIDTH(KEPT_BITS), .DEPTH(PLACES), .DIRECT(1'b1)) leaving_rays (
        .clk, .rst, .idle(empty), .credit, .sent(running), .in_valid(started), .in_data(ray_in[KEPT_BITS-1:0]),
        .out_valid(kept_valid), .out_ready(kept_ready), .out_data(kept)
    );

    if (ROUND) begin : round_fields
        logic               by_exits, met_valid;
        exit_pkg::meeting_t met;
        exit_pkg::ray_t     ray;

        assign by_exits = !MARCH || exits;
        assign ray      = $bits(ray)'(kept);

        sphere_unit #(.STEREO(STEREO), .CONE(CONE)) meet (
            .clk, .rst, .start(start && by_exits), .last_group(last_column[10:3]), .last_row, .stereo, .near_limit, .far_limit, .last_cone,
            .write(cone_write), .address(cone_address), .value(cone_value),
            .out_valid(met_valid), .out_ready(by_exits && out_ready && kept_valid), .out_meeting(met)
        );

        assign out_valid  = kept_valid && (met_valid || !by_exits);
        assign kept_ready = out_ready && (met_valid || !by_exits);

        always_comb begin
            out_ray        = ray;
            out_ray.sphere = met;
            out_ray.over   = ray.over || by_exits && ray.start > met.t;
        end
    end else begin : flat_fields
        assign out_valid  = kept_valid;
        assign kept_ready = out_ready;
        assign out_ray    = $bits(out_ray)'(kept);

        wire _unused = &{1'b0, last_row, last_cone, cone_write, cone_address, cone_value};
    end

    wire _unused = &{1'b0, exits, ray_in};
endmodule

`default_nettype wire

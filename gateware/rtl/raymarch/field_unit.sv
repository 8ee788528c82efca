// The distance field of a lane: the fields that it is built with, side by side, and which of them is asked.
//
// Latency march_pkg::field_clocks(LEVELS, BOXES), throughput a point a clock, no handshake; `solid` holds. A field that is not built
// costs nothing; one that is the only one costs no choice.

`default_nettype none

module field_unit #(
    // Levels of the sponge; 0: none.
    parameter int unsigned LEVELS = 4,
    parameter bit          BOXES  = 1'b0
) (
    input  wire                     clk,
    input  wire march_pkg::solid_t  solid,
    input  wire  [2:0][21:0]        point,
    output logic signed [21:0]      distance,
    output logic [2:0]              surface
);
    logic signed [21:0] menger_distance, box_distance;
    logic [2:0]         menger_surface, box_surface;

    if (LEVELS > 0) begin : menger
        field_menger #(.LEVELS(LEVELS)) field (
            .clk, .levels(solid.levels[LEVELS-1:0]), .half(solid.cube_half), .point,
            .distance(menger_distance), .surface(menger_surface)
        );
    end else begin : no_menger
        assign menger_distance = '0;
        assign menger_surface  = '0;
    end

    if (BOXES) begin : box
        logic signed [21:0] early_distance;
        logic [2:0]         early_surface;

        field_box field (
            .clk, .half(solid.box_half), .has(solid.box_has), .room(solid.room), .repeated(solid.repeated), .point,
            .distance(early_distance), .surface(early_surface)
        );

        if (LEVELS > 0) begin : late
            delay #(.WIDTH(25), .CLOCKS(3 * LEVELS)) wait_for_menger (
                .clk, .enable(1'b1), .in({early_distance, early_surface}), .out({box_distance, box_surface})
            );
        end else begin : alone
            assign box_distance = early_distance;
            assign box_surface  = early_surface;
        end
    end else begin : no_box
        assign box_distance = '0;
        assign box_surface  = '0;
    end

    if (LEVELS > 0 && BOXES) begin : choice
        always_ff @(posedge clk) begin
            distance <= solid.is_box ? box_distance : menger_distance;
            surface  <= solid.is_box ? box_surface : menger_surface;
        end
    end else begin : single
        assign distance = BOXES ? box_distance : menger_distance;
        assign surface  = BOXES ? box_surface : menger_surface;
    end

    wire _unused = &{1'b0, solid, menger_distance, menger_surface, box_distance, box_surface};
endmodule

`default_nettype wire

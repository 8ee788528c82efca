// Generated from gateware/glint_soc/fields.py by `cargo xtask pac`. Do not edit.
// Computes the distances to all flat fields of a build in parallel, and selects one of the distances by `solid.kind`.
//
// Bit k of FIELDS is set if field k is built. A field that is not built takes no LUTs; a single instance needs no multiplexer.
// Latency fields_pkg::flat_clocks(LEVELS, FIELDS), throughput one point per clock, no handshake; `solid` must hold.

`default_nettype none

module flat_fields #(
    parameter int unsigned LEVELS = 4,
    parameter int unsigned FIELDS = 1
) (
    input  wire                                clk,
    input  wire raymarch_registers_pkg::solid_t solid,
    input  wire  [2:0][21:0]                   point,
    output logic signed [21:0]                 distance,
    output logic [2:0]                         surface
);
    localparam int unsigned INSTANCES = fields_pkg::instances(FIELDS);
    localparam bit          CHOICE    = (INSTANCES & (INSTANCES - 1)) != 0;
    localparam int unsigned KNOWN     = fields_pkg::flat_clocks(LEVELS, FIELDS) - (CHOICE ? 1 : 0);

    // Distance and surface of each instance (`found`) and of the selected instance (`chosen`).
    logic [2:0][24:0] found;
    logic [24:0] chosen;

    if ((INSTANCES & 1) != 0) begin : menger
        localparam int unsigned CLOCKS = 3 * LEVELS + 3;
        logic [24:0] early;

        field_menger #(.LEVELS(LEVELS), .BOX((FIELDS & 2) != 0)) field (
            .clk, .point, .is_box(solid.kind == 2'd1), .levels(solid.levels[LEVELS-1:0]), .cube_half(solid.cube_half), .half(solid.half), .has(solid.has), .room(solid.room), .repeated(solid.repeated),
            .distance(early[24:3]), .surface(early[2:0])
        );
        if (KNOWN > CLOCKS) begin : late
            delay #(.WIDTH(25), .CLOCKS(KNOWN - CLOCKS)) waiting (.clk, .enable(1'b1), .in(early), .out(found[0]));
        end else begin : in_time
            assign found[0] = early;
        end
    end else begin : no_menger
        assign found[0] = '0;
    end

    if ((INSTANCES & 2) != 0) begin : box
        localparam int unsigned CLOCKS = 3;
        logic [24:0] early;

        field_box field (
            .clk, .point, .half(solid.half), .has(solid.has), .room(solid.room), .repeated(solid.repeated),
            .distance(early[24:3]), .surface(early[2:0])
        );
        if (KNOWN > CLOCKS) begin : late
            delay #(.WIDTH(25), .CLOCKS(KNOWN - CLOCKS)) waiting (.clk, .enable(1'b1), .in(early), .out(found[1]));
        end else begin : in_time
            assign found[1] = early;
        end
    end else begin : no_box
        assign found[1] = '0;
    end

    if ((INSTANCES & 4) != 0) begin : octahedron
        localparam int unsigned CLOCKS = 5;
        logic [24:0] early;

        field_octahedron field (
            .clk, .point, .size(solid.half[0]),
            .distance(early[24:3]), .surface(early[2:0])
        );
        if (KNOWN > CLOCKS) begin : late
            delay #(.WIDTH(25), .CLOCKS(KNOWN - CLOCKS)) waiting (.clk, .enable(1'b1), .in(early), .out(found[2]));
        end else begin : in_time
            assign found[2] = early;
        end
    end else begin : no_octahedron
        assign found[2] = '0;
    end

    if (CHOICE) begin : choice
        always_comb begin
            chosen = '0;
            if (solid.kind == 2'd0 || solid.kind == 2'd1) chosen = chosen | found[0];
            if (solid.kind == 2'd1) chosen = chosen | found[1];
            if (solid.kind == 2'd2) chosen = chosen | found[2];
        end
        always_ff @(posedge clk) {distance, surface} <= chosen;
    end else begin : single
        always_comb begin
            chosen = '0;
            chosen = chosen | found[0];
            chosen = chosen | found[1];
            chosen = chosen | found[2];
        end
        assign {distance, surface} = chosen;
    end

    wire _unused = &{1'b0, clk, point, solid};
endmodule

`default_nettype wire

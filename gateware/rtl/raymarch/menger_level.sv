// One level of the Menger sponge: folds space by mirrors, so that one cube of the level's 3x3x3 cubes stands for all of them
// (docs/formats.md, "Fields"). S is the side of this cube.
//
//         ┌───┬───┬───┐
//         │   │   │   │     1  S - |x| of each coordinate: above S/2 in the middle third
//         ├───┼───┼───┤     2  the largest of them
//         │   │   │   │     3  its coordinate is mirrored at S/2: a point in a hole (two coordinates in the
//         ├───┼───┼───┤        middle third) moves outside of |x| <= S/2, the next level's cube
//         │   │   │   │
//         └───┴───┴───┘ 3S wide
//
// An integer coordinate k represents k + 1/2, so that -x is ~k. `grows` carries for each coordinate the direction in which it
// grows in the world, {axis, positive}. Latency 3 clocks, throughput one point a clock, no handshake. While `enable` is low,
// points pass unchanged; `enable` must hold.

`default_nettype none

module menger_level #(
    parameter int unsigned BITS = 22,
    // Side S of the cube that remains after the folds, an even number.
    parameter int          S    = 27 << 12
) (
    input  wire                         clk,
    input  wire                         enable,
    input  wire  signed [2:0][BITS-1:0] in,
    input  wire         [2:0][2:0]      in_grows,
    output logic signed [2:0][BITS-1:0] out,
    output logic        [2:0][2:0]      out_grows
);
    logic signed [BITS-1:0] x_1, y_1, z_1, x_2, y_2, z_2, big;
    logic [2:0][2:0]        grows_1, grows_2;
    logic                   z_over_x, z_over_y, x_over_y;
    logic [2:0]             low_2;
    logic                   big_is_x, big_is_z, mirror;
    logic [2:0]             big_grows;

    function automatic logic signed [BITS-1:0] folded(input logic [BITS-1:0] k, input logic on);
        folded = (k ^ {BITS{on && !k[BITS-1]}}) + (on ? BITS'(S) : '0);
    endfunction

    always_ff @(posedge clk) begin
        x_1 <= folded(in[0], enable);
        y_1 <= folded(in[1], enable);
        z_1 <= folded(in[2], enable);
        for (int i = 0; i < 3; i++) grows_1[i] <= in_grows[i] ^ {2'b0, enable && !in[i][BITS-1]};

        x_2      <= x_1;
        y_2      <= y_1;
        z_2      <= z_1;
        grows_2  <= grows_1;
        z_over_x <= z_1 > x_1;
        z_over_y <= z_1 > y_1;
        x_over_y <= x_1 > y_1;
        low_2    <= {z_1 < BITS'(S / 2), y_1 < BITS'(S / 2), x_1 < BITS'(S / 2)};
    end

    always_comb begin
        big_is_z  = enable && z_over_x && z_over_y;
        big_is_x  = enable && !(z_over_x && z_over_y) && x_over_y;
        big       = big_is_z ? z_2 : big_is_x ? x_2 : y_2;
        big_grows = big_is_z ? grows_2[2] : big_is_x ? grows_2[0] : grows_2[1];
        mirror    = enable && (big_is_z ? low_2[2] : big_is_x ? low_2[0] : low_2[1]);
    end

    always_ff @(posedge clk) begin
        out[0]       <= big_is_x ? y_2 : x_2;
        out[1]       <= (enable && !mirror ? BITS'(-S) : '0) + (big ^ {BITS{mirror}});
        out[2]       <= big_is_z ? y_2 : z_2;
        out_grows[0] <= big_is_x ? grows_2[1] : grows_2[0];
        out_grows[1] <= big_grows ^ {2'b0, mirror};
        out_grows[2] <= big_is_z ? grows_2[1] : grows_2[2];
    end
endmodule

`default_nettype wire

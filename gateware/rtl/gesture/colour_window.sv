// Converts a pixel to 8-bit channels and tests two of these channels. The pixel is marked if each of the two is in its window
// (docs/formats/gesture.md, "Gestures").
//
//   pixel ─▶ green's share ─▶ + red's ─▶ + blue's ─▶ two channels ─▶ mark
//
// A share is the product of a constant and a colour of 5 or 6 bits. The table of these products takes one LUT per bit, which for red and
// blue also contains that bit's adder. Latency 5 clocks, throughput one pixel per clock.

`default_nettype none

module colour_window (
    input  wire                                   clk,
    input  wire  [15:0]                           pixel,
    input  wire  gesture_registers_pkg::window_t  window_a,
    input  wire  gesture_registers_pkg::window_t  window_b,
    output logic                                  marked
);
    localparam int unsigned CHANNELS = 3; // luma, Cr, Cb

    // The channels with 10 fraction bits. Green's share includes the offset of the chroma channels and the rounding.
    typedef logic [17:0] share_t;
    (* rom_style = "logic" *) share_t greens [0:CHANNELS*64-1];
    (* rom_style = "logic" *) share_t reds   [0:CHANNELS*32-1];
    (* rom_style = "logic" *) share_t blues  [0:CHANNELS*32-1];

    initial begin
        for (int i = 0; i < 64; i++) begin
            greens[i]       = share_t'( 601 * (4 * i + i / 16) + 511);
            greens[64 + i]  = share_t'(-429 * (4 * i + i / 16) + 511 + 128 * 1024);
            greens[128 + i] = share_t'(-339 * (4 * i + i / 16) + 511 + 128 * 1024);
        end
        for (int i = 0; i < 32; i++) begin
            reds[i]       = share_t'( 306 * (8 * i + i / 4));
            reds[32 + i]  = share_t'( 512 * (8 * i + i / 4));
            reds[64 + i]  = share_t'(-173 * (8 * i + i / 4));
            blues[i]      = share_t'( 117 * (8 * i + i / 4));
            blues[32 + i] = share_t'( -83 * (8 * i + i / 4));
            blues[64 + i] = share_t'( 512 * (8 * i + i / 4));
        end
    end

    logic [4:0]                red, blue, blue_1;
    logic [15:0]               whole;
    share_t [CHANNELS-1:0]     green_part, red_part, sum;
    logic [7:0][7:0]           channels;
    logic [7:0]                a, b;

    delay #(.WIDTH(16), .CLOCKS(3)) pixel_of_sum (.clk, .enable(1'b1), .in(pixel), .out(whole));

    assign channels = {8'd0, 8'd0, sum[2][17:10], sum[1][17:10], sum[0][17:10],
                       whole[4:0], whole[4:2], whole[10:5], whole[10:9], whole[15:11], whole[15:13]};

    always_ff @(posedge clk) begin
        red    <= pixel[15:11];
        blue_1 <= pixel[4:0];
        blue   <= blue_1;
        for (int i = 0; i < CHANNELS; i++) begin
            green_part[i] <= greens[64 * i + int'(pixel[10:5])];
            red_part[i]   <= green_part[i] + reds[32 * i + int'(red)];
            sum[i]        <= red_part[i] + blues[32 * i + int'(blue)];
        end
        a <= channels[window_a.channel];
        b <= channels[window_b.channel];
        marked <= window_a.lower <= a && a <= window_a.upper && window_b.lower <= b && b <= window_b.upper;
    end
endmodule

`default_nettype wire

// Stage 1 of the triangle setup for smooth shading: computes P = nearest((w + 1/2)·L) of each vertex and channel
// (docs/formats.md, "Smooth shading"), with w the depth of the vertex and L its light. The results have the form that a plane
// needs: P at vertex 0 (`p0`), and the differences of the other vertices from it (`p10`, `p20`).
//
// There are nine products, one for each channel of a vertex, vertex after vertex. The module `setup` drives `count`, the number
// of the clock in a beat (the time of a triangle in a stage of `setup`, 11 clocks or more), and `beat`, which is high in the
// last clock of a beat. The inputs hold during a beat, and the results belong to the next beat. The blue of `p20` is valid from
// clock 1 of that beat on, all other results from clock 0 on.

`default_nettype none

module setup_light (
    input  wire              clk,
    input  wire              enable,
    input  wire              beat,
    input  wire  [3:0]       count,
    input  wire  [23:0]      next_w0, // of the triangle that comes with the beat
    input  wire  [24:0]      w10,
    input  wire  [24:0]      w20,
    input  wire  [2:0][39:0] lit, // L of each vertex: red in 13 bits, green in 14, blue in 13, which is the lowest
    output logic [2:0][23:0] p0,  // red in the lowest bits
    output logic [2:0][24:0] p10,
    output logic [2:0][24:0] p20
);
    logic        [1:0]  channel;
    logic        [39:0] vertex;
    // w with half a depth code added: `w0` is that of vertex 0, `w` that of the vertex whose products come next.
    logic        [24:0] w0, w;
    logic signed [24:0] a;
    logic signed [17:0] b;
    logic signed [43:0] p;

    // The factors follow from count = 3·vertex + channel. The product comes three clocks later.
    always_comb begin
        unique case (count)
            4'd0, 4'd1, 4'd2: {vertex, a} = {lit[0], w0};
            4'd3, 4'd4, 4'd5: {vertex, a} = {lit[1], w};
            default:          {vertex, a} = {lit[2], w};
        endcase
        unique case (count)
            4'd0, 4'd3, 4'd6, 4'd9: channel = 2'd0;
            4'd1, 4'd4, 4'd7:       channel = 2'd1;
            default:                channel = 2'd2;
        endcase
        // L of the vertex in this channel, with 14 fraction bits.
        unique case (channel)
            2'd0:    b = {4'b0, vertex[39:27], 1'b0};
            2'd1:    b = {4'b0, vertex[26:13]};
            default: b = {4'b0, vertex[12:0], 1'b0};
        endcase
    end

    always_ff @(posedge clk) begin
        if (beat) w0 <= {1'b0, next_w0} + 25'd32;
        if (count == 4'd2 || count == 4'd5) w <= w0 + (count[0] ? w20 : w10);
    end

    multiply_add #(.BITS(44)) dsp (.clk, .enable, .a, .b, .c(44'd1 << 13), .p);

    logic [2:0][23:0] p0_1;
    logic [2:0][24:0] p10_1;
    // P of vertex 0 in the channel of the next difference.
    logic [23:0]      first;
    logic [24:0]      difference, p20_red;

    assign difference = {1'b0, p[37:14]} - {1'b0, first};

    always_ff @(posedge clk) begin
        unique case (count)
            4'd3, 4'd4, 4'd5: p0_1[channel]  <= p[37:14];
            4'd6, 4'd7, 4'd8: p10_1[channel] <= difference;
            4'd9:             p20_red        <= difference;
            4'd0:             p20[2]         <= difference;
            default: ;
        endcase
        if (enable) begin
            unique case (count)
                4'd5, 4'd8: first <= p0_1[0];
                4'd6, 4'd9: first <= p0_1[1];
                default:    first <= p0_1[2];
            endcase
        end
        if (beat) begin
            p0     <= p0_1;
            p10    <= p10_1;
            p20[0] <= p20_red;
            p20[1] <= difference;
        end
    end

    wire _unused = &{1'b0, p[43:38], p[13:0]};
endmodule

`default_nettype wire

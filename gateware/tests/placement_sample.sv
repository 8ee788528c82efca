// Flip-flops in five control sets, and nets with a known number of loads, to test what `netlist.py` counts.
module placement_sample (
    input  logic        clk,
    input  logic        enable,
    input  logic        hold,
    input  logic        reset,
    input  logic        clear,
    input  logic [16:0] data,
    output logic [8:0]  nine,
    output logic [7:0]  eight,
    output logic [1:0]  two,
    output logic        one
);
    // 9 flip-flops with an enable, and 8 with another one, whose net has no name, and a reset. So `enable` has 9 loads and the
    // LUT of the other enable, `shared` 9 LUTs, the reset 8 flip-flops.
    logic shared;
    always_ff @(posedge clk) if (enable) nine <= data[8:0] ^ {9{shared}};
    always_ff @(posedge clk) begin
        if (reset) eight <= '0;
        else if (enable & ~hold) eight <= data[16:9];
    end

    // A flip-flop with a clock only, one at the falling edge, 2 with a reset that needs no clock.
    always_ff @(posedge clk) shared <= data[3];
    always_ff @(negedge clk) one <= data[2];
    always_ff @(posedge clk or posedge clear) begin
        if (clear) two <= '0;
        else two <= data[1:0];
    end
endmodule

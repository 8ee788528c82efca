// Flip-flops in five control sets, and nets with known numbers of loads, to test `netlist.py`.
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
    // 9 flip-flops with an enable, and 8 with a reset and another enable, whose net has no name. The loads are: of `enable` 9 flip-flops
    // and the LUT of the other enable, of `shared` 9 LUTs, of the reset 8 flip-flops.
    logic shared;
    always_ff @(posedge clk) if (enable) nine <= data[8:0] ^ {9{shared}};
    always_ff @(posedge clk) begin
        if (reset) eight <= '0;
        else if (enable & ~hold) eight <= data[16:9];
    end

    // A flip-flop with only a clock, a flip-flop at the falling edge, and 2 flip-flops with an asynchronous reset.
    always_ff @(posedge clk) shared <= data[3];
    always_ff @(negedge clk) one <= data[2];
    always_ff @(posedge clk or posedge clear) begin
        if (clear) two <= '0;
        else two <= data[1:0];
    end
endmodule

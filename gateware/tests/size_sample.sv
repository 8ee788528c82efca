// A module with known numbers of all resources, to test the size measurement.
module size_sample (
    input  logic        clk,
    input  logic [31:0] a,
    input  logic [31:0] b,
    input  logic        write,
    input  logic [4:0]  write_address,
    input  logic [4:0]  read_address,
    input  logic [9:0]  address,
    input  logic        bit_in,
    output logic        bit_out,
    output logic [3:0]  kept,
    output logic [31:0] sum,
    output logic [31:0] product,
    output logic [31:0] large_out,
    output logic [15:0] small_out
);
    // A sum of 32 LUTs and 8 CARRY4; a LUT memory that stores 6 bits of it (a RAM32M of 4 LUTs); a sum of these 6 bits and 32
    // other bits, 6 LUTs and 8 CARRY4; and 101 flip-flops without an enable. The memory is between the two sums, so the longest path
    // consists of a read of the memory, a LUT and 8 CARRY4.
    (* ram_style = "distributed" *) logic [5:0] few [32];
    logic [31:0] a_held, b_held, first;
    logic [4:0] read_address_held;
    assign first = a_held + b_held;
    always_ff @(posedge clk) begin
        a_held <= a;
        b_held <= b;
        read_address_held <= read_address;
        if (write) few[write_address] <= first[31:26];
        sum <= {26'd0, few[read_address_held]} + b_held;
    end

    // A shift register, one LUT.
    logic [7:0] delay;
    always_ff @(posedge clk) delay <= {delay[6:0], bit_in};
    assign bit_out = delay[7];

    // 4 flip-flops. Their enable has too few loads for a separate control set, and becomes 4 LUTs.
    always_ff @(posedge clk) if (bit_in) kept <= a[3:0];

    // A DSP48 with its registers.
    logic signed [15:0] left, right;
    always_ff @(posedge clk) begin
        left <= a[15:0];
        right <= a[31:16];
        product <= left * right;
    end

    // A RAMB36 and a RAMB18.
    (* ram_style = "block" *) logic [31:0] large [1024];
    (* ram_style = "block" *) logic [15:0] small_one [1024];
    always_ff @(posedge clk) begin
        if (write) large[address] <= a;
        large_out <= large[address];
        if (write) small_one[address] <= b[15:0];
        small_out <= small_one[address];
    end
endmodule

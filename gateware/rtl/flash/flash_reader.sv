// Reads words of 32 bits from a SPI flash with four data lines.
//
// The command is 0x6b, fast read with quad output: command and address are sent on line 0, eight clocks pass, and the bytes are received on
// all four lines, the high half of each byte first. The flash continues with the next address while it is selected, so a request for the
// next word needs no new command:
//
//   cs_n  ‾‾‾‾‾‾‾╲_______________________________________________ … stays low
//         8 bits │ 0x6b │ 24 bits of address │ 8 clocks │ 8 × 4 bits │     │ 8 × 4 bits │
//
// `sclk` has half the frequency of `clk` and rises in the middle of a bit. It only runs during transfers, and for seven clocks before the
// flash is selected: the flash needs a pause between two commands, and the primitive STARTUPE2 of 7-series FPGAs suppresses the first
// three clocks after configuration.
//
// A bit from the flash is sampled when `sclk` falls, just before the flash changes it, so the path from the flash may take two periods of
// `clk`.
//
// `done` is high for one clock, in which `data` is valid; `request` and `address` must hold until then. Bits 7:0 of `data` are the byte
// with the lowest address.

`default_nettype none

module flash_reader #(
    parameter int unsigned ADDRESS_BITS = 22
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire                     request,
    input  wire  [ADDRESS_BITS-1:0] address,
    output logic                    done,
    output logic [31:0]             data,
    output logic                    cs_n,
    output logic                    sclk,
    output logic                    command, // drives line 0, while `sending`
    output logic                    sending,
    input  wire  [3:0]              lines
);
    localparam logic [7:0] READ_QUAD = 8'h6b;

    typedef enum logic [2:0] {IDLE, DESELECT, SEND, SKIP, RECEIVE} state_t;
    state_t state;
    // Number of bits transferred in this state, without and with the current bit.
    logic [4:0] count, next_count;
    logic last;
    // The second half of a bit, in which `sclk` is high.
    logic second;
    // The address after the last word read.
    logic [ADDRESS_BITS-1:0] follower;
    // Bytes in the order of their addresses, the first byte in the high bits.
    logic [31:0] received;
    logic [31:0] sent;

    always_comb begin
        next_count = count + 5'd1;
        last = next_count[2:0] == 3'd0 && (state != SEND || next_count == 5'd0);
        sent = 32'({READ_QUAD, 24'({address, 2'b00})});
        data = {received[7:0], received[15:8], received[23:16], received[31:24]};
    end

    always_ff @(posedge clk) begin
        done <= 1'b0;
        if (state == IDLE) begin
            if (request && !done) begin
                state <= cs_n || address != follower ? DESELECT : RECEIVE;
                cs_n <= cs_n || address != follower;
            end
        end else begin
            second <= !second;
            // `sclk` stays low in the clock in which the flash becomes selected.
            sclk <= !second && !(state == DESELECT && last);
            if (second) begin
                count <= last ? 5'd0 : next_count;
                command <= state == SEND && sent[~next_count];
                if (state == RECEIVE) received <= {received[27:0], lines};
                if (last) begin
                    case (state)
                        DESELECT: begin
                            state <= SEND;
                            cs_n <= 1'b0;
                            sending <= 1'b1;
                        end
                        SEND: begin
                            state <= SKIP;
                            sending <= 1'b0;
                        end
                        SKIP: state <= RECEIVE;
                        default: begin
                            state <= IDLE;
                            done <= 1'b1;
                            follower <= address + ADDRESS_BITS'(1);
                        end
                    endcase
                end
            end
        end
        if (rst) begin
            state <= IDLE;
            count <= 5'd0;
            second <= 1'b0;
            sclk <= 1'b0;
            cs_n <= 1'b1;
            sending <= 1'b0;
        end
    end
endmodule

`default_nettype wire

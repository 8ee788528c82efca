// An I2C master that executes a queue of commands: single master, fast mode, open drain.
//
// A command is {more, operation, argument}:
//
//   START             start condition, or repeated start within a transaction
//   WRITE  byte       send a byte and check its acknowledge
//   READ   count - 1  receive 1 to 256 bytes; acknowledge all except the last, or all with `more`
//   STOP              stop condition, after which the bus stays free for two phases
//
//             ┌──────┐   ┌────────────┐   ┌──────┐
//   command ─▶│ fifo │──▶│ steps of a │──▶│ fifo │─▶ answer: bytes received
//             └──────┘   │ phase each │   └──────┘
//                        └────┬───────┘
//                         SCL, SDA
//
// A bit has three phases of PHASE clocks, two with SCL low and one with SCL high:
//
//   SCL  ────╲____________________╱──────────╲____
//   SDA  ═══════════════╳═════════════════════════
//        HIGH ││ LOW     │ SET    │ HIGH     ││
//
// The phase with a high SCL begins when the engine has detected the high level, so a device may stretch the clock. The engine keeps SCL low
// between two commands of a transaction, and while the FIFO of received bytes is full. A bit takes 3 phases, plus the 7 clocks until the
// engine has detected the high SCL. A start takes 3 phases, or 4 within a transaction; a stop takes 4 phases.
//
// A start checks SDA. A low SDA means that a device is still in the middle of a byte. The engine then generates up to nine SCL clocks. In
// the first of these clocks in which the device has released SDA, the engine generates the start condition, which resets the device.
//
// Repetition: while `repeats` is high, a finished command goes back into the queue, and a transaction begins every `period` + 1
// clocks, the first one `period` + 1 clocks after `repeats` rises. At that time the queue must hold a whole transaction, from start to
// stop. `ended` pulses once every `batch` + 1 transactions. A transaction that is still running when the next one is due is an error.
//
//   command ──▶┌──────┐
//          ┌──▶│ fifo │──▶ steps ──┐
//          │   └──────┘            │
//          └──── repeats ◀─────────┘
//
// An error ends the transaction: the wires are released, `failed` and `error` hold their values, and commands wait until `rst`. After a
// missing acknowledge, the engine first generates a stop condition.

`default_nettype none

module i2c_engine #(
    // Number of clocks per phase, a third of an SCL period.
    parameter int unsigned PHASE        = 68,
    // A device may hold SCL low for up to 2^STRETCH_BITS clocks; longer stretching is an error.
    parameter int unsigned STRETCH_BITS = 21,
    parameter int unsigned COMMANDS     = 32,
    parameter int unsigned ANSWERS      = 128
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         command_valid,
    output logic        command_ready,
    input  wire i2c_registers_pkg::command_t command_data,
    input  wire         repeats,
    input  wire  [23:0] period,
    input  wire  [3:0]  batch,
    output logic        answer_valid,
    input  wire         answer_ready,
    output logic [7:0]  answer_data,
    output logic        busy,
    output logic        failed,
    output logic [2:0]  error,
    // High for one clock at the end of a transaction or of a batch, or at an error.
    output logic        ended,
    // The wires: `scl` and `sda` are their states after a spike filter, `*_in` are the input pins, and `*_out` the drivers (0
    // pulls low, 1 releases).
    output logic        scl,
    output logic        sda,
    input  wire         scl_in,
    output logic        scl_out,
    input  wire         sda_in,
    output logic        sda_out
);
    localparam logic [1:0] START = i2c_registers_pkg::OPERATION_START, WRITE = i2c_registers_pkg::OPERATION_WRITE,
                           READ = i2c_registers_pkg::OPERATION_READ, STOP = i2c_registers_pkg::OPERATION_STOP;
    localparam logic [2:0] NONE = i2c_registers_pkg::ERROR_NONE, ADDRESS = i2c_registers_pkg::ERROR_ADDRESS,
                           BYTE = i2c_registers_pkg::ERROR_BYTE, CLOCK = i2c_registers_pkg::ERROR_CLOCK,
                           DATA = i2c_registers_pkg::ERROR_DATA, LATE = i2c_registers_pkg::ERROR_LATE;
    localparam int unsigned PHASE_BITS = $clog2(PHASE);
    localparam logic [3:0]  LAST_CLOCK = 4'd8;

    // States: in IDLE the bus is free; HELD is a wait within a transaction; SET, HIGH and LOW are phases of a bit; FALL generates a start
    // condition, RISE a stop condition; FREE is the bus free time after a stop; FAILED follows an error, until `rst`.
    typedef enum logic [3:0] {IDLE, HELD, SET, HIGH, LOW, FALL, RISE, FREE, FAILED} state_t;
    state_t state;

    i2c_registers_pkg::command_t command;

    logic                  pending, taken, room, received;
    logic [1:0]            operation;
    logic [7:0]            bytes;
    // Shift register of nine bits, a byte and its acknowledge: sent from the highest bit, filled from the lowest.
    logic [8:0]            shift;
    logic [3:0]            clocks;
    // High while the next byte to send is an address.
    logic                  addressing;
    logic [PHASE_BITS-1:0] phase;
    logic                  held, expired, waiting;
    logic [STRETCH_BITS:0] stretched;
    // `started`: high after a start condition, which pulls SDA low. In state LOW of a START command, a low `started` means that a device
    // keeps SDA low; the engine then generates SCL clocks until the device releases SDA (bus recovery).
    logic                  last_byte, ninth, started;
    logic                  again, due, late, begins;
    logic [23:0]           elapsed;
    logic [3:0]            rounds;

    assign again = repeats && taken;

    fifo #(.WIDTH($bits(command)), .DEPTH(COMMANDS)) commands (
        .clk, .rst, .in_valid(command_valid || again), .in_ready(command_ready),
        .in_data(again ? command : command_data),
        .out_valid(pending), .out_ready(taken), .out_data(command)
    );
    fifo #(.WIDTH(8), .DEPTH(ANSWERS)) answers (
        .clk, .rst, .in_valid(received), .in_ready(room), .in_data(shift[8:1]),
        .out_valid(answer_valid), .out_ready(answer_ready), .out_data(answer_data)
    );

    spike_filter scl_filter (.clk, .rst, .level(scl_in), .filtered(scl));
    spike_filter sda_filter (.clk, .rst, .level(sda_in), .filtered(sda));

    assign operation = error != NONE ? STOP : command.operation;
    assign started   = !sda_out;
    assign last_byte = command.operation != READ || bytes == command.argument;
    assign ninth     = clocks == LAST_CLOCK;
    assign held      = scl_out && !scl;
    assign expired   = phase == '0;
    assign waiting   = state == IDLE || state == HELD || state == FAILED;
    assign received  = state == LOW && expired && operation == READ && ninth;
    assign busy      = pending && !failed || state != IDLE && state != FAILED;
    assign failed    = state == FAILED;
    assign due       = repeats && elapsed == period;
    assign late      = due && state != IDLE && !failed;
    assign begins    = state == IDLE && pending && operation == START && (due || !repeats);

    always_comb begin
        taken = 1'b0;
        if (error == NONE) case (state)
            LOW:     taken = expired && (command.operation == START ? started : ninth && last_byte);
            FREE:    taken = expired;
            default: taken = 1'b0;
        endcase
    end

    // The wires are released from the configuration of the FPGA on, so that devices see no edge before the reset.
    initial begin
        scl_out = 1'b1;
        sda_out = 1'b1;
    end

    always_ff @(posedge clk) begin
        ended     <= 1'b0;
        phase     <= waiting || held || expired ? PHASE_BITS'(PHASE - 1) : phase - 1'b1;
        stretched <= waiting || !held ? '0 : stretched + 1'b1;
        elapsed   <= !repeats || due ? '0 : elapsed + 1'b1;

        case (state)
            IDLE, HELD: begin
                clocks <= '0;
                shift  <= command.operation == WRITE ? {command.argument, 1'b1} : {8'hff, last_byte && !command.more};
                if (begins) state <= HIGH;
                else if (!(state == IDLE && operation == START) && (pending && !(operation == READ && !room) || error != NONE)) begin
                    state   <= SET;
                    scl_out <= 1'b0;
                    sda_out <= operation == START || operation != STOP && (command.operation == READ || command.argument[7]);
                end
            end
            SET: if (expired) begin
                scl_out <= 1'b1;
                state   <= HIGH;
            end
            HIGH: if (expired) begin
                case (operation)
                    START: begin
                        addressing <= 1'b1;
                        if (sda) begin
                            sda_out <= 1'b0;
                            state   <= FALL;
                        end else begin
                            scl_out <= 1'b0;
                            state   <= LOW;
                            if (clocks == LAST_CLOCK + 1'b1) begin
                                error   <= DATA;
                                scl_out <= 1'b1;
                                ended   <= 1'b1;
                                state   <= FAILED;
                            end
                        end
                    end
                    STOP: begin
                        sda_out <= 1'b1;
                        state   <= RISE;
                    end
                    default: begin
                        scl_out <= 1'b0;
                        state   <= LOW;
                        shift   <= {shift[7:0], sda};
                        // SDA differs from the sent bit if another device pulls SDA low during a 1.
                        if (!ninth && command.operation == WRITE && sda != shift[8]) begin
                            error   <= DATA;
                            scl_out <= 1'b1;
                            sda_out <= 1'b1;
                            ended   <= 1'b1;
                            state   <= FAILED;
                        end
                    end
                endcase
            end
            LOW: if (expired) begin
                state  <= SET;
                clocks <= clocks + 1'b1;
                if (operation != START && !ninth) sda_out <= shift[8];
                if (operation == START ? started : ninth) begin
                    state <= HELD;
                    bytes <= last_byte ? '0 : bytes + 1'b1;
                end
                if (operation == WRITE && ninth) begin
                    addressing <= 1'b0;
                    if (shift[0]) error <= addressing ? ADDRESS : BYTE;
                end
            end
            FALL: if (expired) begin
                scl_out <= 1'b0;
                state   <= LOW;
            end
            RISE: if (expired) state <= FREE;
            FREE: if (expired) begin
                ended  <= error != NONE || !sda || !repeats || rounds == batch;
                rounds <= rounds == batch ? '0 : rounds + 1'b1;
                state <= error != NONE || !sda ? FAILED : IDLE;
                if (error == NONE && !sda) error <= DATA;
            end
            default: ;
        endcase

        if (stretched[STRETCH_BITS] || late) begin
            error   <= late ? LATE : CLOCK;
            scl_out <= 1'b1;
            sda_out <= 1'b1;
            ended   <= 1'b1;
            state   <= FAILED;
        end
        if (!repeats) rounds <= '0;

        if (rst) begin
            state     <= IDLE;
            error     <= NONE;
            scl_out   <= 1'b1;
            sda_out   <= 1'b1;
            ended     <= 1'b0;
            bytes     <= '0;
            stretched <= '0;
        end
    end
endmodule

`default_nettype wire

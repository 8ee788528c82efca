// Generated from gateware/glint_soc/i2c.py by `cargo xtask pac`. Do not edit.
// Constants and types of the block's ports. docs/registers.md describes the registers.

`default_nettype none

package i2c_registers_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // Operations of a command.
    localparam logic [1:0] OPERATION_START = 2'd0;
    localparam logic [1:0] OPERATION_WRITE = 2'd1;
    localparam logic [1:0] OPERATION_READ = 2'd2;
    localparam logic [1:0] OPERATION_STOP = 2'd3;

    // Errors.
    localparam logic [2:0] ERROR_NONE = 3'd0;
    localparam logic [2:0] ERROR_ADDRESS = 3'd1;
    localparam logic [2:0] ERROR_BYTE = 3'd2;
    localparam logic [2:0] ERROR_CLOCK = 3'd3;
    localparam logic [2:0] ERROR_DATA = 3'd4;
    localparam logic [2:0] ERROR_LATE = 3'd5;

    // A command.
    typedef struct packed {
        logic more;
        logic [1:0] operation;
        logic [7:0] argument;
    } command_t;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

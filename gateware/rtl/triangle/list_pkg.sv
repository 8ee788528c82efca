// Generated from gateware/glint_soc/constants.py by `cargo xtask pac`. Do not edit.
// Places of the band lists in memory, in words of 16 bytes (docs/formats/triangle.md): behind the table of their lengths,
// and apart by their length and a row of a memory bank, so that the lists of eight bands lie in eight banks, which stay
// open. LiteDRAM puts BANK_WORDS neighbours into a row of a bank, and the next ones into the next bank.

`default_nettype none

package list_pkg;
    // A module uses only some of these constants.
    /* verilator lint_off UNUSEDPARAM */
    localparam int unsigned TABLE_WORDS = 16;
    localparam int unsigned BANK_WORDS = 128;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

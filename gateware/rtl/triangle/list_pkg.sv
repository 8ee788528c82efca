// Generated from gateware/glint_soc/constants.py by `cargo xtask pac`. Do not edit.
// Positions of the band lists in memory, in words of 16 bytes (docs/formats/triangle.md). The lists follow the table of
// their lengths. The distance between the starts of two lists is the maximum length of a list plus a row of a memory bank,
// so that the lists of eight bands lie in eight banks, whose rows stay open. LiteDRAM maps BANK_WORDS consecutive words to
// a row of a bank, and the following words to the next bank.

`default_nettype none

package list_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    localparam int unsigned TABLE_WORDS = 16;
    localparam int unsigned BANK_WORDS = 128;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire

// Where band lists are in memory, in words of 16 bytes (docs/formats.md): behind the table of their lengths, and further apart
// than they are long by a row of a bank of memory, so that the lists of eight bands lie in eight banks, which stay open.
// LiteDRAM puts BANK_WORDS neighbours into a row of a bank, and the next ones into the next bank.

`default_nettype none

package list_pkg;
    localparam int unsigned TABLE_WORDS = 16;
    localparam int unsigned BANK_WORDS  = 128;
endpackage

`default_nettype wire

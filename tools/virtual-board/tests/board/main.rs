//! Tests of the virtual board: the verilated SoC with its BIOS, firmware, or small programs, and the models of its peripherals.
//!
//! All tests are in one program, so that short tests run in parallel with the longest.

mod bios;
mod console;
mod faults;
mod firmware;
mod lockstep;
mod overlay;
mod pins;
mod program;
mod scan_out;
mod selftest;
mod sensor;
mod switching;
mod unused;

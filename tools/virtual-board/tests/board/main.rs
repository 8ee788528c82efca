//! Tests of the virtual board: the verilated SoC with its BIOS, firmware, or small programs, and the models of its peripherals.
//!
//! One test program has them all, so that short tests run beside the longest.

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

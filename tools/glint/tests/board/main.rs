//! Tests of the complete system: the virtual or the emulated board, its firmware, and the host's side of the serial line.
//!
//! The tests require the builds of `cargo xtask gateware` and `cargo xtask firmware`, which `cargo
//! xtask test` makes.

mod alone;
mod alone_verilated;
mod animation;
mod attitudes;
mod both;
mod common;
mod conversations;
mod debugger;
mod edges;
mod fields;
mod from_flash;
mod gesture;
mod interrupted;
mod meshes;
mod objects;
mod power_up;
mod quality;
mod samples;
mod scenes;
mod scripts;
mod sensor;
mod serial_boot;
mod soc;
mod stays;
mod stereo;
mod terminal;
mod transfers;
mod uploads;
mod windows;
mod wireframes;

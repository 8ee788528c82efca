//! The program on Glint's soft core: it starts the machine and then answers the console, draws what has changed and
//! shows it. Nothing here computes a picture; that is `glint-model`, and what it needs is `glint-core`.
//!
//! ```text
//! main ── start ── machine ──┬── terminal ── commands ──┬── scene, models
//!                            │                          ├── transfer (uploads, downloads)
//!                            ├── draw ── display        ├── bench, selftest
//!                            ├── imu (what the sensor's samples are for)
//!                            └── job (what a reply waits for)
//! interrupts: UART queues, vertical blanking, sensor        last_words: traps, panics
//! ```

#![no_std]
#![no_main]
#![deny(unsafe_code)]

mod appearance;
mod bench;
mod commands;
mod cube;
mod gateware;
mod imu;
#[allow(unsafe_code)] // Interrupts are let in.
mod interrupts;
#[allow(unsafe_code)] // The trap handler's name, and the UART taken from a program that has ended.
mod last_words;
#[allow(unsafe_code)] // It never returns, and says so.
mod machine;
#[allow(unsafe_code)] // Linker symbols as slices.
mod memory;
#[allow(unsafe_code)] // A mesh that outlives the borrow of its buffer.
mod models;
mod renderer;
mod replay;
mod scene;
mod selftest;
#[allow(unsafe_code)] // A future that the main loop keeps, for interrupts.
mod sensor;
#[allow(unsafe_code)] // The UART before it has an owner.
mod start;
mod terminal;
mod transfer;

#[riscv_rt::entry]
fn main() -> ! {
    match start::machine() {
        Ok(mut machine) => machine.run(),
        Err(fault) => last_words::farewell(format_args!("cannot start: {fault}")),
    }
}

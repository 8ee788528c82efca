//! The program of Glint's soft core: start, console, drawing and display.
//!
//! Pictures are computed by `glint-model` and the gateware, everything else by `glint-core`. In this diagram a module only imports modules
//! below it:
//!
//! ```text
//! start, main_loop (tasks), indicators (LEDs and digits)
//! commands (scene, options, upload, demo, imu, gesture, replay, frame, statistics, bench, machine)
//! selftest, job (replies, work that continues after a command)
//! error
//! machine (state) ─┬─ renderer, gateware, picture, models, objects, shapes, arena, memory
//!                  ├─ transfer, terminal
//!                  ├─ panel (switches, LEDs, digits), demo, scenes (built in and in the flash)
//!                  ├─ sensor, gesture, replay
//!                  └─ interrupts
//! panic (traps, panics)    bench (kernels)
//! ```

#![no_std]
#![no_main]
#![deny(unsafe_code)]

#[allow(unsafe_code)] // Divides memory into regions, moves and lends them.
mod arena;
mod bench;
mod commands;
mod cube;
mod demo;
mod error;
mod gateware;
mod gesture;
mod indicators;
#[allow(unsafe_code)] // Enables interrupts.
mod interrupts;
mod job;
mod machine;
#[allow(unsafe_code)] // Starts the sensor's stream in a function that does not return.
mod main_loop;
mod marker;
#[allow(unsafe_code)] // Makes slices of the memory at linker symbols.
mod memory;
#[allow(unsafe_code)] // Keeps meshes and programs beyond the borrow of their memory.
mod models;
mod names;
#[allow(unsafe_code)] // Keeps copies of meshes beyond the borrow of their memory.
mod objects;
mod overlay;
mod panel;
#[allow(unsafe_code)] // Exports the trap handler's symbol, and takes the UART after a panic.
mod panic;
mod picture;
mod renderer;
mod replay;
mod scenes;
mod selftest;
#[allow(unsafe_code)] // Polls a pinned future from interrupts.
mod sensor;
mod shapes;
#[allow(unsafe_code)] // Uses the UART before it has an owner.
mod start;
mod terminal;
mod transfer;
mod wireframe;

use main_loop::MainLoop;

#[riscv_rt::entry]
fn main() -> ! {
    match start::machine() {
        Ok(machine) => MainLoop::new(machine).run(),
        Err(error) => panic::report(format_args!("cannot start: {error}")),
    }
}

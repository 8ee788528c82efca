//! The program of Glint's soft core: start, console, drawing and display.
//!
//! `glint-program` starts the hardware and draws pictures, by the gateware or by `glint-model`; `glint-core` computes everything else. In
//! this diagram a module only imports modules below it:
//!
//! ```text
//! start, main_loop (tasks), indicators (LEDs and digits)
//! commands (scene, options, upload, demo, imu, gesture, replay, frame, statistics, bench, machine)
//! selftest, job (replies, work that continues after a command)
//! error
//! renderer (frames of the scene)
//! machine (state) ─┬─ picture, overlay, models, objects, arena
//!                  ├─ transfer, terminal
//!                  ├─ panel (switches, LEDs, digits), demo, scenes (built in and in the flash)
//!                  └─ replay
//! bench (kernels)
//! ```

#![no_std]
#![no_main]
#![deny(unsafe_code)]

#[allow(unsafe_code)] // Divides memory into regions, moves and lends them.
mod arena;
mod bench;
mod commands;
mod demo;
mod error;
mod indicators;
mod job;
mod machine;
#[allow(unsafe_code)] // Starts the sensor's stream in a function that does not return.
mod main_loop;
#[allow(unsafe_code)] // Keeps meshes and programs beyond the borrow of their memory.
mod models;
mod names;
#[allow(unsafe_code)] // Keeps copies of meshes beyond the borrow of their memory.
mod objects;
mod overlay;
mod panel;
mod picture;
mod renderer;
mod replay;
mod scenes;
mod selftest;
mod start;
mod terminal;
mod transfer;
mod wireframe;

use glint_program::panic;
use main_loop::MainLoop;

#[riscv_rt::entry]
fn main() -> ! {
    match start::machine() {
        Ok(machine) => MainLoop::new(machine).run(),
        Err(error) => panic::report(format_args!("cannot start: {error}")),
    }
}

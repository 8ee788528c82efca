//! The virtual board: Glint's verilated SoC, and models of its peripheral devices.
//!
//! `cargo xtask gateware` compiles the SoC to a shared library. This crate loads it, drives its clocks and pins, and models its
//! devices: a UART as a byte stream ([`VirtualBoard::uart_write`], or on a pseudo-terminal with [`pty::Pty`]), buttons, switches,
//! LEDs, digits, a SPI flash ([`VirtualBoard::plug_flash`]), an MPU-6050 ([`VirtualBoard::plug`]), an image sensor
//! ([`VirtualBoard::plug_image_sensor`]), and a [`Monitor`] that checks the video timing and captures pictures. Back-door accesses read
//! and write DDR3 at run time, coherently with the CPU's caches.
//!
//! ```no_run
//! use virtual_board::{Start, Uart, VirtualBoard};
//!
//! # fn main() -> Result<(), virtual_board::Error> {
//! let mut board = VirtualBoard::builder().start(Start::Full).build()?;
//! let boot = board.read_until("litex\x1b[0m> ", 60_000_000)?;
//! println!("{boot}{:.0} cycles/s", board.cycles_per_second());
//! # Ok(()) }
//! ```
//!
//! # Time
//! One cycle is one period of the SoC's system clock, by default 1/81.25 MHz; the pixel clock has exactly 74.25 MHz.
//! Results do not depend on wall time: equal calls give equal boards, cycle by cycle. On a pseudo-terminal, a board runs at most as fast
//! as in reality ([`glint_board_api::pace::Pace`]).
//!
//! # Limits
//! The UART transfers one byte per cycle, whereas a serial line needs 7053 cycles of 1/81.25 MHz, so output arrives earlier than on a real
//! board. Waveforms need the library built by `cargo xtask gateware --waveforms`.

mod board;
mod boot;
mod digits;
mod error;
mod library;
mod memory;
mod monitor;
mod picture;
pub mod pty;

pub use board::{Builder, Start, VirtualBoard};
pub use error::Error;
pub use glint_board_api::{Simulation, Uart};
pub use library::Instruction;
pub use monitor::{HEIGHT, Monitor, TimingError, WIDTH};
pub use picture::{Picture, PictureError};
pub use virtual_flash;
pub use virtual_image_sensor;
pub use virtual_mpu6050;

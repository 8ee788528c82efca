//! The virtual board: Glint's verilated SoC with everything around it that a real board has.
//!
//! `cargo xtask gateware` compiles the SoC to a shared library; this crate loads it, owns its clocks and pins, and
//! models what is plugged in: a UART as a byte stream ([`VirtualBoard::uart_write`], or on a pseudo-terminal with
//! [`pty::Pty`]), buttons, switches, LEDs, an MPU-6050 ([`VirtualBoard::plug`]), and a [`Monitor`] that checks the video timing and captures pictures.
//! A back door reads and writes DDR3 at run time, coherent with the CPU's caches.
//!
//! ```no_run
//! use virtual_board::{Start, VirtualBoard};
//!
//! # fn main() -> Result<(), virtual_board::Error> {
//! let mut board = VirtualBoard::builder().start(Start::Full).build()?;
//! let boot = board.read_until("litex\x1b[0m> ", 60_000_000)?;
//! println!("{boot}{:.0} cycles/s", board.cycles_per_second());
//! # Ok(()) }
//! ```
//!
//! # Time
//! One cycle is one period of the SoC's system clock, 1/81.25 MHz; the pixel clock runs along at exactly 297/325 of
//! it. Nothing here depends on wall time: the same calls give the same board, cycle by cycle.
//!
//! # Limits
//! The UART moves a byte in a cycle where a serial line needs 7053, so what a program sends arrives sooner than on a
//! real board. Waveforms need the library of `cargo xtask gateware --waveforms`.

mod board;
mod boot;
mod error;
mod library;
mod monitor;
mod picture;
pub mod pty;

pub use board::{Builder, Start, VirtualBoard};
pub use error::Error;
pub use monitor::{HEIGHT, Monitor, TimingError, WIDTH};
pub use picture::{Picture, PictureError};
pub use virtual_mpu6050;

//! The emulated board: runs the firmware of the real board at about real-time speed.
//!
//! ```
//! use emulated_board::{EmulatedBoard, Uart};
//!
//! // An endless loop as firmware.
//! let mut board = EmulatedBoard::fast(&0x0000_006f_u32.to_le_bytes())?;
//! board.run(1000);
//! assert!(board.instructions() > 0);
//! # Ok::<(), emulated_board::Error>(())
//! ```
//!
//! docs/emulated-board.md states which results are exact and which are estimates.

#![forbid(unsafe_code)]

mod board;
mod bus;
mod cpu;
mod csr;
mod debug;
mod decode;
mod device;
mod devices;
mod engines;
mod error;
mod events;
mod instruction_cache;
mod memory;

pub use board::EmulatedBoard;
pub use cpu::{Difference, Executed};
pub use device::Device;
pub use engines::{GestureEngine, Raymarcher, TriangleEngine};
pub use error::Error;
pub use events::Events;
pub use glint_board_api::{Frame, Simulation, Uart};
pub use memory::MainMemory;
pub use virtual_image_sensor;
pub use virtual_mpu6050;

/// The time in ns at cycle `now` of the system clock.
fn nanoseconds(now: u64) -> u64 {
    const SECOND: u64 = 1_000_000_000;
    const CLOCK: u64 = litex_pac::constants::CONFIG_CLOCK_FREQUENCY as u64;
    // With the fraction in lowest terms, the product stays below 2^64 for years, so a 64-bit division suffices.
    const COMMON: u64 = greatest_common_divisor(SECOND, CLOCK);
    now * (SECOND / COMMON) / (CLOCK / COMMON)
}

const fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    match b {
        0 => a,
        _ => greatest_common_divisor(b, a % b),
    }
}

//! Drivers for the peripherals of Glint's SoC behind `embedded-hal` 1.0 and `embedded-io` 0.7.
//!
//! | module | what it drives | traits |
//! |---|---|---|
//! | [`timer`] | the uptime counter of `timer0` | [`DelayNs`](embedded_hal::delay::DelayNs) |
//! | [`uart`] | `uart`, by interrupts and queues | [`Read`](embedded_io::Read), [`Write`](embedded_io::Write), both with time-outs |
//! | [`i2c`] | `i2c`, by a queue of commands | [`I2c`](embedded_hal::i2c::I2c), which waits, and [`I2c`](embedded_hal_async::i2c::I2c), which does not |
//! | [`gpio`] | `buttons`, `switches`, `leds` | [`InputPin`](embedded_hal::digital::InputPin), [`StatefulOutputPin`](embedded_hal::digital::StatefulOutputPin) |
//! | [`interrupt`] | the CPU's interrupt lines | |
//! | [`display`] | `scanout` and its two frames | |
//! | [`triangle`] | `triangle`, the engine that draws meshes | |
//! | [`raymarch`] | `raymarch`, which draws distance fields into its frames | |
//!
//! Registers are reached through `litex-pac` alone, which on a host has a modelled bus: the tests run these drivers
//! unchanged.

#![no_std]

#[cfg(test)]
extern crate std;

pub mod display;
pub mod gpio;
pub mod i2c;
pub mod interrupt;
pub mod raymarch;
pub mod timer;
pub mod triangle;
pub mod uart;

use core::fmt;

/// A block's `ident` is not its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Absent {
    /// What `ident` reads where the block is present: four letters of ASCII.
    pub expected: u32,
    /// What it reads; 0 where the block was left out.
    pub found: u32,
}

impl fmt::Display for Absent {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { expected, found } = self;
        write!(f, "expected ident {expected:#010x}, found {found:#010x}")
    }
}

impl core::error::Error for Absent {}

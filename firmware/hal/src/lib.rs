//! Drivers for the peripherals of Glint's SoC behind `embedded-hal` 1.0 and `embedded-io` 0.7.
//!
//! | module | peripheral | traits |
//! |---|---|---|
//! | [`timer`] | the uptime counter of `timer0` | [`DelayNs`](embedded_hal::delay::DelayNs) |
//! | [`frequency`] | the clock frequency that `identity` states | |
//! | [`uart`] | `uart`, by interrupts and queues | [`Read`](embedded_io::Read), [`Write`](embedded_io::Write), both with timeouts |
//! | [`i2c`] | `i2c`, by queued commands | [`I2c`](embedded_hal::i2c::I2c), blocking, and [`I2c`](embedded_hal_async::i2c::I2c), async |
//! | [`gpio`] | `buttons`, `switches`, `leds` | [`InputPin`](embedded_hal::digital::InputPin), [`StatefulOutputPin`](embedded_hal::digital::StatefulOutputPin) |
//! | [`digits`] | `digits`, two displays of four digits | |
//! | [`flash`] | the window of the SPI flash | |
//! | [`interrupt`] | the CPU's interrupt lines | |
//! | [`scanout`] | `scanout` and its two frames | |
//! | [`triangle`] | `triangle`, the engine that draws meshes | |
//! | [`gesture`] | `gesture`, which counts the pixels of a hand in the frames of an image sensor, and the sensor's pins | |
//! | [`raymarch`] | `raymarch`, which draws distance fields into the frames of `triangle` | |
//!
//! Drivers depend only on registers (`litex-pac`) and numbers; `glint-engines` connects them to scenes, frames and the hand. On a
//! host a model replaces the bus, so tests run the same drivers.

#![no_std]

#[cfg(test)]
extern crate std;

mod absent;
pub mod digits;
pub mod flash;
pub mod frequency;
pub mod gesture;
pub mod gpio;
pub mod i2c;
pub mod interrupt;
pub mod raymarch;
pub mod scanout;
pub mod timer;
pub mod triangle;
pub mod uart;

pub use absent::Absent;

//! The optional blocks of a gateware.
// Generated from gateware/glint_soc/register_map.py by `cargo xtask pac`. Do not edit.

use crate::choice::choices;

/// An optional block. The discriminant is the number of its bit among the block enable bits (`identity.blocks`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Block {
    /// The scan-out.
    Scanout = 0,
    /// The triangle engine.
    Triangle = 1,
    /// The raymarcher.
    Raymarch = 2,
    /// The line engine, a part of the triangle engine.
    Line = 3,
    /// The gesture engine.
    Gesture = 4,
    /// The SPI flash, readable in a memory window.
    Flash = 5,
    /// The I2C master, for the motion sensor.
    I2C = 6,
    /// The seven-segment displays.
    Digits = 7,
}

choices!(Block {
    Scanout: "scanout",
    Triangle: "triangle",
    Raymarch: "raymarch",
    Line: "line",
    Gesture: "gesture",
    Flash: "flash",
    I2C: "i2c",
    Digits: "digits",
});

impl Block {
    /// Returns the block's bit among the block enable bits, as a mask.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }

    /// Yields the blocks whose bits are set in `bits`.
    pub fn of_bits(bits: u32) -> impl Iterator<Item = Self> {
        let all = Self::ALL.into_iter();
        all.filter(move |block| block.bit() & bits != 0)
    }
}

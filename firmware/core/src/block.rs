//! The optional blocks of a gateware.

use crate::choice::choices;

/// An optional block. The discriminant is the number of its bit among the block enable bits (`identity.blocks`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Block {
    /// The scan-out.
    Scanout,
    /// The triangle engine.
    Triangle,
    /// The raymarcher.
    Raymarch,
    /// The line engine, a part of the triangle engine.
    Line,
    /// The gesture engine.
    Gesture,
    /// The SPI flash in a window of memory.
    Flash,
}

choices!(Block {
    Scanout: "scanout",
    Triangle: "triangle",
    Raymarch: "raymarch",
    Line: "line",
    Gesture: "gesture",
    Flash: "flash",
});

impl Block {
    /// The block's bit among the block enable bits.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }
}

//! Memories of the SoC.

/// A memory on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Address of its first byte.
    pub base: u32,
    /// Its size in bytes.
    pub size: u32,
}

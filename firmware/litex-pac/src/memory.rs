//! The type that describes a memory of the SoC.

/// Address and size of a memory on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Address of the first byte.
    pub base: u32,
    /// Size in bytes.
    pub size: u32,
}

//! Optional blocks of the SoC.

use core::fmt;

/// Error: this SoC lacks a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Absent {
    /// `ident` of a present block: four letters of ASCII.
    pub expected: u32,
    /// `ident` as read; 0 if the SoC lacks the block.
    pub found: u32,
}

impl Absent {
    /// Compares a block's `ident`.
    pub(crate) const fn check(found: u32, expected: u32) -> Result<(), Self> {
        if found == expected {
            Ok(())
        } else {
            Err(Self { expected, found })
        }
    }
}

impl fmt::Display for Absent {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { expected, found } = self;
        write!(f, "expected ident {expected:#010x}, found {found:#010x}")
    }
}

impl core::error::Error for Absent {}

//! The error for an optional block that the SoC lacks.

use core::fmt;

/// Error: this SoC lacks a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Absent {
    /// Value of the register `ident` if the block is present: four ASCII letters.
    pub expected: u32,
    /// Value read from the register `ident`; 0 if the SoC lacks the block.
    pub found: u32,
}

impl Absent {
    /// Checks the value `found` of a block's register `ident`.
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

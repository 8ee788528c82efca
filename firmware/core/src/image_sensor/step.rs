//! The steps of a set-up.

/// A step of a set-up.
#[derive(Clone, Copy, Debug)]
pub enum SetupStep {
    /// Writes a value to the register with this number.
    Write(u16, u8),
    /// Writes a value, reads it back, and fails if it differs.
    Check(u16, u8),
    /// Waits for this number of milliseconds.
    Wait(u32),
}

//! The steps of an image sensor's set-up.

/// A register access or a wait in an image sensor's set-up.
#[derive(Clone, Copy, Debug)]
pub enum SetupStep {
    /// Writes a value to the register with this number.
    Write(u16, u8),
    /// Writes a value, reads it back, and fails if it differs.
    Check(u16, u8),
    /// Waits for this number of milliseconds.
    Wait(u32),
}

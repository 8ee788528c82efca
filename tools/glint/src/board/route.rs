//! Routes of data to and from a board.

use super::name::BoardName;

/// The route of data to and from a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Route {
    /// Over the serial line.
    Serial,
    /// Directly through the memory of a simulated board: the emulated or the virtual board.
    Memory,
}

impl Route {
    /// The fastest route of the board `name`.
    pub const fn of(board: &BoardName) -> Self {
        match board {
            BoardName::Emulated | BoardName::Virtual => Self::Memory,
            BoardName::Serial(_) => Self::Serial,
        }
    }
}

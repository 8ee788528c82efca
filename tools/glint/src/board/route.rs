//! Channels of data into and out of a board.

use super::name::BoardName;

/// The route by which data get into and out of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Route {
    /// Over the serial line.
    Serial,
    /// Directly through the simulated memory, which the emulated and the virtual board offer.
    Memory,
}

impl Route {
    /// The fastest route of a board.
    pub const fn of(board: &BoardName) -> Self {
        match board {
            BoardName::Emulated | BoardName::Virtual => Self::Memory,
            BoardName::Serial(_) => Self::Serial,
        }
    }
}

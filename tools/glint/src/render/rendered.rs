//! Drawn frames, and errors in drawing them.

use super::stats::Stats;
use crate::board::BoardError;
use crate::console::ConsoleError;
use crate::error::InputError;
use crate::picture::Image;
use crate::transfer::TransferError;
use glint_model::RenderError;

/// The parts of a drawn frame that the caller requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// Whether the colours are requested.
    pub colour: bool,
    /// Whether the depth codes are requested.
    pub depth: bool,
}

impl Parts {
    /// Only the statistics.
    pub const NONE: Self = Self::new(false, false);
    /// The colours.
    pub const COLOUR: Self = Self::new(true, false);
    /// Colours and depth codes.
    pub const ALL: Self = Self::new(true, true);

    const fn new(colour: bool, depth: bool) -> Self {
        Self { colour, depth }
    }
}

/// A drawn frame.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The requested colours and depth codes.
    pub image: Image,
    /// Cycles and counts of the frame.
    pub stats: Stats,
}

/// An error of drawing or transferring a frame.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A frame that exceeds the limits of the model.
    #[error("{0}")]
    Render(RenderError),
    /// An error of the line to the board.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// An error of the board's console.
    #[error(transparent)]
    Console(#[from] ConsoleError),
    /// A mesh of a scene cannot be read.
    #[error(transparent)]
    Input(#[from] InputError),
    /// An error of an upload or a download.
    #[error(transparent)]
    Transfer(#[from] TransferError),
}

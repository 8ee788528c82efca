//! The interface of the renderers: the model and boards.

use super::stats::Stats;
use crate::board::BoardError;
use crate::console::ConsoleError;
use crate::error::InputError;
use crate::picture::Image;
use crate::transfer::{Progress, TransferError};
use glint_model::{Frame, RenderError};

/// A renderer of frames: the model in this process, or a board.
pub trait Renderer {
    /// Draws a frame, and returns its requested parts.
    ///
    /// # Errors
    /// The frame exceeds the renderer's limits, or the board does not answer.
    fn render(
        &mut self,
        frame: &Frame,
        parts: Parts,
        progress: &mut Progress,
    ) -> Result<Rendered, Error>;
}

/// The parts of a drawn frame that the caller requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// Whether the colours are requested.
    pub colour: bool,
    /// Whether the depth codes are requested.
    pub depth: bool,
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

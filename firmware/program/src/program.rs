//! The interface that a program implements.

use crate::board::Board;
use crate::canvas::Canvas;
use crate::picture::{Picture, PictureError};

/// A program. For each picture [`update`](Self::update), [`draw`](Self::draw) and [`paint`](Self::paint) are called in this order; the
/// picture is then shown from the next vertical blanking on.
pub trait Program: Sized {
    /// The program after reset.
    fn start(board: &mut Board) -> Self;

    /// Moves the program to the time of its next picture, by the board's input.
    fn update(&mut self, board: &mut Board);

    /// Describes the next picture. The description may borrow meshes, textures, fields and lines of the program, which the engines read
    /// while they draw.
    ///
    /// # Errors
    /// [`PictureError`] stops the program, with the error on the console.
    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError>;

    /// Paints text and flat shapes on the picture that the engines have drawn. By default nothing.
    fn paint(&self, canvas: &mut Canvas) {
        let _ = canvas;
    }
}

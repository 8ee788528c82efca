//! What the pixels of a picture show.

use glint_core::picture::Size;

use crate::raymarch::Face;

/// The size in which a monitor shows every picture.
pub const SHOWN: Size = Size::W1280;

/// Surface that an eye sees at a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seen {
    /// No surface.
    #[default]
    Background,
    /// A triangle.
    Triangle {
        /// Number of the object, from 0.
        object: usize,
        /// Number of the triangle in its mesh.
        index: usize,
    },
    /// A surface of a field.
    Surface {
        /// The face, by the direction of its normal.
        face: Face,
        /// Number of the sphere; 0 for other surfaces.
        sphere: usize,
    },
    /// A line of a wireframe.
    Line,
}

/// Surfaces that both eyes see at a pixel; with one eye both are the same.
pub type Eyes = [Seen; 2];

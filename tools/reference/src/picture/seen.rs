//! Surfaces visible at the pixels of a picture.

use glint_core::picture::Size;

use crate::raymarch::Face;

/// The size of every picture on the monitor.
pub const SHOWN: Size = Size::W1280;

/// Surface visible to an eye at a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seen {
    /// No surface.
    #[default]
    Background,
    /// A triangle.
    Triangle {
        /// Index of the object.
        object: usize,
        /// Index of the triangle in its mesh.
        index: usize,
    },
    /// A surface of a field.
    Surface {
        /// The face, by the direction of its normal.
        face: Face,
        /// Index of the sphere; 0 for other surfaces.
        sphere: usize,
    },
    /// A line of a wireframe.
    Line,
}

/// Surfaces visible to the left and the right eye at a pixel; equal in a mono picture.
pub type Eyes = [Seen; 2];

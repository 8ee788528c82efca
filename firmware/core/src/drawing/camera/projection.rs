//! Kinds of projections.

use crate::choice::choices;

/// Projection of the world to the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// All lines of sight pass through the eye.
    #[default]
    Perspective,
    /// Lines of sight are parallel to n, so sizes on the screen do not depend on the distance.
    Orthographic,
}

choices!(Projection {
    Perspective: "perspective",
    Orthographic: "orthographic",
});

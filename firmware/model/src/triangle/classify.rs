//! The next step for a triangle after the vertex stage: cull, set up or clip.

use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::vertex::{Projected, ScreenVertex};

/// The next step for a triangle after the vertex stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path<'a> {
    /// Not drawn: the triangle is completely beyond one side of the picture, or behind the near plane.
    Unseen,
    /// Passed to the triangle setup without clipping.
    Regular([&'a ScreenVertex; 3]),
    /// Clipped before the setup, because the triangle crosses the near plane or leaves the guard band.
    Exception,
}

impl<'a> Path<'a> {
    /// Classifies the triangle with these vertices.
    #[inline]
    pub fn of(frame: &MeshSetup, vertices: [&'a Projected; 3]) -> Self {
        match vertices.map(Projected::place) {
            [None, None, None] => Path::Unseen,
            [Some(a), Some(b), Some(c)] if off_screen(frame, [a, b, c]) => Path::Unseen,
            [Some(p), Some(q), Some(r)] if !vertices.iter().any(|v| v.is_beyond_guard()) => {
                Path::Regular([p, q, r])
            }
            _ => Path::Exception,
        }
    }
}

/// Whether all vertices are beyond the same side of the picture.
#[inline]
fn off_screen(frame: &MeshSetup, [a, b, c]: [&ScreenVertex; 3]) -> bool {
    // The bitwise AND of numbers is negative if all of them are negative.
    let off = |[a, b, c]: [i32; 3], size: u32| {
        let last = (size << 8) as i32 - 1;
        a & b & c < 0 || (last - a) & (last - b) & (last - c) < 0
    };
    off([a.x, b.x, c.x], frame.width) || off([a.y, b.y, c.y], frame.height)
}

//! The path of a triangle after the vertex stage.

use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::vertex::{Projected, ScreenVertex};

/// The path of a triangle after the vertex stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path<'a> {
    /// Not drawn, because the triangle lies wholly beyond one side of the picture or behind the near plane.
    Unseen,
    /// Drawn whole: goes to the triangle setup.
    Regular([&'a ScreenVertex; 3]),
    /// Clipped first, because the triangle crosses the near plane or leaves the guard band.
    Exception,
}

impl<'a> Path<'a> {
    /// The path of a triangle with these vertices.
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

/// Whether all vertices lie beyond the same side of the picture.
#[inline]
fn off_screen(frame: &MeshSetup, [a, b, c]: [&ScreenVertex; 3]) -> bool {
    // The bitwise AND of numbers is negative if all of them are negative.
    let off = |[a, b, c]: [i32; 3], size: u32| {
        let last = (size << 8) as i32 - 1;
        a & b & c < 0 || (last - a) & (last - b) & (last - c) < 0
    };
    off([a.x, b.x, c.x], frame.width) || off([a.y, b.y, c.y], frame.height)
}

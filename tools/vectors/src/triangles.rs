//! Triangles in screen coordinates, for tests of triangle setup and of the walker.

use glint_model::triangle::setup::{Bounds, Oriented, Setup};
use glint_model::triangle::vertex::GUARD;
use glint_model::{SIZES, ScreenVertex};

use crate::random::Random;

/// Width and height of the triangles' picture in pixels.
pub const SIZE: (u32, u32) = SIZES[0];
/// Depth of all vertices, in the format of `ScreenVertex::w`.
pub const FLAT: u32 = 1000 * 64;

/// Makes a vertex at the position (`x`, `y`) in units of 1/256 pixel, with the depth [`FLAT`].
pub fn at([x, y]: [i64; 2]) -> ScreenVertex {
    ScreenVertex {
        x: x as i32,
        y: y as i32,
        w: FLAT,
    }
}

/// Sets up a triangle for a picture of the given size. Returns `None` if the triangle has no area, or no pixel centre of the
/// picture in its bounds.
pub fn set_up(
    vertices: [ScreenVertex; 3],
    (width, height): (u32, u32),
) -> Option<(Oriented, Setup)> {
    let oriented = Oriented::new(vertices)?;
    let bounds = Bounds::new(&oriented.vertices, width, height)?;
    Some((oriented, Setup::new(&oriented, bounds)))
}

/// Makes a random triangle of any size and shape: many have vertices on pixel centres and edges, some cover the whole guard band.
pub fn random_triangle(random: &mut Random) -> [ScreenVertex; 3] {
    let guard = i64::from(GUARD) + 128;
    let anywhere =
        |random: &mut Random| at([random.integer(-guard, guard), random.integer(-guard, guard)]);
    let near = |random: &mut Random, reach: i64, step: i64| {
        at([160, 90].map(|c| 256 * c + step * random.integer(-reach / step, reach / step)))
    };
    match random.integer(0, 5) {
        0 => [0; 3].map(|_| anywhere(random)),
        1 => [0; 3].map(|_| near(random, 256 * 100, 1)),
        2 => [0; 3].map(|_| near(random, 256 * 4, 1)),
        3 => [0; 3].map(|_| near(random, 256 * 6, 128)),
        4 => [
            near(random, 256 * 80, 1),
            anywhere(random),
            anywhere(random),
        ],
        _ => {
            // Makes a sliver: the third vertex `c` is near the midpoint of `a` and `b`.
            let (a, b) = (near(random, 256 * 200, 1), near(random, 256 * 200, 1));
            let c = ScreenVertex {
                x: (a.x + b.x) / 2 + random.integer(-3, 3) as i32,
                y: (a.y + b.y) / 2,
                w: FLAT,
            };
            [a, b, c]
        }
    }
}

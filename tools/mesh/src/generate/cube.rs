//! The cube: six squares of six colours.

use super::builder::Builder;
use crate::error::FormatError;
use crate::polygons::{Polygons, Rgb8, Vector};

/// The cube of edge 1 about the origin.
pub fn cube() -> Result<Polygons, FormatError> {
    let mut builder = Builder::default();
    let colours = [
        Rgb8([0xe0, 0x58, 0x48]),
        Rgb8([0x48, 0xb0, 0xc8]),
        Rgb8([0x60, 0xc0, 0x58]),
        Rgb8([0xc8, 0x68, 0xc8]),
        Rgb8([0xf0, 0xc0, 0x48]),
        Rgb8([0x58, 0x70, 0xe0]),
    ];
    for (side, colour) in colours.into_iter().enumerate() {
        let (axis, outward): (usize, f64) = (side / 2, if side % 2 == 0 { 0.5 } else { -0.5 });
        // On the side at +0.5 the corners run counter-clockwise about the axis. On the side at −0.5 one coordinate is mirrored,
        // which reverses their order.
        let square = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[a, b]| -> Vector {
            let mut point = [0.0; 3];
            point[axis] = outward;
            point[(axis + 1) % 3] = a * outward.signum();
            point[(axis + 2) % 3] = b;
            point
        });
        builder.face(&square, Some(colour))?;
    }
    Ok(builder.finish())
}

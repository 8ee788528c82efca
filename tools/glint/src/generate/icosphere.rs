//! The icosphere: an icosahedron whose triangles are cut in four again and again.

use super::builder::Builder;
use crate::error::FormatError;
use crate::polygons::{Polygons, Rgb8, Vector};
use crate::triangulate::unit;

/// The sphere of radius 1 with 20·4^level triangles, coloured by direction.
pub fn icosphere(level: u32) -> Result<Polygons, FormatError> {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    // Twelve points: the cyclic shifts of (0, ±1, ±golden).
    let corner = |axis: usize, a: f64, b: f64| -> Vector {
        let mut point = [0.0; 3];
        point[(axis + 1) % 3] = a;
        point[(axis + 2) % 3] = b * golden;
        normalised(point)
    };
    let mut builder = Builder::default();
    let mut emit = |triangle: [Vector; 3]| split(&mut builder, triangle, level);
    for sign in [1.0, -1.0] {
        for axis in 0..3 {
            // The two triangles on the edge between (0, 1, golden) and (0, -1, golden) …
            for side in [1.0, -1.0] {
                let tip = corner((axis + 1) % 3, sign, side);
                let (a, b) = (
                    corner(axis, sign * side, sign),
                    corner(axis, -sign * side, sign),
                );
                emit(facing_out([a, b, tip]))?;
            }
        }
    }
    // … and one in each of the eight octants.
    for octant in 0..8 {
        let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let [x, y, z] = [sign(0), sign(1), sign(2)];
        emit(facing_out([
            corner(0, y, z),
            corner(1, z, x),
            corner(2, x, y),
        ]))?;
    }
    Ok(builder
        .coloured(|[x, y, z]| Rgb8::from_unit([0.66 + 0.3 * x, 0.66 + 0.3 * y, 0.66 + 0.3 * z])))
}

fn normalised(point: Vector) -> Vector {
    unit(point).unwrap_or(point)
}

/// The same triangle, counter-clockwise seen from outside a body about the origin.
fn facing_out([a, b, c]: [Vector; 3]) -> [Vector; 3] {
    use crate::triangulate::{cross, dot};
    if dot(a, cross(b, c)) > 0.0 {
        [a, b, c]
    } else {
        [a, c, b]
    }
}

fn split(builder: &mut Builder, triangle: [Vector; 3], level: u32) -> Result<(), FormatError> {
    let Some(level) = level.checked_sub(1) else {
        return builder.face(&triangle, None);
    };
    let [a, b, c] = triangle;
    // The sum of two numbers has no order, so both triangles on an edge get the same bits.
    let middle = |p: Vector, q: Vector| normalised([p[0] + q[0], p[1] + q[1], p[2] + q[2]]);
    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
    for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
        split(builder, part, level)?;
    }
    Ok(())
}

//! The icosphere of frequency f: an icosahedron whose edges are divided into f parts, with all
//! points projected to the sphere.

use super::builder::Builder;
use crate::error::FormatError;
use crate::polygons::{Polygons, Rgb8, Vector};
use crate::triangulate::unit;

/// The sphere of radius 1 with 20·frequency² triangles. The colour of a point depends on its
/// direction.
pub fn icosphere(frequency: u32) -> Result<Polygons, FormatError> {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    // Twelve points: the cyclic shifts of (0, ±1, ±golden).
    let corner = |axis: usize, a: f64, b: f64| -> Vector {
        let mut point = [0.0; 3];
        point[(axis + 1) % 3] = a;
        point[(axis + 2) % 3] = b * golden;
        normalised(point)
    };
    let mut builder = Builder::default();
    let mut emit = |triangle: [Vector; 3]| divide(&mut builder, triangle, frequency);
    for sign in [1.0, -1.0] {
        for axis in 0..3 {
            // Two triangles meet at each of six edges, such as the edge between (0, 1, golden) and
            // (0, -1, golden).
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
    // The other eight triangles lie in one octant each.
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

/// Orders the corners of a triangle counter-clockwise as seen from outside of a solid about the
/// origin.
fn facing_out([a, b, c]: [Vector; 3]) -> [Vector; 3] {
    use crate::triangulate::{cross, dot};
    if dot(a, cross(b, c)) > 0.0 {
        [a, b, c]
    } else {
        [a, c, b]
    }
}

/// Divides each edge of a triangle into `frequency` parts, and adds the resulting frequency² triangles, with their points projected to the
/// sphere.
fn divide(
    builder: &mut Builder,
    [a, b, c]: [Vector; 3],
    frequency: u32,
) -> Result<(), FormatError> {
    // Returns a point of the sphere. The arguments are the weights of `b` and `c`; the weight of `a` is `frequency` minus both. On an edge
    // one of the three weights is zero and the sum of the other two does not depend on their order, so both triangles at the edge get
    // identical points.
    let point = |to_b: u32, to_c: u32| -> Vector {
        let weights = [frequency - to_b - to_c, to_b, to_c].map(f64::from);
        normalised(
            [0, 1, 2]
                .map(|axis| weights[0] * a[axis] + weights[1] * b[axis] + weights[2] * c[axis]),
        )
    };
    for i in 0..frequency {
        for j in 0..frequency - i {
            builder.face(&[point(i, j), point(i + 1, j), point(i, j + 1)], None)?;
            if i + j + 2 <= frequency {
                builder.face(
                    &[point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)],
                    None,
                )?;
            }
        }
    }
    Ok(())
}

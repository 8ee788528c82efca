//! Tests of the model against f64, a simple rasterizer and known pictures.
//!
//! All tests are in one program, to avoid linking one program per file.

mod clipping;
mod depth;
mod descriptor;
mod exits;
mod frame;
mod light;
mod line;
mod mesh_in_field;
mod objects;
mod orthographic;
mod palette;
mod projection;
mod reciprocal;
mod render;
mod selftest;
mod smooth;
mod stereo;
mod textured;
mod volume;
mod walker;
mod winding;
mod wireframe;

use glint_core::fixed::Q8_24;
use glint_core::matrix::Matrix;
use glint_core::mesh::Mesh;
use glint_model::{MeshSubject, Object, Placement, ScreenVertex};

/// Converts a number to an entry of a matrix.
fn number(x: f64) -> Q8_24 {
    Q8_24::from_num(x)
}

fn object(mesh: Mesh, matrix: Matrix) -> Object {
    Object {
        subject: MeshSubject::new(mesh),
        placement: Placement::new(matrix),
        colour: None,
    }
}

/// Transforms a point by a matrix.
fn applied(matrix: &Matrix, point: [f64; 3]) -> [f64; 3] {
    let rows = matrix.linear().map(|row| row.map(Q8_24::to_num::<f64>));
    let place = matrix.place().map(Q8_24::to_num::<f64>);
    [0, 1, 2].map(|i| glint_vectors::math::dot(rows[i], point) + place[i])
}

/// Error of a position on the screen, in 1/256 pixel.
fn error(found: ScreenVertex, [x, y, _]: [f64; 3]) -> f64 {
    let error = |found: i32, exact: f64| (f64::from(found) - 256.0 * exact).abs();
    error(found.x, x).max(error(found.y, y))
}

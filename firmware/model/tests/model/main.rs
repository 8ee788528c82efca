//! Tests of the model, compared with f64 arithmetic, a simple rasterizer and known pictures.
//!
//! All tests are in one program, to avoid linking one program per file.

mod clipping;
mod depth;
mod descriptor;
mod dither;
mod exits;
mod fog;
mod frame;
mod light;
mod line;
mod mesh_in_field;
mod objects;
mod orthographic;
mod palette;
mod projection;
mod reciprocal;
mod rectangles;
mod render;
mod samples;
mod selftest;
mod sky;
mod smooth;
mod stereo;
mod textured;
mod volume;
mod walker;
mod winding;
mod windows;
mod wireframe;

use glint_core::fixed::Q8_24;
use glint_core::matrix::Matrix;
use glint_core::mesh::Mesh;
use glint_model::triangle::clip::{Polygon, clip};
use glint_model::triangle::vertex::{CameraVertex, transform};
use glint_model::{MeshSetup, MeshSubject, Object, Placement, SIZES, ScreenVertex};
use glint_vectors::{Camera, Model, Random};

/// Radius of a mesh that fills a box of 1×1×1 world units, and of a mesh that may have vertices at all positions of the mesh format;
/// 14 fraction bits.
const RADII: [u32; 2] = [14_190, 56_756];

/// Encodes a model as a mesh, in memory that is never freed.
fn mesh_of(model: &Model) -> Mesh<'static> {
    Mesh::new_checked(model.encoded().leak()).unwrap()
}

/// A cube of side 1 about the origin.
fn cube() -> Mesh<'static> {
    mesh_of(&Model::cube(8192))
}

/// A vector with random components.
fn any_vector(random: &mut Random) -> [i16; 3] {
    [0; 3].map(|_| random.integer(-32768, 32767) as i16)
}

/// The polygon that remains of a triangle after clipping.
fn clipped(frame: &MeshSetup, triangle: [CameraVertex; 3]) -> Polygon {
    let mut space = Default::default();
    clip(frame, triangle, &mut space).iter().copied().collect()
}

/// The constants of a frame with a random camera and size.
fn random_frame(random: &mut Random) -> MeshSetup {
    let (width, height) = SIZES[random.integer(0, 2) as usize];
    MeshSetup::new(&Camera::inside(random).rounded(), width, height, RADII[1]).unwrap()
}

fn random_vertex(random: &mut Random, frame: &MeshSetup) -> CameraVertex {
    transform(frame, any_vector(random))
}

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

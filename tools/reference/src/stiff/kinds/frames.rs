//! Inputs of frames, shared by several kinds.

use glint_core::camera::View;
use glint_core::fixed::{Q8_24, U8_28};
use glint_core::matrix::Matrix;
use glint_core::mesh::Mesh;
use glint_model::{Clip, MeshSubject, Object, Placement};
use glint_vectors::Camera;

/// Converts a matrix entry.
pub fn number(x: f64) -> Q8_24 {
    Q8_24::from_num(x)
}

/// Clipping to the view volume with a far plane.
pub fn view_volume(far: f64) -> Clip {
    Clip::View {
        far: U8_28::from_num(far),
    }
}

/// A checked mesh.
pub fn mesh(bytes: &[u8]) -> Mesh<'_> {
    Mesh::new_checked(bytes).expect("a generated mesh is valid")
}

/// An object with the colours of its mesh.
pub fn object(bytes: &[u8], matrix: Matrix) -> Object<'_> {
    Object {
        subject: MeshSubject::new(mesh(bytes)),
        placement: Placement::new(matrix),
        colour: None,
    }
}

/// A camera two units in front of the origin that looks along y, with a half width of 0.9 at distance 1.
pub fn ahead(near: f64) -> View {
    Camera::looking([0.0, -2.0, 0.0], [0.0; 3], 0.9, near).rounded()
}

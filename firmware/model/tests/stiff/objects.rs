//! Model matrices: singular ones, those out of range, and those that mirror.

use glint_core::fixed::Q8_24;
use glint_core::matrix::{Matrix, MatrixError};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_model::{Frame, Subject};
use glint_vectors::{Camera, Model, Picture, Random};

use crate::case::{Case, number, object, refused};

pub const CASES: &[Case] = &[
    ("model matrix with two parallel rows", || {
        refused(matrix([
            [1.0, 2.0, 0.0],
            [-2.0, -4.0, 0.0],
            [0.0, 0.0, 1.0],
        ]))
    }),
    ("model matrix with three rows in a plane", || {
        refused(matrix([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]))
    }),
    ("model matrix with a row of zeros", || {
        refused(matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]))
    }),
    ("model matrix out of range", || {
        refused(matrix([[1.0, 0.0, 0.0], [0.0, 16.5, 0.0], [0.0, 0.0, 1.0]]))
    }),
    ("translation out of range", || {
        refused(Matrix::translation([0.0, 0.0, 32.5].map(number)))
    }),
    ("negative scale", negative_scale),
];

fn matrix(rows: [[f64; 3]; 3]) -> Result<Matrix, MatrixError> {
    Matrix::new_checked(rows.map(|row| row.map(number)), [Q8_24::ZERO; 3])
}

/// A mirrored object beside a mesh whose vertices are mirrored themselves, with the windings of its triangles reversed.
fn negative_scale() -> String {
    let mut random = Random(33);
    let mut covered = 0;
    for _ in 0..10 {
        let mut model = Model::sphere(0.5, 5);
        let plain = model.encoded();
        for [x, _, _] in &mut model.positions {
            *x = -*x;
        }
        let mirrored = model.flipped().encoded();
        let azimuth = random.real(-3.0, 3.0);
        let height = random.real(-1.0, 1.0);
        let eye = [2.0 * azimuth.cos(), 2.0 * azimuth.sin(), height];
        let view = Camera::looking(eye, [0.0; 3], 0.5, 0.1).rounded();
        let matrix = Matrix::scale([number(-1.0), Q8_24::ONE, Q8_24::ONE]).unwrap();
        let objects = [object(&plain, matrix)];
        let found = Picture::of_frame(&Frame::new(Subject::Objects(&objects), view, Size::W320));
        let mesh = Subject::mesh(Mesh::new_checked(&mirrored).unwrap());
        let expected = Picture::of_frame(&Frame::new(mesh, view, Size::W320));
        assert!(found.coverage() == expected.coverage() && found.depth == expected.depth);
        assert_eq!(found.stats.drawn, expected.stats.drawn);
        covered += found.covered();
    }
    assert!(covered > 100_000, "{covered}");
    "pixels and depths of the mirrored mesh with reversed windings: outer faces stay visible"
        .to_owned()
}

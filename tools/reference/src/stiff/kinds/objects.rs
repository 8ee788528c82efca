//! Mirrored objects.

use anyhow::{Result, ensure};
use glint_core::fixed::Q8_24;
use glint_core::matrix::Matrix;
use glint_core::picture::Size;
use glint_model::{Frame, Subject};
use glint_vectors::{Camera, Model, Picture, Random};

use super::frames::{mesh, number, object};
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![Kind::new("mirrored-object", mirrored_object)]
}

/// Compares, in this number of views, a mirrored object with a mesh of mirrored vertices and reversed windings.
fn mirrored_object(views: u32) -> Result<Outcome> {
    let mut random = Random(33);
    for _ in 0..views {
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
        let matrix = Matrix::scale([number(-1.0), Q8_24::ONE, Q8_24::ONE])?;
        let objects = [object(&plain, matrix)];
        let found = Picture::of_frame(&Frame::new(Subject::Objects(&objects), view, Size::W320));
        let subject = Subject::mesh(mesh(&mirrored));
        let expected = Picture::of_frame(&Frame::new(subject, view, Size::W320));
        ensure!(
            expected.covered() > 10_000,
            "{} pixels covered",
            expected.covered()
        );
        if found.coverage() != expected.coverage() || found.depth != expected.depth {
            return Ok(Outcome::exact(format!("another picture from {eye:?}")));
        }
    }
    Ok(Outcome::exact(
        "pixels and depths of the mirrored mesh with reversed windings",
    ))
}

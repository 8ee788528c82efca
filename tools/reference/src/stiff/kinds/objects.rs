//! Mirrored objects, and objects that turn by small steps.

use anyhow::{Context, Result, ensure};
use glint_core::choice::Choice;
use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, Matrix};
use glint_core::picture::Size;
use glint_model::{Frame, Subject};
use glint_vectors::{Camera, Model, Picture, Random};

use serde::Deserialize;

use super::frames::{mesh, number, object};
use crate::object::{Method, Turned, turned};
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("mirrored-object", mirrored_object),
        Kind::new("turning-object", turning_object),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Turning {
    /// Scale of the object along its axes.
    scale: [f64; 3],
    /// Axis of the world.
    axis: String,
    /// Angle of each rotation in degrees.
    degrees: String,
    /// Number of rotations.
    steps: u32,
}

/// Whether an object keeps its shape during many small rotations, within 2^-20 of the length of its shortest axis, and the error of
/// its angle.
fn turning_object(input: Turning) -> Result<Outcome> {
    let axis = Axis::from_word(&input.axis).context("expected an axis")?;
    let shape = Matrix::scale(input.scale.map(number))?;
    let angle = Turns::from_degrees(input.degrees.parse()?);
    let turned = turned(Method::Kept, shape, axis, angle, &[input.steps])?;
    let Turned { error, growth, .. } = turned[0];
    let [shortest, longest] = [f64::min, f64::max].map(|of| {
        let lengths = input.scale.map(f64::abs).into_iter();
        lengths.reduce(of).unwrap_or_default()
    });
    let lengths = match growth.abs() * shortest <= 2f64.powi(-20) {
        true => "kept".to_owned(),
        false => format!("changed by {growth:e}"),
    };
    let degrees = (error / longest).to_degrees();
    Ok(Outcome::exact(format!(
        "lengths {lengths}, angle off by {degrees:.4}°"
    )))
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

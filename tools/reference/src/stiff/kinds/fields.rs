//! Pictures of distance fields, and distances at the ends of the range of coordinates.

use anyhow::{Context, Result};
use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, U8_28};
use glint_core::stereo::Stereo;
use glint_model::raymarch::{FieldOptions, FieldSetup, FieldStats};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("field-picture", picture),
        Kind::new("field-distance", distance),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Seen {
    field: String,
    eye: [f64; 3],
    gaze: [f64; 3],
    #[serde(default = "usual")]
    half_width: f64,
    stereo: Option<String>,
}

fn usual() -> f64 {
    0.9
}

const SIZE: (u32, u32) = (320, 180);

/// Traces the rays of a picture of 320×180.
fn picture(input: Seen) -> Result<Outcome> {
    let number = |v: [f64; 3]| v.map(Q32_32::from_num);
    let up = number([0.0, 0.0, 1.0]);
    let view = View::towards(number(input.eye), number(input.gaze), up)
        .and_then(|view| view.with_half_width(U8_28::from_num(input.half_width)));
    let view = match view {
        Ok(view) => view,
        Err(error) => return Ok(Outcome::Refused(error.to_string())),
    };
    let field = Field::parse(&input.field).map_err(|error| anyhow::anyhow!("{error}"))?;
    let stereo = input.stereo.as_deref().map(Stereo::parse).transpose();
    let options = FieldOptions {
        stereo: stereo.map_err(|error| anyhow::anyhow!("{error}"))?,
        ..FieldOptions::of(&field)
    };
    let setup = match FieldSetup::new(&field, &view, SIZE, &options) {
        Ok(setup) => setup,
        Err(error) => return Ok(Outcome::Refused(error.to_string())),
    };
    let mut stats = FieldStats::default();
    let tracer = setup.tracer();
    for eye in 0..if setup.stereo.is_some() { 2 } else { 1 } {
        for i in 0..SIZE.0 * SIZE.1 {
            stats.count(&tracer.trace(eye, i % SIZE.0, i / SIZE.0));
        }
    }
    let inside = match setup.has_eye_inside() {
        true => ", eye inside",
        false => "",
    };
    Ok(Outcome::exact(format!(
        "{} hits, {} misses, {} undecided{inside}",
        stats.hits, stats.misses, stats.undecided
    )))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Point {
    field: String,
    /// Coordinates in 2^-12 field units.
    point: [i32; 3],
}

/// The distance at a point, for a field that is drawn by marching rays.
fn distance(Point { field, point }: Point) -> Result<Outcome> {
    let field = Field::parse(&field).map_err(|error| anyhow::anyhow!("{error}"))?;
    let view = View::spherical(Q32_32::from_num(4), Default::default(), Default::default())?;
    let setup = FieldSetup::new(&field, &view, SIZE, &FieldOptions::of(&field))?;
    let marching = setup.marching().context("rays do not march")?;
    Ok(Outcome::exact(format!(
        "{}/2^12",
        marching.sample(point).distance
    )))
}

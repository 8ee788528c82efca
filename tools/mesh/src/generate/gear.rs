//! A gear wheel: an extruded outline with teeth, and a bore.

use super::builder::Builder;
use crate::error::FormatError;
use crate::polygons::{Polygons, Rgb8, Vector};
use std::f64::consts::TAU;

const TEETH: usize = 20;
/// Radius and angle of each point in the outline of one tooth: root, tip, and the far flank, which
/// ends at the first point of the next tooth. Angles are in pitches; a pitch is the angle between
/// two teeth.
const TOOTH: [(f64, f64); 6] = [
    (0.80, -0.50),
    (0.80, -0.26),
    (0.92, -0.17),
    (1.00, -0.10),
    (1.00, 0.10),
    (0.92, 0.17),
];
const BORE: f64 = 0.30;
/// Radius of the hub, which is thicker than the wheel.
const HUB: f64 = 0.45;
const WEB: f64 = 0.66;
const HALF_WIDTH: f64 = 0.16;
const HALF_HUB_WIDTH: f64 = 0.22;
const HALF_WEB_WIDTH: f64 = 0.09;

const STEEL: Rgb8 = Rgb8([0xa8, 0xb4, 0xc0]);
const TEETH_STEEL: Rgb8 = Rgb8([0xc8, 0xd0, 0xd8]);
const BRASS: Rgb8 = Rgb8([0xd8, 0xa8, 0x50]);

/// The gear about the z axis.
pub fn gear() -> Result<Polygons, FormatError> {
    // Every ring of points around the axis has as many points as the outline, so that the surface
    // is a grid that is closed in both directions.
    let angles: Vec<(f64, f64)> = (0..TEETH)
        .flat_map(|tooth| {
            TOOTH.map(|(radius, pitch)| (radius, (tooth as f64 + pitch) / TEETH as f64 * TAU))
        })
        .collect();
    let ring = |radius: Option<f64>, z: f64| -> Vec<Vector> {
        angles
            .iter()
            .chain(angles.first())
            .map(|&(outline, angle)| {
                let r = radius.unwrap_or(outline);
                [r * angle.cos(), r * angle.sin(), z]
            })
            .collect()
    };
    let rim = 0.74;
    let profile = [
        (Some(BORE), -HALF_HUB_WIDTH, BRASS),
        (Some(HUB), -HALF_HUB_WIDTH, BRASS),
        (Some(HUB), -HALF_WEB_WIDTH, STEEL),
        (Some(WEB), -HALF_WEB_WIDTH, STEEL),
        (Some(rim), -HALF_WIDTH, TEETH_STEEL),
        (None, -HALF_WIDTH, TEETH_STEEL),
        (None, HALF_WIDTH, TEETH_STEEL),
        (Some(rim), HALF_WIDTH, STEEL),
        (Some(WEB), HALF_WEB_WIDTH, STEEL),
        (Some(HUB), HALF_WEB_WIDTH, BRASS),
        (Some(HUB), HALF_HUB_WIDTH, BRASS),
        (Some(BORE), HALF_HUB_WIDTH, BRASS),
        (Some(BORE), -HALF_HUB_WIDTH, BRASS),
    ];
    let rings: Vec<Vec<Vector>> = profile
        .iter()
        .map(|&(radius, z, _)| ring(radius, z))
        .collect();
    let mut builder = Builder::default();
    builder.grid(&rings, |_, j| profile[j].2)?;
    Ok(builder.finish())
}

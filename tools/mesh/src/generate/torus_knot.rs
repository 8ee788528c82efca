//! The torus knot (2, 3): a tube along the trefoil.

use super::builder::{Builder, hue};
use crate::error::FormatError;
use crate::polygons::{Polygons, Vector};
use crate::triangulate::{cross, sub, unit};
use std::f64::consts::TAU;

/// Number of quads along the knot.
const LENGTH: usize = 240;
/// Number of quads around the tube.
const GIRTH: usize = 16;
const TUBE_RADIUS: f64 = 0.42;

/// The point of the knot's centre line at the parameter `t`, from 0 to 1 for the whole knot.
fn line(t: f64) -> Vector {
    let (p, q) = (2.0 * TAU * t, 3.0 * TAU * t);
    let r = 2.0 + q.cos();
    [r * p.cos(), r * p.sin(), q.sin()]
}

/// The tube around the knot. Its colours pass once around the colour wheel.
pub fn torus_knot() -> Result<Polygons, FormatError> {
    let ring = |j: usize| -> Vec<Vector> {
        let t = (j % LENGTH) as f64 / LENGTH as f64;
        let centre = line(t);
        let ahead = sub(line(t + 1e-4), line(t - 1e-4));
        // The cross-section of the tube is spanned by `up` and `side`. Both depend only on the point on the knot, so the tube closes
        // without a twist.
        let [x, y, _] = centre;
        let radial = [x, y, 0.0];
        let side = unit(cross(ahead, radial)).unwrap_or([0.0, 0.0, 1.0]);
        let up = unit(cross(side, ahead)).unwrap_or([0.0, 0.0, 1.0]);
        (0..=GIRTH)
            .map(|i| {
                let (sin, cos) = (TAU * (i % GIRTH) as f64 / GIRTH as f64).sin_cos();
                [0, 1, 2].map(|k| centre[k] + TUBE_RADIUS * (cos * up[k] + sin * side[k]))
            })
            .collect()
    };
    let rings: Vec<Vec<Vector>> = (0..=LENGTH).map(ring).collect();
    let mut builder = Builder::default();
    builder.grid(&rings, |_, j| hue(j as f64 / LENGTH as f64))?;
    Ok(builder.finish())
}

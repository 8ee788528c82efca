//! Pictures with four samples a pixel: edges through samples, triangles between samples, and the borders of quarters.

use anyhow::{Context, Result, ensure};
use glint_core::mesh::Mesh;
use glint_core::picture::{Samples, Size};
use glint_model::{Frame, MeshSubject, Subject};
use glint_vectors::Picture;
use glint_vectors::meshes::{ONE, Triangle, ahead, mesh};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

/// Half the width of the picture at the distance 1, with which a world unit at the height 0 has 512 pixels.
const HALF_WIDTH: f64 = 0.625;
/// Pixels of a world unit.
const PIXELS: f64 = 512.0;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("samples-covered", |shape: Shape| {
            let Covered { drawn, different } = shape.covered()?;
            Ok(Outcome::exact(format!(
                "{drawn} samples, {different} different"
            )))
        }),
        Kind::new("samples-area", |shape: Shape| {
            let samples = 4.0 * shape.area();
            let error = shape.covered()?.drawn as f64 / samples - 1.0;
            Ok(Outcome::Error(100.0 * error.abs(), "% of the area"))
        }),
    ]
}

/// Triangles of a picture of 1280×720 pixels with four samples each.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Shape {
    /// Positions of the corners in pixels to the right of and below the middle of the picture, multiples of 1/32. Samples are a quarter of
    /// a pixel from the middle of a pixel.
    corners: Vec<[f64; 2]>,
    /// For each triangle, the indices of its corners.
    triangles: Vec<[usize; 3]>,
}

/// Numbers of samples.
struct Covered {
    /// The sum over all triangles.
    drawn: usize,
    /// Samples that are covered by at least one triangle.
    different: usize,
}

impl Shape {
    /// The corners of each triangle.
    fn triangles(&self) -> impl Iterator<Item = Option<[[f64; 2]; 3]>> {
        self.triangles.iter().map(|indices| {
            let [a, b, c] = indices.map(|index| self.corners.get(index).copied());
            Some([a?, b?, c?])
        })
    }

    /// The sum of the triangles' areas in pixels.
    fn area(&self) -> f64 {
        let area = |[a, b, c]: [[f64; 2]; 3]| {
            ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() / 2.0
        };
        self.triangles().flatten().map(area).sum()
    }

    /// Draws the four quarters of the picture, and counts the samples.
    fn covered(&self) -> Result<Covered> {
        let unit = f64::from(ONE) / PIXELS;
        let place = |[right, down]: [f64; 2]| [right, 0.0, -down].map(|c| (c * unit) as i16);
        let triangles = self.triangles().map(|corners| {
            let corners = corners.context("an index of a corner")?;
            Ok((corners.map(place), 0xFFFF))
        });
        let triangles: Vec<Triangle> = triangles.collect::<Result<_>>()?;
        let bytes = mesh(&triangles, 192);
        let subject = MeshSubject {
            cull: false,
            ..MeshSubject::new(Mesh::new_checked(&bytes).context("the mesh")?)
        };
        let frame = Frame {
            samples: Samples::Four,
            ..Frame::new(Subject::Mesh(subject), ahead(HALF_WIDTH, 0.1), Size::W1280)
        };
        let (mut drawn, mut different) = (0, 0);
        for part in frame.parts() {
            let picture = Picture::of_frame(&part);
            drawn += picture.stats.pixels_covered as usize;
            different += picture.covered();
        }
        ensure!(drawn >= different, "{drawn}, {different}");
        Ok(Covered { drawn, different })
    }
}

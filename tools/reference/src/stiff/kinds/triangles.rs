//! Triangles in screen coordinates, compared with the exact rasterizer.

use std::collections::BTreeSet;

use anyhow::Result;
use glint_core::colour::Rgb565;
use glint_model::triangle::ScreenVertex;
use glint_model::triangle::raster;
use glint_vectors::Picture;
use glint_vectors::triangles::set_up;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;
use crate::triangle::exact::{ExactTriangle, SnappedVertex};

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("triangle", |triangle: Triangle| {
            let (drawn, exact) = (triangle.drawn(), triangle.exact());
            let right = drawn.iter().filter(|(place, _)| exact.contains(place));
            let (right, exact) = (right.count(), exact.len());
            let others = drawn.len() - right;
            Ok(Outcome::exact(format!(
                "{right} of {exact} exact pixels, {others} others"
            )))
        }),
        Kind::new("triangle-depth", depth_error),
    ]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Triangle {
    /// The vertices: x and y in 1/256 pixel, and the depth in 1/64 code.
    vertices: [[i32; 3]; 3],
}

/// Size of the picture.
const SIZE: (u32, u32) = (320, 180);

impl Triangle {
    /// States the positions and depth codes of the pixels that the model draws.
    fn drawn(&self) -> Vec<([u32; 2], u32)> {
        let vertices = self
            .vertices
            .map(|[x, y, w]| ScreenVertex { x, y, w: w as u32 });
        let mut picture = Picture::blank(SIZE);
        if let Some((_, setup)) = set_up(vertices, SIZE) {
            raster::draw(&setup, Rgb565(1), &mut picture.target());
        }
        let codes = (0..).zip(&picture.depth).filter(|(_, code)| **code > 0);
        codes
            .map(|(i, &code)| ([i % SIZE.0, i / SIZE.0], code))
            .collect()
    }

    fn exact_triangle(&self) -> Option<ExactTriangle> {
        let [a, b, c] = self.vertices.map(|vertex| vertex.map(i64::from));
        ExactTriangle::new([a, b, c].map(|[x, y, w]| SnappedVertex { x, y, w }))
    }

    fn exact(&self) -> BTreeSet<[u32; 2]> {
        let mut pixels = BTreeSet::new();
        if let Some(triangle) = self.exact_triangle() {
            triangle.for_each_pixel(SIZE.0, SIZE.1, |column, row| {
                pixels.insert([column, row]);
            });
        }
        pixels
    }
}

/// The largest error of the depth codes of a triangle's pixels.
fn depth_error(triangle: Triangle) -> Result<Outcome> {
    let Some(exact) = triangle.exact_triangle() else {
        return Ok(Outcome::exact("no area"));
    };
    let drawn = triangle.drawn();
    let errors = drawn
        .iter()
        .map(|&([column, row], code)| exact.depth(column.into(), row.into()).error_of(code).abs());
    Ok(Outcome::Error(errors.fold(0.0, f64::max), "codes"))
}

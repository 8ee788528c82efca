//! Builder of meshes from faces, whose equal points become shared points.

use crate::error::{FormatError, Location};
use crate::polygons::{Corner, Polygons, Rgb8, Vector};
use std::collections::HashMap;

/// Builds a mesh from faces that are given by the coordinates of their points.
#[derive(Default)]
pub struct Builder {
    polygons: Polygons,
    numbers: HashMap<[u64; 3], u32>,
}

impl Builder {
    /// Returns the index of a point, and adds the point if it is new. Two points are equal if all
    /// bits of their coordinates are equal; −0 counts as 0.
    pub fn point(&mut self, point: Vector) -> Result<u32, FormatError> {
        let point = point.map(|c| c + 0.0);
        let key = point.map(f64::to_bits);
        if let Some(&number) = self.numbers.get(&key) {
            return Ok(number);
        }
        let number = self.polygons.add_point(point, Location::Whole)?;
        self.numbers.insert(key, number);
        Ok(number)
    }

    /// Adds a face that is counter-clockwise seen from outside. Consecutive equal corners are merged. A face with fewer than three
    /// remaining corners is not added.
    pub fn face(&mut self, points: &[Vector], colour: Option<Rgb8>) -> Result<(), FormatError> {
        let mut corners = Vec::with_capacity(points.len());
        for &point in points {
            corners.push(Corner::at(self.point(point)?));
        }
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            return Ok(());
        }
        self.polygons.add_face(&corners, colour, Location::Whole)
    }

    /// Adds the quads of a grid, whose points are given row by row. The cross product of the direction along a row and the direction to
    /// the next row must point outwards.
    pub fn grid(
        &mut self,
        rows: &[Vec<Vector>],
        colour: impl Fn(usize, usize) -> Rgb8,
    ) -> Result<(), FormatError> {
        for (j, pair) in rows.windows(2).enumerate() {
            let [low, high] = pair else { continue };
            for (i, (lower, upper)) in low.windows(2).zip(high.windows(2)).enumerate() {
                self.face(
                    &[lower[0], lower[1], upper[1], upper[0]],
                    Some(colour(i, j)),
                )?;
            }
        }
        Ok(())
    }

    /// Finishes the mesh; `colour` computes the colour of each point.
    pub fn coloured(mut self, colour: impl Fn(Vector) -> Rgb8) -> Polygons {
        self.polygons.point_colours = self
            .polygons
            .points
            .iter()
            .map(|&point| colour(point))
            .collect();
        self.polygons
    }

    /// Finishes the mesh with the colours of its faces only.
    pub fn finish(self) -> Polygons {
        self.polygons
    }
}

/// A light colour of the colour wheel at the angle `turns` from red, in turns.
pub fn hue(turns: f64) -> Rgb8 {
    let channel = |shift: f64| 0.62 + 0.36 * (std::f64::consts::TAU * (turns - shift)).cos();
    Rgb8::from_unit([channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0)])
}

//! Scaling of points to the unit box, and their rounding to Q2.14.

use crate::error::FormatError;
use crate::polygons::{Corner, Polygons, Vector};
use std::collections::HashMap;

/// One in Q2.14.
pub const ONE: f64 = 16384.0;

/// Exponents of the largest coordinate of a mesh for which products of four lengths neither
/// underflow nor overflow.
const USUAL_EXPONENTS: std::ops::RangeInclusive<i32> = -200..=200;

/// Power of two that scales coordinates of unusual magnitude. It is the product of two factors,
/// because it may exceed the range of `f64`.
#[derive(Clone, Copy)]
pub struct Unusual([f64; 2]);

impl Unusual {
    /// The power of two that scales the coordinates of the used points to magnitudes of at most 2;
    /// `None` if their magnitudes are usual.
    pub fn of(polygons: &Polygons) -> Option<Self> {
        let corners = polygons.corners.iter();
        let coordinates = corners.flat_map(|&corner| polygons.point(corner));
        let largest = coordinates.fold(0.0, |largest: f64, c| largest.max(c.abs()));
        let exponent = largest.log2().floor();
        if largest == 0.0 || USUAL_EXPONENTS.contains(&(exponent as i32)) {
            return None;
        }
        let first = (-exponent / 2.0).floor();
        Some(Self([first, -exponent - first].map(f64::exp2)))
    }

    /// Multiplies a coordinate by the power of two.
    pub fn apply(self, c: f64) -> f64 {
        let Self([a, b]) = self;
        c * a * b
    }

    /// Divides a coordinate by the power of two.
    pub fn undo(self, c: f64) -> f64 {
        let Self([a, b]) = self;
        c / a / b
    }
}

/// The map of a point P from the file's coordinates to world units: (P − centre)·scale.
pub struct Placing {
    /// The point, in the file's coordinates, that becomes the origin.
    pub centre: Vector,
    /// Length in world units of one unit of the file.
    pub scale: f64,
}

impl Placing {
    /// The map that scales the mesh to the 1×1×1 box about the origin, or with `keep_scale` the identity.
    ///
    /// # Errors
    /// The mesh has no finite extent.
    pub fn of(polygons: &Polygons, keep_scale: bool) -> Result<Self, FormatError> {
        if keep_scale {
            return Ok(Self {
                centre: [0.0; 3],
                scale: 1.0,
            });
        }
        // Points that no face uses do not belong to the bounding box.
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &corner in &polygons.corners {
            for (i, &c) in polygons.point(corner).iter().enumerate() {
                low[i] = low[i].min(c);
                high[i] = high[i].max(c);
            }
        }
        let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let scale = 1.0 / extent;
        if !scale.is_finite() {
            return Err(FormatError::whole(
                "a mesh with an extent",
                format!("extent {extent:e}"),
            ));
        }
        Ok(Self {
            centre: [0, 1, 2].map(|i| low[i] + (high[i] - low[i]) / 2.0),
            scale,
        })
    }

    /// Converts a point of the file to world units, without rounding.
    pub fn apply(&self, point: Vector) -> Vector {
        [0, 1, 2].map(|i| (point[i] - self.centre[i]) * self.scale)
    }
}

/// The points of a file, rounded to Q2.14. Points that round to the same position share one entry.
pub struct Rounded {
    /// For each point of the file, the index of its rounded position in `positions`, or `UNUSED` if no face uses the point.
    of_point: Vec<u32>,
    /// The distinct rounded positions in Q2.14.
    pub positions: Vec<[i16; 3]>,
    /// Maximum distance between a scaled point and its rounded position, in world units.
    pub error_max: f64,
    /// Root mean square of the distances between scaled points and their rounded positions, in world units.
    pub error_rms: f64,
}

impl Rounded {
    const UNUSED: u32 = u32::MAX;

    /// Rounds every point that a face uses.
    ///
    /// # Errors
    /// A coordinate is outside of [-2, 2).
    pub fn of(polygons: &Polygons, placing: &Placing) -> Result<Self, FormatError> {
        let mut of_point = vec![Self::UNUSED; polygons.points.len()];
        let mut positions = Vec::new();
        let mut numbers: HashMap<[i16; 3], u32> = HashMap::new();
        let (mut error_max, mut squares, mut used) = (0.0_f64, 0.0, 0_u32);
        for &corner in &polygons.corners {
            let slot = &mut of_point[corner.point as usize];
            if *slot != Self::UNUSED {
                continue;
            }
            let exact = placing.apply(polygons.point(corner));
            let position = nearest(exact).ok_or_else(|| {
                let [x, y, z] = exact;
                FormatError::whole(
                    "coordinates in [-2, 2 - 2^-14] (without --keep-scale the mesh is scaled to fit)",
                    format!("point {} at ({x}, {y}, {z})", corner.point),
                )
            })?;
            *slot = *numbers.entry(position).or_insert_with(|| {
                positions.push(position);
                (positions.len() - 1) as u32
            });
            let square: f64 = (0..3)
                .map(|i| (f64::from(position[i]) / ONE - exact[i]).powi(2))
                .sum();
            error_max = error_max.max(square.sqrt());
            squares += square;
            used += 1;
        }
        Ok(Self {
            of_point,
            positions,
            error_max,
            error_rms: (squares / f64::from(used.max(1))).sqrt(),
        })
    }

    /// Index of a corner's rounded position in `positions`.
    pub fn number(&self, corner: Corner) -> u32 {
        self.of_point[corner.point as usize]
    }

    /// A corner's rounded position in Q2.14.
    pub fn position(&self, corner: Corner) -> [i16; 3] {
        self.positions[self.number(corner) as usize]
    }
}

/// Rounds a point to Q2.14, to nearest, ties up; `None` if a coordinate is outside [−2, 2 − 2^−14].
fn nearest(exact: Vector) -> Option<[i16; 3]> {
    let mut position = [0; 3];
    for (q, c) in position.iter_mut().zip(exact) {
        let rounded = (c * ONE + 0.5).floor();
        if !(f64::from(i16::MIN)..=f64::from(i16::MAX)).contains(&rounded) {
            return None;
        }
        *q = rounded as i16;
    }
    Some(position)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rounding_is_to_nearest_ties_up() {
        let half = 0.5 / ONE;
        assert_eq!(nearest([half, -half, 1.4 / ONE]), Some([1, 0, 1]));
        assert_eq!(nearest([-2.0 - half, 0.0, 0.0]), Some([i16::MIN, 0, 0]));
        assert_eq!(nearest([f64::NAN, 0.0, 0.0]), None);
    }
}

//! A bumpy closed surface whose triangles are in an order that is typical of files from 3D
//! scanners.

use super::icosphere::icosphere;
use crate::error::FormatError;
use crate::polygons::{Face, Polygons, Vector};

/// Lengths of the runs of neighbouring triangles, used in turn.
const RUNS: [usize; 3] = [3, 3, 4];

/// An icosphere whose radius varies in waves. Its triangles are divided into short runs, which are
/// in a scattered order.
pub fn scan(frequency: u32) -> Result<Polygons, FormatError> {
    let mut polygons = icosphere(frequency)?;
    for point in &mut polygons.points {
        let radius = radius(*point);
        *point = point.map(|c| c * radius);
    }
    polygons.faces = scattered(&polygons.faces);
    Ok(polygons)
}

/// Radius of the surface in a direction: 1, plus waves of three wavelengths along different axes.
fn radius([x, y, z]: Vector) -> f64 {
    1.0 + 0.14 * (3.0 * x + 2.0 * z).sin() * (2.0 * y - 1.0).cos()
        + 0.05 * (9.0 * y + 4.0 * x).sin() * (8.0 * z).cos()
        + 0.012 * (31.0 * x).sin() * (29.0 * y).sin() * (30.0 * z).sin()
}

/// Divides faces into runs, and reorders the runs with a stride of about 0.618 times their number.
fn scattered(faces: &[Face]) -> Vec<Face> {
    let mut runs = Vec::new();
    let mut rest = faces;
    for length in RUNS.into_iter().cycle() {
        let Some((run, later)) = rest.split_at_checked(length) else {
            break;
        };
        runs.push(run);
        rest = later;
    }
    runs.push(rest);
    // Each run occurs once if the stride and the number of runs have no common factor.
    let count = runs.len();
    let mut stride = (count as f64 * 0.618) as usize;
    while greatest_common_divisor(stride, count) > 1 {
        stride += 1;
    }
    (0..count)
        .flat_map(|number| runs[number * stride % count])
        .copied()
        .collect()
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

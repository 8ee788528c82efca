//! The basis of a camera, and its deviation from an orthonormal basis.

use glint_core::camera::View;

use crate::camera::{Vector, dot};

/// The vectors u, v and n of a view.
pub fn of(view: &View) -> [Vector; 3] {
    [view.u(), view.v(), view.n()].map(|row| row.map(|x| x.to_num()))
}

/// Returns the largest deviation of a vector's length from 1, and the largest scalar product of two vectors.
pub fn errors([u, v, n]: [Vector; 3]) -> [f64; 2] {
    let lengths = [u, v, n].map(|row| (dot(row, row).sqrt() - 1.0).abs());
    let angles = [dot(u, v), dot(v, n), dot(n, u)].map(f64::abs);
    [lengths, angles].map(|errors| errors.into_iter().fold(0.0, f64::max))
}

/// The largest difference between corresponding components of two bases.
pub fn difference(a: [Vector; 3], b: [Vector; 3]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

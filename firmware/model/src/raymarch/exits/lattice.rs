//! Spheres of a lattice: a ray in the bounding box of a sphere meets the sphere, or leaves the box.
//!
//! The direction D is doubled until its length is between 1 and 2, so that the precision is the same for all cameras.

use super::intervals::{AXES, PERIOD, Solid};
use super::narrow::{floor, nearest, normalised, squared};
use super::ray::Beam;
use super::setup::Exits;

/// Fraction bits of |q|² − r².
const BEYOND: u32 = 13;
/// Fraction bits of |D|².
const SQUARE: u32 = 15;
/// Fraction bits of the number under the root, before and after the number is narrowed.
const REST: u32 = 26;
const SHORT_REST: u32 = 20;
/// Fraction bits of the root, and of its difference from −q·D.
const ROOT: u32 = 15;
/// Fraction bits of the mantissa of 1/|D|².
const MANTISSA: i32 = 18;

/// The parameter at which a ray in a sphere's bounding box meets the sphere; `None` if the ray misses the sphere. `point` is the ray's
/// point at the parameter `t`.
pub(super) fn meet(
    exits: &Exits,
    solid: &Solid,
    beam: &Beam,
    t: i64,
    point: &[i64; AXES],
) -> Option<i64> {
    let words = &exits.words;
    let (side, radius) = (solid.side[0], solid.side[0] / 2);
    // The vector from the sphere's centre to the point, s5.12. Rounding may move the point out of the box; the point is then moved back to
    // the surface of the box.
    let q = [0, 1, 2].map(|axis: usize| {
        let within = point[axis] & ((1 << PERIOD) - 1);
        (if within >= side { 0 } else { within }) - radius
    });
    // |q|² − r², computed with 24 fraction bits and then rounded down.
    let beyond = (q.map(|x| x * x).iter().sum::<i64>() - radius * radius) >> (24 - BEYOND);
    if beyond < 0 {
        return Some(t);
    }
    // q·D with the doubled direction, rounded down.
    let along: i64 = (0..3).map(|axis| q[axis] * exits.speed(beam, axis)).sum();
    let fraction = 13 + words.direction - beam.doublings;
    let along = floor(along, fraction as i32 - words.along as i32);
    // (q·D)² − |D|²·(|q|² − r²), rounded to the next lower integer, even if it is an integer. (q·D)² omits the square of the bits of q·D
    // after the first 18, and |D|² is rounded to nearest.
    let square = squared(along, words.along.saturating_sub(10));
    let square = floor(square, 2 * words.along as i32 - REST as i32);
    let length = nearest(beam.square, 23 - SQUARE as i32).min((4 << SQUARE) - 1);
    let product = length * beyond;
    let rest = square - (product >> (SQUARE + BEYOND - REST)) - 1;
    if along >= 0 || rest < 0 {
        return None;
    }
    // The number 0 under the root counts as 1.
    let (root, shift) = normalised((rest >> (REST - SHORT_REST)).max(1));
    let root = floor(
        i64::from(root),
        2 + (shift + SHORT_REST as i32) / 2 - ROOT as i32,
    );
    // The distance can be negative only if the number under the root was 0 and was replaced by 1.
    let distance = -floor(along, words.along as i32 - ROOT as i32) - root;
    let distance = distance.max(0);
    let inverse = beam.inverse_square;
    let mantissa = floor(i64::from(inverse.mantissa), words.inverse as i32 - MANTISSA);
    let bits = ROOT as i32 + MANTISSA - inverse.exponent;
    Some(t + words.parameter_of(distance * mantissa, bits))
}

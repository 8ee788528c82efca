//! Spheres of a lattice: a ray in the box about a sphere meets the sphere, or leaves the box.
//!
//! The direction D is doubled until its length is from 1 to 2, so that numbers of few bits are equally exact for all cameras.

use super::intervals::{AXES, PERIOD, Solid};
use super::narrow::{floor, nearest, normalised, squared};
use super::ray::Beam;
use super::setup::Exits;

/// Fraction bits of |q|² − r².
const BEYOND: u32 = 13;
/// Fraction bits of |D|².
const SQUARE: u32 = 15;
/// Fraction bits of the square of the root, before and after it is narrowed.
const REST: u32 = 26;
const SHORT_REST: u32 = 20;
/// Fraction bits of the root, and of its difference from −q·D.
const ROOT: u32 = 15;
/// Fraction bits of the mantissa of 1/|D|².
const MANTISSA: i32 = 18;

/// The parameter at which a ray in a sphere's box meets the sphere; `None` if it misses the sphere. `point` is the ray's point at the
/// parameter `t`.
pub(super) fn meet(
    exits: &Exits,
    solid: &Solid,
    beam: &Beam,
    t: i64,
    point: &[i64; AXES],
) -> Option<i64> {
    let words = &exits.words;
    let (side, radius) = (solid.side[0], solid.side[0] / 2);
    // The point from the sphere's centre, s5.12. Rounding may place the point before the box; it then counts as on the box.
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
    // (q·D)² − |D|²·(|q|² − r²), rounded down; an integer becomes the next lower integer. The first square omits the square of the bits
    // after the first 18, and |D|² is rounded to nearest.
    let square = squared(along, words.along.saturating_sub(10));
    let square = floor(square, 2 * words.along as i32 - REST as i32);
    let length = nearest(beam.square, 23 - SQUARE as i32).min((4 << SQUARE) - 1);
    let product = length * beyond;
    let rest = square - (product >> (SQUARE + BEYOND - REST)) - 1;
    if along >= 0 || rest < 0 {
        return None;
    }
    // A square of 0 counts as 1.
    let (root, shift) = normalised((rest >> (REST - SHORT_REST)).max(1));
    let root = floor(
        i64::from(root),
        2 + (shift + SHORT_REST as i32) / 2 - ROOT as i32,
    );
    // Only the root of a square of 0, which counts as 1, can make the distance negative.
    let distance = -floor(along, words.along as i32 - ROOT as i32) - root;
    let distance = distance.max(0);
    let inverse = beam.inverse_square;
    let mantissa = floor(i64::from(inverse.mantissa), words.inverse as i32 - MANTISSA);
    let bits = ROOT as i32 + MANTISSA - inverse.exponent;
    Some(t + words.parameter_of(distance * mantissa, bits))
}

//! Spheres of a lattice: a ray in the box about a sphere meets the sphere, or leaves the box.

use super::intervals::{AXES, PERIOD, Solid};
use super::narrow::{floor, root, saturated, squared};
use super::ray::Beam;
use super::setup::Exits;

/// Bits of a coordinate from the centre of a sphere: at most half the period of 64 field units.
const LOCAL: u32 = PERIOD - 1;

/// The parameter at which a ray in a sphere's box meets the sphere. `point` is the ray's point at the parameter `t`, and `intervals` has its
/// intervals.
pub(super) fn meet(
    exits: &Exits,
    solid: &Solid,
    beam: &Beam,
    t: i64,
    point: &[i64; AXES],
    intervals: &[i32; AXES],
) -> Option<i64> {
    let words = &exits.words;
    // The point from the sphere's centre, s5.13: an odd number, the middle of the interval of the rounded point.
    let q = [0, 1, 2].map(|axis: usize| {
        let centre = (i64::from(intervals[axis] >> 1) << PERIOD) + solid.side[axis] / 2;
        2 * saturated(point[axis] - centre, LOCAL) + 1
    });
    let radius = solid.side[0];
    // |q|² − r², with 14 of its 26 fraction bits, rounded down.
    let beyond = (q.map(|x| x * x).iter().sum::<i64>() - radius * radius) >> 12;
    if beyond < 0 {
        return Some(t);
    }
    // q·D: 38 fraction bits, narrowed by rounding down.
    let along: i64 = (0..3).map(|i| q[i] * i64::from(beam.speed[i])).sum();
    let along = floor(along, 38 - words.along as i32);
    // (q·D)² − |D|²·(|q|² − r²), 30 fraction bits. The first square is without that of the bits after the first 18; |D|² has 16 of its 36
    // bits, rounded down.
    let square = squared(along, words.along.saturating_sub(11));
    let square = floor(square, 2 * words.along as i32 - 30);
    let rest = square - (beam.square >> 20) * beyond;
    if along >= 0 || rest <= 0 {
        return None;
    }
    // Both terms have 15 fraction bits.
    let distance = -floor(along, words.along as i32 - 15) - root(rest);
    Some(t + words.divided(distance.max(0), 15, beam.inverse_square))
}

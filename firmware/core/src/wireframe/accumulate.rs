//! The motion of the original design: each step moves the end points themselves in Q5.11, so that rounding errors accumulate.

use super::format::{Point, Segment};
use super::motion::{PAN, ROTATION_COSINE, ROTATION_SINE, Step};
use crate::fixed::{Q5_11, Q12_20, wide};

/// Moves all end points in place by one step. Returns `false` and changes nothing if a coordinate would leave the range of Q5.11.
///
/// A rotation computes i' = i·c ∓ j·s and j' = ±i·s + j·c, each as an exact sum of two products that is rounded once, to nearest,
/// half units up. As c² + s² = 1 + 2^−22, each step also enlarges the picture by 1.2·10^−7.
pub fn apply(segments: &mut [Segment], step: Step) -> bool {
    let possible = segments
        .as_flattened()
        .iter()
        .all(|&point| moved(point, step).is_some());
    if possible {
        for point in segments.as_flattened_mut() {
            *point = moved(*point, step).unwrap_or(*point);
        }
    }
    possible
}

/// The point after a step; `None` if it is out of range.
fn moved([x, y, z]: Point, step: Step) -> Option<Point> {
    match step {
        Step::Pan([dx, dy, dz]) => Some([pan(x, dx)?, pan(y, dy)?, pan(z, dz)?]),
        Step::AboutX { forwards } => {
            let [y, z] = rotate([y, z], forwards)?;
            Some([x, y, z])
        }
        Step::AboutY { forwards } => {
            let [z, x] = rotate([z, x], forwards)?;
            Some([x, y, z])
        }
    }
}

fn pan(x: Q5_11, steps: i8) -> Option<Q5_11> {
    x.checked_add(PAN.checked_mul_int(steps.into())?)
}

/// Rotates from the first axis towards the second axis, or backwards.
fn rotate([i, j]: [Q5_11; 2], forwards: bool) -> Option<[Q5_11; 2]> {
    let bits = |x: Q5_11| i32::from(x.to_bits());
    let cosine = bits(ROTATION_COSINE);
    let sine = if forwards {
        bits(ROTATION_SINE)
    } else {
        -bits(ROTATION_SINE)
    };
    let [i, j] = [bits(i), bits(j)];
    let sums = [
        wide(i, cosine) - wide(j, sine),
        wide(i, sine) + wide(j, cosine),
    ];
    let [i, j] = sums.map(|sum| i16::try_from((sum + (1 << 10)) >> 11).ok());
    Some([Q5_11::from_bits(i?), Q5_11::from_bits(j?)])
}

/// Converts the segment to the format of the projection, exactly.
pub fn segment(segment: Segment) -> [[Q12_20; 3]; 2] {
    segment.map(|point| point.map(Q12_20::from))
}

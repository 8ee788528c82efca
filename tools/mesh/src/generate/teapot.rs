//! The Utah teapot: 32 bicubic Bézier patches, with the control points of Martin Newell (1975) and the bottom added later.
//!
//! The original has a slit around the lid and an open spout. Here a ring of quads closes the slit, and caps close both ends of
//! the handle and of the spout, so that body, handle and spout are three closed surfaces, which intersect as in the original.

use super::builder::Builder;
use crate::error::FormatError;
use crate::polygons::{Polygons, Rgb8, Vector};

/// Number of quads along each side of a patch.
const CUTS: usize = 10;

const GLAZE: Rgb8 = Rgb8([0xe8, 0xc8, 0xa0]);
const LID: Rgb8 = Rgb8([0xe0, 0xb0, 0x88]);
const HANDLE: Rgb8 = Rgb8([0xc0, 0x88, 0x70]);
const SPOUT: Rgb8 = Rgb8([0xd0, 0xa0, 0x80]);
const TEA: Rgb8 = Rgb8([0x70, 0x40, 0x28]);

/// Four control points for a quarter of a ring with radius r at height z: (r, 0, z), (r, −k, z), (k, −r, z), (0, −r, z).
struct Ring {
    r: f64,
    k: f64,
    z: f64,
}

const fn ring(r: f64, k: f64, z: f64) -> Ring {
    Ring { r, k, z }
}

/// Rings of the body, from the inner edge of the opening over the rim and down to the centre of the bottom. Each patch has four
/// rows; its last row is the first of the next patch.
const BODY: [Ring; 13] = [
    ring(1.4, 0.784, 2.4),
    ring(1.3375, 0.749, 2.53125),
    ring(1.4375, 0.805, 2.53125),
    ring(1.5, 0.84, 2.4),
    ring(1.75, 0.98, 1.875),
    ring(2.0, 1.12, 1.35),
    ring(2.0, 1.12, 0.9),
    ring(2.0, 1.12, 0.45),
    ring(1.5, 0.84, 0.225),
    ring(1.5, 0.84, 0.15),
    ring(1.5, 0.84, 0.075),
    ring(1.425, 0.798, 0.0),
    ring(0.0, 0.0, 0.0),
];

/// Rings of the lid, from the top of the knob to the edge.
const COVER: [Ring; 7] = [
    ring(0.0, 0.0, 3.15),
    ring(0.8, 0.45, 3.15),
    ring(0.0, 0.0, 2.85),
    ring(0.2, 0.112, 2.7),
    ring(0.4, 0.224, 2.55),
    ring(1.3, 0.728, 2.55),
    ring(1.3, 0.728, 2.4),
];

/// Four control points of half a ring, symmetric in y: (x, 0, z), (x, −y, z), (x', −y, z'), (x', 0, z'). `upper` is (x, z),
/// `lower` is (x', z').
struct HalfRing {
    upper: [f64; 2],
    lower: [f64; 2],
    y: f64,
}

const fn half(upper: [f64; 2], lower: [f64; 2], y: f64) -> HalfRing {
    HalfRing { upper, lower, y }
}

/// Half rings of the handle, from the top of the body around to its side.
const GRIP: [HalfRing; 7] = [
    half([-1.6, 2.025], [-1.5, 2.25], 0.3),
    half([-2.3, 2.025], [-2.5, 2.25], 0.3),
    half([-2.7, 2.025], [-3.0, 2.25], 0.3),
    half([-2.7, 1.8], [-3.0, 1.8], 0.3),
    half([-2.7, 1.575], [-3.0, 1.35], 0.3),
    half([-2.5, 1.125], [-2.65, 0.9375], 0.3),
    half([-2.0, 0.9], [-1.9, 0.6], 0.3),
];

/// Half rings of the spout, from the body to the inside of the spout's opening.
const NOZZLE: [HalfRing; 7] = [
    half([1.7, 1.425], [1.7, 0.6], 0.66),
    half([2.6, 1.425], [3.1, 0.825], 0.66),
    half([2.3, 2.1], [2.4, 2.025], 0.25),
    half([2.7, 2.4], [3.3, 2.4], 0.25),
    half([2.8, 2.475], [3.525, 2.49375], 0.25),
    half([2.9, 2.475], [3.45, 2.5125], 0.15),
    half([2.8, 2.4], [3.2, 2.4], 0.15),
];

/// The whole teapot, z up.
pub fn teapot() -> Result<Polygons, FormatError> {
    let mut builder = Builder::default();
    let body = turned(&mut builder, &BODY, |_| GLAZE)?;
    let cover = turned(&mut builder, &COVER, |_| LID)?;
    // Close the slit between the edge of the lid, which is the last row of the cover, and the rim,
    // which is the first row of the body.
    let (Some(lid_edge), Some(rim_edge)) = (cover.last(), body.first()) else {
        return Ok(builder.finish());
    };
    builder.grid(&[lid_edge.clone(), rim_edge.clone()], |_, _| TEA)?;
    let grip = tube(&mut builder, &GRIP, HANDLE)?;
    let nozzle = tube(&mut builder, &NOZZLE, SPOUT)?;
    for (rows, end) in [(&grip, HANDLE), (&nozzle, TEA)] {
        let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
            continue;
        };
        let start: Vec<Vector> = first.iter().rev().skip(1).copied().collect();
        builder.face(&start, Some(HANDLE))?;
        builder.face(&last[..last.len() - 1], Some(end))?;
    }
    Ok(builder.finish())
}

/// Evaluates patches at rows of points, `CUTS` rows for each patch; `row` makes the points of a row from its control points.
fn rows<const N: usize>(
    control: &[[[Vector; N]; 4]],
    row: impl Fn([Vector; N]) -> Vec<Vector>,
) -> Vec<Vec<Vector>> {
    let mut rows = Vec::new();
    for (number, patch) in control.iter().enumerate() {
        for cut in usize::from(number > 0)..=CUTS {
            let t = cut as f64 / CUTS as f64;
            let mut across = [[0.0; 3]; N];
            for (i, point) in across.iter_mut().enumerate() {
                *point = bezier([patch[0][i], patch[1][i], patch[2][i], patch[3][i]], t);
            }
            rows.push(row(across));
        }
    }
    rows
}

/// Groups rows of control points into patches of four rows. Each patch starts with the last row of the previous patch.
fn patches<T, const N: usize>(
    control: &[T],
    row: impl Fn(&T) -> [Vector; N],
) -> Vec<[[Vector; N]; 4]> {
    control
        .windows(4)
        .step_by(3)
        .filter_map(|four| four.iter().map(&row).collect::<Vec<_>>().try_into().ok())
        .collect()
}

/// Adds a surface of revolution about the z axis, given by the rings of one quarter; returns its rows of points.
fn turned(
    builder: &mut Builder,
    rings: &[Ring],
    colour: impl Fn(usize) -> Rgb8,
) -> Result<Vec<Vec<Vector>>, FormatError> {
    let control = patches(rings, |&Ring { r, k, z }| {
        [[r, 0.0, z], [r, -k, z], [k, -r, z], [0.0, -r, z]]
    });
    let rows = rows(&control, |quarter| {
        let quarter: Vec<Vector> = (0..=CUTS)
            .map(|i| bezier(quarter, i as f64 / CUTS as f64))
            .collect();
        // The quarter runs clockwise seen from above. A quarter that is mirrored in one axis is reversed, so that the whole ring
        // runs clockwise.
        let mirrored = |sx: f64, sy: f64| quarter.iter().map(move |&[x, y, z]| [sx * x, sy * y, z]);
        let mut ring: Vec<Vector> = mirrored(1.0, 1.0).collect();
        ring.extend(mirrored(-1.0, 1.0).rev().skip(1));
        ring.extend(mirrored(-1.0, -1.0).skip(1));
        ring.extend(mirrored(1.0, -1.0).rev().skip(1));
        ring
    });
    builder.grid(&rows, |_, j| colour(j))?;
    Ok(rows)
}

/// Adds a tube, given by the control points of one half; returns its rows of points.
fn tube(
    builder: &mut Builder,
    rings: &[HalfRing],
    colour: Rgb8,
) -> Result<Vec<Vec<Vector>>, FormatError> {
    let control = patches(
        rings,
        |HalfRing {
             upper: [x0, z0],
             lower: [x1, z1],
             y,
         }| {
            [
                [*x0, 0.0, *z0],
                [*x0, -y, *z0],
                [*x1, -y, *z1],
                [*x1, 0.0, *z1],
            ]
        },
    );
    let rows = rows(&control, |half| {
        let half: Vec<Vector> = (0..=CUTS)
            .map(|i| bezier(half, i as f64 / CUTS as f64))
            .collect();
        let mut ring = half.clone();
        ring.extend(half.iter().rev().skip(1).map(|&[x, y, z]| [x, -y, z]));
        ring
    });
    builder.grid(&rows, |_, _| colour)?;
    Ok(rows)
}

/// A point of a cubic Bézier curve, by de Casteljau's method. The ends of a curve, and all points of a curve whose control points are
/// equal, have no rounding error, so that neighbouring patches meet and poles are closed.
fn bezier(mut control: [Vector; 4], t: f64) -> Vector {
    if t == 1.0 {
        return control[3];
    }
    for last in (1..4).rev() {
        for i in 0..last {
            let next = control[i + 1];
            for (c, n) in control[i].iter_mut().zip(next) {
                *c += (n - *c) * t;
            }
        }
    }
    control[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::tests::volume;
    use std::collections::HashSet;

    #[test]
    fn it_has_32_patches() {
        let rings = [BODY.len(), COVER.len()].map(|n| (n - 1) / 3 * 4);
        let halves = [GRIP.len(), NOZZLE.len()].map(|n| (n - 1) / 3 * 2);
        assert_eq!(rings.iter().chain(&halves).sum::<usize>(), 32);
    }

    #[test]
    fn it_is_symmetric() {
        let teapot = teapot().unwrap();
        let key = |[x, y, z]: Vector| [x + 0.0, y + 0.0, z + 0.0].map(f64::to_bits);
        let points: HashSet<[u64; 3]> = teapot.points.iter().map(|&p| key(p)).collect();
        assert!(
            teapot
                .points
                .iter()
                .all(|&[x, y, z]| points.contains(&key([x, -y, z])))
        );
    }

    #[test]
    fn its_measures() {
        let teapot = teapot().unwrap();
        let extent = |i: usize| {
            let values = || teapot.points.iter().map(|p| p[i]);
            (
                values().fold(f64::MAX, f64::min),
                values().fold(f64::MIN, f64::max),
            )
        };
        assert_eq!(extent(1), (-2.0, 2.0));
        assert_eq!(extent(2), (0.0, 3.15));
        let (back, front) = extent(0);
        assert!(
            (-3.01..-2.9).contains(&back) && (3.4..3.5).contains(&front),
            "{back} {front}"
        );
        // A body of revolution with about this profile has a volume of 25; handle and spout add to it.
        let volume = volume(&teapot);
        assert!((25.0..31.0).contains(&volume), "{volume}");
    }
}

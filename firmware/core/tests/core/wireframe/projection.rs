//! Tests of the projection against f64, and of its difficult cases.

use glint_core::fixed::{Q5_11, Q12_20};
use glint_core::picture::Size;
use glint_core::wireframe::{
    GUARD, Motion, Projection, ScreenLine, Segment, Step, Viewing, Window,
};
use proptest::prelude::*;

use super::{point, q, viewing};

/// Computes in f64 the ends on the screen, in units of 2^−8 pixels, from positions after the motion.
fn exact(viewing: &Viewing, size: Size, [a, b]: [[f64; 3]; 2]) -> Option<[[f64; 2]; 2]> {
    let f = |x: Q5_11| x.to_num::<f64>();
    let [ex, ey, ez] = viewing.eye.map(f);
    let plane = f(viewing.plane);
    let ([xl, yl], [xh, yh]) = (viewing.window.low.map(f), viewing.window.high.map(f));
    let [width, height] = size.pixels().map(|pixels| 256.0 * f64::from(pixels));
    // Numerators and denominators of both axes, and the distances to the limits, are linear along the segment.
    let fractions = |[x, y, z]: [f64; 3]| {
        let (depth, distance) = (ez - plane, ez - z);
        [
            [
                width * ((ex - xl) * distance - depth * (ex - x)),
                (xh - xl) * distance,
            ],
            [
                height * ((yh - ey) * distance + depth * (ey - y)),
                (yh - yl) * distance,
            ],
        ]
    };
    let at = |t: f64| [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]));
    let guard = f64::from(GUARD);
    let limits = |p: [f64; 3]| {
        let [[x, w], [y, v]] = fractions(p);
        [
            plane - p[2],
            guard * w - x,
            guard * w + x,
            guard * v - y,
            guard * v + y,
        ]
    };
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (at_a, at_b) in limits(a).into_iter().zip(limits(b)) {
        match (at_a < 0.0, at_b < 0.0) {
            (true, true) => return None,
            (true, false) => from = from.max(at_a / (at_a - at_b)),
            (false, true) => to = to.min(at_a / (at_a - at_b)),
            (false, false) => {}
        }
    }
    (from <= to).then(|| [from, to].map(|t| fractions(at(t)).map(|[x, w]| x / w)))
}

fn moved(segment: [[f64; 3]; 2]) -> [[Q12_20; 3]; 2] {
    segment.map(|point| point.map(Q12_20::from_num))
}

/// The projection without motion, to a picture 640 pixels wide.
fn line(viewing: &Viewing, segment: Segment) -> Option<ScreenLine> {
    Projection::new(viewing, Size::W640).line(Motion::default().pose().segment(segment))
}

/// The largest distance between two lines, in units of 2^−8 pixels.
fn distance(line: ScreenLine, exact: [[f64; 2]; 2]) -> f64 {
    let ends = line.as_flattened().iter().zip(exact.as_flattened());
    ends.map(|(&found, exact)| (f64::from(found) - exact).abs())
        .fold(0.0, f64::max)
}

fn any_viewing() -> impl Strategy<Value = Viewing> {
    let corners = || [any::<i16>(), any::<i16>()];
    (
        (any::<i16>(), any::<i16>(), 0..=i16::MAX),
        any::<i16>(),
        [corners(), corners()],
    )
        .prop_filter_map("no area", |((ex, ey, ez), plane, [low, high])| {
            let q = Q5_11::from_bits;
            let ordered = |i: usize| (low[i].min(high[i]), low[i].max(high[i]));
            let ((xl, xh), (yl, yh)) = (ordered(0), ordered(1));
            let viewing = Viewing {
                eye: [ex, ey, ez].map(q),
                plane: q(plane.min(ez - 1)),
                window: Window {
                    low: [q(xl), q(yl)],
                    high: [q(xh), q(yh)],
                },
            };
            (xl < xh && yl < yh).then_some(viewing)
        })
}

/// A coordinate in the range of moved points, with 20 fraction bits.
fn any_coordinate() -> impl Strategy<Value = i32> {
    -(56 << 20)..=56 << 20
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// For segments behind the view plane every end is the f64 position rounded to nearest, even after clipping to the guard
    /// band.
    #[test]
    fn every_end_is_rounded_once(
        viewing in any_viewing(),
        ends in any::<[bool; 2]>(),
        bits in [[any_coordinate(), any_coordinate(), any_coordinate()], [any_coordinate(), any_coordinate(), any_coordinate()]],
    ) {
        let plane = viewing.plane.to_num::<f64>();
        let mut segment = bits.map(|point| point.map(|x| f64::from(x) / f64::from(1 << 20)));
        // Half of the points are near the window, because most other points project far beyond the guard band.
        for (point, near) in segment.iter_mut().zip(ends) {
            if near {
                *point = point.map(|x| x / 16.0).map(|x| (x * 2048.0).round() / 2048.0);
            }
            if point[2] > plane {
                point[2] = plane - (point[2] - plane) * 0.25;
            }
            point[2] = Q12_20::from_num(point[2].min(plane)).to_num();
        }
        let segment = segment.map(|point| point.map(|x| Q12_20::from_num(x).to_num::<f64>()));
        let found = Projection::new(&viewing, Size::W1280).line(moved(segment));
        match (found, exact(&viewing, Size::W1280, segment)) {
            (Some(found), Some(exact)) => prop_assert!(distance(found, exact) <= 0.5 + 1e-4, "{:?} {:?}", found, exact),
            (None, None) => {}
            // For a segment that only touches the guard band's corner the accuracy of f64 is insufficient.
            (found, exact) => {
                let ends = found.map(|line| line.map(|end| end.map(f64::from))).or(exact).expect("one of them");
                let corner = |end: [f64; 2]| end.iter().all(|x| (x.abs() - f64::from(GUARD)).abs() < 2.0);
                prop_assert!(ends.into_iter().any(corner), "{:?} {:?}", found, exact);
            }
        }
    }

    /// No combination of program, motion and segment exceeds the range of the arithmetic: an overflow would panic here.
    #[test]
    fn all_inputs_project(
        viewing in any_viewing(),
        segment in any::<[[i16; 3]; 2]>(),
        corners in any::<[[bool; 3]; 2]>(),
        pans in [-128..=127_i8, -128..=127, -128..=127],
        turns in 0..40_usize,
        size in prop::sample::select(&Size::ALL[..]),
    ) {
        let mut motion = Motion::default();
        motion.apply(Step::Pan(pans));
        motion.apply(Step::Pan(pans));
        for turn in 0..turns {
            motion.apply(if turn % 2 == 0 { Step::AboutX { forwards: true } } else { Step::AboutY { forwards: false } });
        }
        let pose = motion.pose();
        for segment in [segment, corners.map(|point| point.map(|high| if high { i16::MAX } else { i16::MIN }))] {
            let moved = pose.segment(segment.map(|point| point.map(Q5_11::from_bits)));
            prop_assert!(moved.as_flattened().iter().all(|x| x.abs() < 56));
            if let Some(line) = Projection::new(&viewing, size).line(moved) {
                prop_assert!(line.as_flattened().iter().all(|x| (-GUARD..=GUARD).contains(x)));
                // The direction of the segment does not matter.
                let [a, b] = line;
                let [from, to] = moved;
                prop_assert_eq!(Projection::new(&viewing, size).line([to, from]), Some([b, a]));
            }
        }
    }

    /// From program to screen, with motion, the error is at most 1/256 pixel for windows at least 1 wide and high, with the eye
    /// at least 2 in front of the view plane.
    #[test]
    fn the_whole_way_is_within_a_unit(
        depth in 2.0..8.0_f64,
        window in [-3.0..-0.5_f64, -2.0..-0.5, 0.5..3.0, 0.5..2.0],
        segment in [[-4.0..4.0_f64, -4.0..4.0, -4.0..4.0], [-4.0..4.0, -4.0..4.0, -4.0..4.0]],
        steps in prop::collection::vec((0..3_usize, any::<bool>()), 0..100),
    ) {
        let viewing = viewing([0.25, -0.5, 4.0 + depth], 4.0, window);
        let segment = segment.map(point);
        let mut motion = Motion::default();
        let mut exact_ends = segment.map(|point| point.map(|x| x.to_num::<f64>()));
        let (sine, cosine) = (64.0_f64).atan2(2047.0).sin_cos();
        for (kind, forwards) in steps {
            let sine = if forwards { sine } else { -sine };
            let step = match kind {
                0 => Step::AboutX { forwards },
                1 => Step::AboutY { forwards },
                _ => Step::Pan([1, 0, if forwards { 2 } else { -2 }]),
            };
            prop_assert!(motion.apply(step));
            for [x, y, z] in &mut exact_ends {
                match kind {
                    0 => (*y, *z) = (*y * cosine - *z * sine, *y * sine + *z * cosine),
                    1 => (*z, *x) = (*z * cosine - *x * sine, *z * sine + *x * cosine),
                    _ => (*x, *z) = (*x + 0.0625, *z + if forwards { 0.125 } else { -0.125 }),
                }
            }
        }
        let found = Projection::new(&viewing, Size::W640).line(motion.pose().segment(segment));
        if let (Some(found), Some(exact)) = (found, exact(&viewing, Size::W640, exact_ends)) {
            // The position of a cut along a segment that is nearly in the view plane is uncertain, but it is on the segment's line.
            let whole = exact_ends.map(|[_, _, z]| z < 3.999);
            let [a, b] = exact;
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = along[0].hypot(along[1]).max(1.0);
            for ((found, exact), whole) in found.into_iter().zip(exact).zip(whole) {
                let [dx, dy] = [0, 1].map(|i| f64::from(found[i]) - exact[i]);
                let beside = (dx * along[1] - dy * along[0]).abs() / length;
                let error = if whole && exact.iter().all(|x| x.abs() < f64::from(GUARD) - 1.0) { dx.abs().max(dy.abs()) } else { beside };
                prop_assert!(error <= 1.0, "{}", error);
            }
        }
    }
}

/// The window ±2 × ±1.125 at z = 2, seen from z = 4: 160 pixels per unit at the view plane.
fn usual() -> Viewing {
    viewing([0.0, 0.0, 4.0], 2.0, [-2.0, -1.125, 2.0, 1.125])
}

#[test]
fn ends_round_to_nearest_on_both_sides_of_zero() {
    // One unit in Q5.11 is 20 units of 2^−8 pixels in the view plane; at z = 4 − 2·n the scale is n times smaller.
    let unit = |x: i16, z: f64| {
        let p = [Q5_11::from_bits(x), q(0.0), q(z)];
        line(&usual(), [p, p]).expect("a line")[0][0] - (320 << 8)
    };
    assert_eq!([unit(1, 2.0), unit(-1, 2.0)], [20, -20]);
    // 20/3 and 20/8 units are rounded to nearest, half units up.
    assert_eq!([unit(1, -2.0), unit(-1, -2.0)], [7, -7]);
    assert_eq!([unit(1, -12.0), unit(-1, -12.0)], [3, -2]);
}

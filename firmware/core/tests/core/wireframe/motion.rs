//! Tests of the motion by steps; tools/reference measures its error against f64.

use glint_core::fixed::{Q5_11, Q12_20};
use glint_core::wireframe::{
    Key, Motion, PAN, ROTATION_COSINE, ROTATION_SINE, Segment, Step, accumulate,
};
use proptest::prelude::*;

use super::{point, q};

fn any_step() -> impl Strategy<Value = Step> {
    (prop::sample::select(&Key::ALL[..]), any::<bool>()).prop_map(|(key, rotate)| key.step(rotate))
}

/// Returns the inverse of a step.
fn inverse(step: Step) -> Step {
    match step {
        Step::Pan(direction) => Step::Pan(direction.map(|x| -x)),
        Step::AboutX { forwards } => Step::AboutX {
            forwards: !forwards,
        },
        Step::AboutY { forwards } => Step::AboutY {
            forwards: !forwards,
        },
    }
}

#[test]
fn the_numbers_of_the_original() {
    assert_eq!(PAN, 0.0625);
    assert_eq!(ROTATION_COSINE.to_bits(), 0x07FF);
    let cosine = ROTATION_COSINE.to_num::<f64>();
    assert_eq!(ROTATION_SINE, q((1.0 - cosine * cosine).sqrt()));
}

#[test]
fn without_a_step_points_are_exact() {
    let pose = Motion::default().pose();
    for bits in [i16::MIN, -1, 0, 1, i16::MAX] {
        let x = Q5_11::from_bits(bits);
        assert_eq!(pose.point([x; 3]), [Q12_20::from(x); 3]);
    }
}

#[test]
fn directions() {
    let after = |key: Key, rotate, from: [f64; 3]| {
        let mut motion = Motion::default();
        assert!(motion.apply(key.step(rotate)));
        motion.pose().point(point(from)).map(|x| x.to_num::<f64>())
    };
    assert_eq!(after(Key::Up, false, [1.0, 2.0, 3.0]), [1.0, 2.0625, 3.0]);
    assert_eq!(after(Key::Left, false, [1.0, 2.0, 3.0]), [0.9375, 2.0, 3.0]);
    assert_eq!(after(Key::ZoomIn, true, [1.0, 2.0, 3.0]), [1.0, 2.0, 3.125]);
    // The near side of the segments moves in the direction of the arrow, by sin ε.
    let near = [0.0, 0.0, 8.0];
    let moves = |key, axis: usize, sign: f64| {
        let [x, y, z] = after(key, true, near);
        let expected = sign * 8.0 * 0.03125;
        assert!(([x, y][axis] - expected).abs() < 1e-3, "{key}: {x} {y}");
        assert_eq!([y, x][axis], 0.0);
        assert!((z - 8.0 * (2047.0 / 2048.0)).abs() < 1e-3);
    };
    moves(Key::Up, 1, 1.0);
    moves(Key::Down, 1, -1.0);
    moves(Key::Right, 0, 1.0);
    moves(Key::Left, 0, -1.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    /// The inverse steps in reverse order lead back to the start, within the precision of the pose.
    #[test]
    fn the_way_back_leads_to_the_start(steps in prop::collection::vec(any_step(), 0..500)) {
        let mut motion = Motion::default();
        let done: Vec<Step> = steps.into_iter().filter(|&step| motion.apply(step)).collect();
        for step in done.into_iter().rev() {
            prop_assert!(motion.apply(inverse(step)));
        }
        prop_assert_eq!(motion.pose(), Motion::default().pose());
    }

    /// A step of the accumulated form moves either all end points or none.
    #[test]
    fn a_step_in_place_moves_all_or_none(bits in prop::collection::vec(any::<[[i16; 3]; 2]>(), 1..5), step in any_step()) {
        let before: Vec<Segment> = bits.iter().map(|ends| ends.map(|point| point.map(Q5_11::from_bits))).collect();
        let mut after = before.clone();
        if accumulate::apply(&mut after, step) {
            let mut motion = Motion::default();
            prop_assert!(motion.apply(step));
            let pose = motion.pose();
            // One step of the accumulated form is within half a unit of the exact motion, apart from the length of (c, s), which is not
            // exactly 1.
            for (old, new) in before.iter().flatten().zip(after.iter().flatten()) {
                for (exact, new) in pose.point(*old).into_iter().zip(*new) {
                    prop_assert!((exact - Q12_20::from(new)).abs().to_num::<f64>() * 2048.0 < 0.51);
                }
            }
        } else {
            prop_assert_eq!(before, after);
        }
    }
}

#[test]
fn a_step_in_place_rounds_to_nearest() {
    let mut segments = [[point([0.0, 0.0, 1.0]), point([0.0, 0.0, -1.0])]];
    assert!(accumulate::apply(
        &mut segments,
        Step::AboutX { forwards: false }
    ));
    assert_eq!(
        segments.as_flattened().map_bits(),
        [[0, 64, 2047], [0, -64, -2047]]
    );
    let mut segments = [[[Q5_11::from_bits(1); 3], [Q5_11::from_bits(-17); 3]]];
    assert!(accumulate::apply(
        &mut segments,
        Step::AboutY { forwards: true }
    ));
    // z' = nearest((z·2047 − x·64)/2048), x' = nearest((z·64 + x·2047)/2048).
    assert_eq!(
        segments.as_flattened().map_bits(),
        [[1, 1, 1], [-18, -17, -16]]
    );
}

trait MapBits {
    fn map_bits(&self) -> Vec<[i16; 3]>;
}

impl MapBits for [[Q5_11; 3]] {
    fn map_bits(&self) -> Vec<[i16; 3]> {
        self.iter().map(|point| point.map(Q5_11::to_bits)).collect()
    }
}

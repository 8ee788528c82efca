//! Tests of the control of the camera by a hand.

use glint_core::fixed::{Q4_28, Q32_32, Turns, U16_16};
use glint_core::gesture::{
    Blob, Control, Doubt, EngineSetting, OneEuro, PATIENCE, POLE, Presence, Region, Statistics,
    TimeStep, Tuning, target,
};
use proptest::prelude::*;

const SIZE: [u16; 2] = [320, 240];
/// Time between two camera frames in µs.
const FRAME: u32 = 16_667;

/// Statistics of a rectangle of the hand's colour.
fn rectangle(first: [u16; 2], last: [u16; 2]) -> Statistics {
    let bounds = Region { first, last };
    let [columns, rows] = bounds.size();
    let count = columns * rows;
    let sums = [0, 1].map(|axis| (u32::from(first[axis]) + u32::from(last[axis])) * count / 2);
    Statistics {
        size: SIZE,
        count,
        sums,
        bounds,
        is_whole: true,
    }
}

/// Statistics of a square hand with its centre at a pixel.
fn hand(x: u16, y: u16, half: u16) -> Statistics {
    rectangle([x - half, y - half], [x + half, y + half])
}

/// Statistics of a frame without pixels of the hand's colour.
const EMPTY: Statistics = Statistics {
    size: SIZE,
    count: 0,
    sums: [0; 2],
    bounds: Region {
        first: [2_047; 2],
        last: [0; 2],
    },
    is_whole: true,
};

/// A control that gets frames at a steady rate, except for frames with a stated delay.
struct Run {
    control: Control,
    /// Time of the last frame in µs.
    time: u64,
}

impl Run {
    fn new() -> Self {
        Self {
            control: Control::default(),
            time: 0,
        }
    }

    fn frame(&mut self, statistics: &Statistics) -> Result<Blob, Doubt> {
        self.frame_after(FRAME.into(), statistics)
    }

    fn frame_after(&mut self, gap: u64, statistics: &Statistics) -> Result<Blob, Doubt> {
        self.time += gap;
        self.control.on_frame(self.time, statistics)
    }

    fn frames(&mut self, number: u32, statistics: &Statistics) {
        for _ in 0..number {
            let _ = self.frame(statistics);
        }
    }

    /// Azimuth and polar angle in degrees, and distance.
    fn pose(&self) -> [f64; 3] {
        let pose = self.control.pose();
        let degrees = |angle: Turns| angle.to_signed_degrees().to_num();
        [degrees(pose.theta), degrees(pose.phi), pose.r.to_num()]
    }
}

#[test]
fn the_centre_is_the_mean_of_the_pixels() {
    let blob = rectangle([10, 20], [11, 229]).blob().expect("a hand");
    assert_eq!(blob.centre.map(|x| x.to_num::<f64>()), [10.5, 124.5]);
    assert_eq!(blob.count, 420);
    // The largest frame, with the largest number of pixels of a hand.
    let size = [1_280, 720];
    let blob = Statistics {
        size,
        ..rectangle([0, 0], [1_119, 719])
    }
    .blob()
    .expect("a hand");
    assert_eq!(blob.centre.map(|x| x.to_num::<f64>()), [559.5, 359.5]);
    assert_eq!(
        blob.width.to_num::<f64>(),
        (0.875_f64.sqrt() * 65_536.0).floor() / 65_536.0
    );
    assert_eq!(blob.confidence(size), 254);
}

#[test]
fn place_and_width_become_a_place_on_the_sphere() {
    let at = |statistics: &Statistics| {
        let blob = statistics.blob().expect("a hand");
        target(&blob, statistics.size).map(|x| x.to_num::<f64>())
    };
    let near = |found: [f64; 3], expected: [f64; 3]| {
        assert!(
            core::iter::zip(found, expected).all(|(a, b)| (a - b).abs() < 1e-4),
            "expected {expected:?}, found {found:?}"
        );
    };
    // A hand in the middle, with a quarter of the frame's width and height.
    let middle = rectangle([120, 90], [199, 149]);
    near(at(&middle), [0.0, 0.25, 5.0 - 8.0 * (0.25 - 0.0625)]);
    // A hand at the borders, and hands with a width outside the limits.
    let pole = POLE.to_num::<f64>();
    let corner = rectangle([0, 0], [9, 9]);
    near(at(&corner), [5.0 / 320.0 - 0.5, pole.max(5.0 / 480.0), 5.0]);
    let corner = rectangle([310, 230], [319, 239]);
    near(at(&corner), [0.5 - 5.0 / 320.0, 0.5 - pole, 5.0]);
    near(
        at(&rectangle([0, 0], [319, 199])),
        [0.0, 100.0 / 480.0, 2.0],
    );
}

const TUNING: Tuning = Tuning {
    cutoff: U16_16::lit("2"),
    slope: U16_16::lit("10"),
    speed_cutoff: U16_16::lit("2"),
};

#[test]
fn the_lag_behind_a_steady_motion_is_that_of_the_corner_frequency() {
    for speed in [0.0625, 0.25, 1.0] {
        for rate in [30.0, 60.0, 120.0] {
            let step = TimeStep::new((1e6 / rate) as u32);
            let mut filter = OneEuro::new(Q4_28::ZERO);
            let mut lag = 0.0;
            for frame in 0..(2.0 * rate) as u32 {
                let input = speed * f64::from(frame) / rate;
                let output: f64 = filter.next(Q4_28::from_num(input), &TUNING, step).to_num();
                lag = (input - output) / speed;
            }
            let expected = 1.0 / (std::f64::consts::TAU * (2.0 + 10.0 * speed));
            assert!(
                (lag / expected - 1.0).abs() < 2e-3,
                "speed {speed}, rate {rate}: expected a lag of {expected} s, found {lag} s"
            );
        }
    }
}

#[test]
fn steps_are_followed_without_overshoot_to_the_end() {
    for micros in [1, 1_000, 8_333, 33_333, 100_000, u32::MAX] {
        let step = TimeStep::new(micros);
        let mut filter = OneEuro::new(Q4_28::lit("-7.5"));
        let mut last = Q4_28::lit("-7.5");
        for _ in 0..20_000 {
            let output = filter.next(Q4_28::lit("7.5"), &TUNING, step);
            assert!(last <= output && output <= Q4_28::lit("7.5"), "{micros} µs");
            last = output;
        }
        assert!(last >= Q4_28::lit("7.4999"), "{micros} µs: {last}");
    }
}

#[test]
fn a_hand_in_three_frames_steers_the_camera() {
    let mut run = Run::new();
    assert_eq!(
        (run.control.presence(), run.control.setting()),
        (Presence::Absent, EngineSetting::SEARCHING)
    );
    let start = run.pose();
    assert_eq!(start, [0.0, 90.0, 3.5]);
    for presence in [Presence::Appearing, Presence::Appearing, Presence::Tracked] {
        assert!(run.frame(&hand(80, 60, 20)).is_ok());
        assert_eq!(run.control.presence(), presence);
        assert_eq!(run.pose(), start, "the camera has not moved yet");
    }
    let setting = run.control.setting();
    assert_eq!(
        (setting.region.first, setting.region.last),
        ([20, 10], [140, 110])
    );
    run.frames(120, &hand(80, 60, 20));
    let [theta, phi, r] = run.pose();
    let expected = [
        (80.5 / 320.0 - 0.5) * 360.0,
        60.5 / 240.0 * 180.0,
        5.0 - 8.0 * (41.0 / 76_800_f64.sqrt() - 0.0625),
    ];
    assert!((theta - expected[0]).abs() < 0.1, "{theta}");
    assert!((phi - expected[1]).abs() < 0.1, "{phi}");
    assert!((r - expected[2]).abs() < 0.01, "{r}");
    assert!(run.control.pose().view().is_ok());
}

#[test]
fn a_lost_hand_holds_the_camera_and_the_return_is_smooth() {
    let mut run = Run::new();
    run.frames(120, &hand(60, 60, 20));
    let held = run.pose();
    let region = run.control.setting();
    run.frames(5, &EMPTY);
    assert_eq!(run.control.presence(), Presence::Held);
    // The hand may have left the region for a hand at rest, so the region for a hand in motion is searched.
    let larger = EngineSetting::moving(&region.region, SIZE);
    assert_eq!((run.pose(), run.control.setting()), (held, larger));
    // The hand comes back within the region: the camera follows at once, without a jump.
    assert!(run.frame(&hand(70, 60, 20)).is_ok());
    assert_eq!(
        (run.control.presence(), run.pose()),
        (Presence::Tracked, held)
    );
    run.frames(120, &hand(60, 60, 20));
    // The hand is absent for a long time: the whole frame is searched.
    run.frames(PATIENCE.div_ceil(FRAME) + 1, &EMPTY);
    assert_eq!(
        (run.control.presence(), run.control.setting()),
        (Presence::Absent, EngineSetting::SEARCHING)
    );
    let held = run.pose();
    // The hand comes back at the other side: the camera takes the shorter arc, across 180°.
    let mut last = held;
    let mut largest: f64 = 0.0;
    for _ in 0..240 {
        assert!(run.frame(&hand(290, 60, 20)).is_ok());
        let pose = run.pose();
        let turned = (pose[0] - last[0] + 540.0).rem_euclid(360.0) - 180.0;
        assert!(turned <= 1e-6, "the camera turns by {turned}°");
        largest = largest.max(-turned);
        last = pose;
    }
    assert!(
        (last[0] - (290.5 / 320.0 - 0.5) * 360.0).abs() < 0.1,
        "{last:?}"
    );
    // The path is 101° long; the fastest part of the return covers 4 % of the path in a frame, at 60 frames per second.
    assert!(largest < 4.0, "{largest}° in a frame");
}

#[test]
fn a_jump_of_the_area_holds_until_it_lasts() {
    let mut run = Run::new();
    run.frames(120, &hand(160, 120, 20));
    let held = run.pose();
    assert_eq!(run.frame(&hand(160, 120, 12)), Err(Doubt::Jump));
    assert_eq!((run.control.presence(), run.pose()), (Presence::Held, held));
    // The hand has its earlier area again.
    assert!(run.frame(&hand(160, 120, 20)).is_ok());
    assert_eq!(run.control.presence(), Presence::Tracked);
    // The next frame counts shorter runs, so any area is accepted.
    assert!(run.frame(&hand(160, 120, 20)).is_ok());
    // The new area persists: it is accepted after [`PATIENCE`] and three frames.
    run.frames(PATIENCE.div_ceil(FRAME) + 4, &hand(160, 120, 12));
    assert_eq!(run.control.presence(), Presence::Tracked);
    let before = run.pose();
    assert!((before[2] - held[2]).abs() < 0.2, "{before:?} {held:?}");
    run.frames(240, &hand(160, 120, 12));
    assert!((run.pose()[2] - (5.0 - 8.0 * (25.0 / 76_800_f64.sqrt() - 0.0625))).abs() < 0.01);
}

fn statistics() -> impl Strategy<Value = Statistics> {
    let place = 0..400_u16;
    let corner = || [place.clone(), place.clone()];
    let any_size = prop_oneof![8 => Just(SIZE), 1 => any::<[u16; 2]>()];
    let count = prop_oneof![4 => 0..5_000_u32, 1 => any::<u32>()];
    (
        any_size,
        count,
        corner(),
        corner(),
        any::<[u32; 2]>(),
        0..20_u8,
    )
        .prop_map(|(size, count, middle, first, sums, kind)| {
            let plausible = middle.map(|x| u32::from(x).saturating_mul(count));
            Statistics {
                size,
                count,
                sums: if kind == 0 { sums } else { plausible },
                bounds: Region {
                    first,
                    last: [0, 1].map(|i| first[i].saturating_add(300)),
                },
                is_whole: kind != 1,
            }
        })
}

proptest! {
    #[test]
    fn centres_are_rounded_down(count in 1..20_000_u32, x in 0..1_280_u32, y in 0..720_u32, rest in any::<u32>()) {
        let sums = [x * count + rest % count, y * count + rest % count];
        let bounds = Region { first: [0, 0], last: [1_279, 719] };
        let statistics = Statistics { size: [320, 240], count, sums, bounds, is_whole: true };
        if let Ok(blob) = statistics.blob() {
            for (centre, sum) in blob.centre.into_iter().zip(sums) {
                prop_assert_eq!(u64::from(centre.to_bits()), (u64::from(sum) << 12) / u64::from(count));
            }
            let width = (f64::from(count) / 76_800.0).sqrt();
            prop_assert!((blob.width.to_num::<f64>() - width).abs() < 1e-4);
        }
    }

    #[test]
    fn no_statistics_move_the_camera_out_of_range(frames in proptest::collection::vec((statistics(), 0..300_000_u32), 1..60)) {
        let mut run = Run::new();
        for (statistics, gap) in frames {
            let _ = run.frame_after(gap.into(), &statistics);
            let pose = run.control.pose();
            prop_assert!(pose.view().is_ok(), "{:?}", pose);
            prop_assert!(pose.phi >= Turns(POLE.to_bits() as u32 * 16) && pose.phi <= Turns::HALF);
            prop_assert!((Q32_32::lit("2")..=Q32_32::lit("5")).contains(&pose.r));
        }
    }
}

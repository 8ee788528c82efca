//! Tests of attitudes against closed forms: accuracy, length 1 of the quaternions, and absence of panics.

use glint_core::fixed::{Q2_30, Q32_32, Turns};
use glint_core::orientation::{
    Angles, Gain, Integrator, LONGEST_STEP, Quaternion, Sample, SampleEffect, Scale, TIME_CONSTANT,
    Tilt, Tracker,
};

use crate::random::Random;

type Parts = [f64; 4];

fn parts(quaternion: Quaternion) -> Parts {
    quaternion.parts().map(Q2_30::to_num)
}

fn times(a: Parts, b: Parts) -> Parts {
    let ([aw, ax, ay, az], [bw, bx, by, bz]) = (a, b);
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]
}

/// Returns the angle between two attitudes, in degrees.
fn apart(a: Parts, b: Parts) -> f64 {
    let [w, x, y, z] = times([a[0], -a[1], -a[2], -a[3]], b);
    2.0 * (x * x + y * y + z * z).sqrt().atan2(w.abs()).to_degrees()
}

fn excess(quaternion: Quaternion) -> f64 {
    let norm = parts(quaternion).iter().map(|x| x * x).sum::<f64>().sqrt();
    (norm - 1.0).abs()
}

#[test]
fn a_late_sample_counts_for_its_time() {
    let counts = [1_000 << 8, -500 << 8, 20_000 << 8];
    let mut even: Integrator = Integrator::new(Scale::MPU_6050, Quaternion::IDENTITY, counts);
    let mut uneven = even;
    let mut random = Random(1);
    let mut time = 0;
    while time < 10_000_000 {
        let step = (1 + random.next() % 9_000) as u32;
        let step = step.min(10_000_000 - time);
        uneven.advance(counts, step, [0; 3]);
        time += step;
    }
    for _ in 0..10_000 {
        even.advance(counts, 1_000, [0; 3]);
    }
    assert!(apart(parts(even.attitude()), parts(uneven.attitude())) < 1e-6);
}

#[test]
fn no_input_leaves_the_sphere() {
    let mut random = Random(7);
    let lsb = [8, 16, 131, 4_096].map(|lsb: i32| Scale::new(Q32_32::from_num(lsb)));
    for round in 0..200 {
        let scale = lsb[round % 4].expect("a scale");
        let mut integrator: Integrator = Integrator::new(scale, Quaternion::IDENTITY, [0; 3]);
        for _ in 0..200 {
            let extreme = random.next();
            let rate = [0, 1, 2].map(|axis| match extreme >> (2 * axis) & 3 {
                0 => i32::MAX,
                1 => i32::MIN,
                2 => (random.next() as i32) >> 8,
                _ => (random.next() as i16).into(),
            });
            let step = match extreme >> 8 & 7 {
                0 => 0,
                1 => u32::MAX,
                2 => LONGEST_STEP,
                3 => (random.next() % u64::from(LONGEST_STEP)) as u32,
                4 => 1,
                _ => (random.next() % 30_000) as u32,
            };
            let correction = [0; 3].map(|_: i32| (random.next() as i64) >> 12);
            integrator.advance(rate, step, correction);
            let norm = excess(integrator.attitude());
            assert!(norm <= 3e-9, "{norm:e}");
        }
    }
}

#[test]
fn gains_are_exact_for_steps_of_any_length() {
    const STEPS: [u32; 10] = [
        1, 10, 100, 999, 1_000, 1_001, 5_000, 62_500, 200_000, 500_000,
    ];
    for time_constant in [1_000, 20_000, 500_000, 3_000_000, 1_000_000_000_u32] {
        let mut gain = Gain::new(time_constant);
        for step in STEPS {
            let exact = -(-f64::from(step) / f64::from(time_constant)).exp_m1() * 2f64.powi(32);
            let error = (f64::from(gain.of(step)) - exact).abs();
            assert!(
                error <= 4.0 + exact * 2f64.powi(-16),
                "step {step}, time constant {time_constant}: error {error} of {exact}"
            );
        }
    }
    // For steps from a tenth to ten times the time constant the error must be below 1e-8.
    for ratio in [0.1, 0.3, 1.0, 3.0, 10.0] {
        let time_constant = 50_000;
        let step = (f64::from(time_constant) * ratio) as u32;
        let got = f64::from(Gain::new(time_constant).of(step)) / 2f64.powi(32);
        let error = (got + (-ratio).exp_m1()).abs();
        assert!(error < 1e-8, "{ratio}: {error:e}");
    }
    assert_eq!(Gain::new(1_000).of(500_000), u32::MAX);
}

fn degrees(angle: Turns) -> f64 {
    angle.to_signed_degrees().to_num()
}

#[test]
fn angles_are_those_of_f64_and_the_way_back() {
    let mut random = Random(3);
    let mut largest = 0.0_f64;
    for _ in 0..20_000 {
        let angles = Angles {
            yaw: Turns(random.next() as u32),
            pitch: Turns(((random.next() as i32) >> 1) as u32),
            roll: Turns(random.next() as u32),
        };
        let quaternion = Quaternion::from_angles(angles);
        let about = |axis: usize, angle: Turns| {
            let (sin, cos) = (degrees(angle).to_radians() / 2.0).sin_cos();
            let mut parts = [cos, 0.0, 0.0, 0.0];
            parts[axis] = sin;
            parts
        };
        let truth = times(
            times(about(3, angles.yaw), about(2, angles.pitch)),
            about(1, angles.roll),
        );
        assert!(apart(parts(quaternion), truth) < 6e-7);
        assert!(excess(quaternion) <= 2e-9);
        let got = quaternion.angles();
        let level = degrees(angles.pitch).to_radians().cos();
        // Near the pole yaw and roll turn about almost the same axis, so the error of each angle is the error of the quaternion
        // divided by cos(pitch).
        let most = 6e-7 / level + 1e-7;
        for (got, want, most) in [
            (got.yaw, angles.yaw, most),
            (got.roll, angles.roll, most),
            (got.pitch, angles.pitch, 6e-7),
        ] {
            let error = degrees(got.wrapping_add(-want)).abs();
            largest = largest.max(error * level);
            assert!(error <= most, "{angles:?}: {error} > {most}");
        }
    }
    println!("yaw and roll within {largest:.1e}°/cos(pitch)");
}

/// While the pitch passes ±90°, the quaternion is continuous, and the angles follow the convention in the
/// documentation of `Quaternion::angles`.
#[test]
fn the_pole_is_defined() {
    for sign in [1, -1_i64] {
        let mut before: Option<Quaternion> = None;
        for thousandth in 80_000..100_000_i64 {
            let pitch = Turns::from_degrees(Q32_32::from_num(sign * thousandth) / 1_000);
            let yaw = Turns::from_degrees(Q32_32::from_num(20));
            let roll = Turns::from_degrees(Q32_32::from_num(30));
            let quaternion = Quaternion::from_angles(Angles { yaw, pitch, roll });
            if let Some(before) = before {
                let turned = apart(parts(before), parts(quaternion));
                assert!((turned - 1e-3).abs() < 5e-7, "{thousandth}: {turned}");
            }
            before = Some(quaternion);
            let got = quaternion.angles();
            let from_pole = (90_000 - thousandth).abs() as f64 / 1_000.0;
            let most = 3e-7 / from_pole.to_radians().sin().max(1e-9);
            // Beyond the pole the pitch decreases again, and yaw and roll are each half a turn from the given angles.
            let beyond = thousandth > 90_000;
            let [yaw, roll] = [20.0, 30.0].map(|angle| if beyond { angle - 180.0 } else { angle });
            let said = [degrees(got.yaw), degrees(got.roll)];
            assert!((degrees(got.pitch).abs() - 90.0 + from_pole).abs() < 5e-7);
            if from_pole == 0.0 {
                // At the poles yaw is the remaining rotation: yaw − roll at pitch +90°, yaw + roll at −90°.
                let whole = 20.0 - 30.0 * sign as f64;
                assert!((said[0] - whole).abs() < 1e-6 && said[1] == 0.0, "{said:?}");
            } else {
                assert!((said[0] - yaw).abs() <= most, "{thousandth}: {said:?}");
                assert!((said[1] - roll).abs() <= most, "{thousandth}: {said:?}");
            }
        }
    }
}

#[test]
fn quaternions_of_any_numbers() {
    let bits = [0, 1, -1, 2, 1 << 29, 1 << 30, i32::MAX, -i32::MAX, i32::MIN];
    for w in bits {
        for x in bits {
            for y in bits {
                for z in bits {
                    let numbers = [w, x, y, z].map(Q2_30::from_bits);
                    let Some(made) = Quaternion::new(numbers) else {
                        assert_eq!([w, x, y, z], [0; 4]);
                        continue;
                    };
                    let squares = numbers.map(|x| x.to_num::<f64>().powi(2));
                    let length = squares.iter().sum::<f64>().sqrt();
                    assert!(excess(made) <= 2e-9, "{numbers:?}");
                    for (got, want) in parts(made).iter().zip(numbers) {
                        assert!((got - want.to_num::<f64>() / length).abs() < 3e-9);
                    }
                }
            }
        }
    }
}

fn upright(accel: [i16; 3]) -> f64 {
    let attitude = Tilt::align(accel);
    let up = attitude.inverse();
    let [_, _, z] = up.axes();
    // The direction of the world's z axis in the body's axes is the third column of the inverse rotation's matrix.
    let a = accel.map(f64::from);
    let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    let cosine = a
        .iter()
        .zip(z)
        .map(|(a, z)| a * f64::from(z) / 2f64.powi(30))
        .sum::<f64>()
        / length;
    // The yaw must be 0. The yaw's error grows towards the pole, where the projection of the x axis is short.
    let yaw = degrees(attitude.angles().yaw).abs();
    assert!(yaw * a[1].hypot(a[2]) <= 6e-7 * length, "{accel:?} {yaw}");
    1.0 - cosine
}

#[test]
fn gravity_says_where_up_is_from_everywhere() {
    let steps = [i16::MIN, -5_000, -3, 0, 1, 4_096, i16::MAX];
    for x in steps {
        for y in steps {
            for z in steps {
                if [x, y, z] != [0; 3] {
                    let error = upright([x, y, z]);
                    assert!(error < 1e-8, "{x} {y} {z}: {error:e}");
                }
            }
        }
    }
    assert_eq!(Tilt::align([0; 3]), Quaternion::IDENTITY);
    assert_eq!(Tilt::align([0, 0, 4_096]), Quaternion::IDENTITY);
}

fn rest(t_us: u64) -> Sample {
    Sample {
        t_us,
        accel: [0, 0, 4_096],
        gyro: [0; 3],
    }
}

fn tracker() -> Tracker {
    Tracker::new(Scale::MPU_6050, Some(Tilt::new(4_096, TIME_CONSTANT)))
}

#[test]
fn what_becomes_of_samples() {
    const WRAP: u64 = 1 << 32;
    let mut tracker = tracker();
    // The low word of the time wraps between the first and the second sample.
    assert_eq!(tracker.on_sample(&rest(WRAP - 401)), SampleEffect::First);
    assert_eq!(tracker.on_sample(&rest(WRAP + 600)), SampleEffect::Step);
    for stale in [WRAP + 600, WRAP + 599, 601, 0] {
        assert_eq!(tracker.on_sample(&rest(stale)), SampleEffect::Stale);
    }
    let turning = |t_us| Sample {
        gyro: [0, 0, 16_400],
        ..rest(t_us)
    };
    let before = tracker.attitude();
    let longest = u64::from(LONGEST_STEP);
    assert_eq!(
        tracker.on_sample(&turning(WRAP + 601 + longest)),
        SampleEffect::Gap
    );
    assert_eq!(tracker.attitude(), before, "held");
    assert_eq!(
        tracker.on_sample(&turning(WRAP + 601 + longest + 90_000)),
        SampleEffect::Step
    );
    let yaw = degrees(tracker.attitude().angles().yaw);
    assert!((yaw - 90.0).abs() < 1e-5, "{yaw}");
    let counts = tracker.counts();
    assert_eq!(
        (counts.steps, counts.stale, counts.gaps, counts.saturated),
        (2, 4, 1, 0)
    );
}

/// After single wrong times or a restart of the clock, few samples are lost.
#[test]
fn wrong_times_do_not_end_the_attitude() {
    const START: u64 = 5_000_000;
    let turning = |t_us| Sample {
        gyro: [0, 0, 1_640],
        ..rest(t_us)
    };
    // The sensor turns at 100 °/s for a second. For each case: the times of the samples from number
    // 500 on, and the number of stale samples, for which an integrated step is missing.
    let in_disorder = [START + 497_500, START + 498_000, START + 499_000];
    let cases: [(&str, &[u64], u64); 10] = [
        ("one ahead", &[u64::MAX >> 1], 1),
        ("one in the next hour", &[3_600_000_000], 1),
        ("one at 0", &[0], 1),
        ("two ahead", &[90_000_000, 95_000_000], 2),
        ("two ahead, exchanged", &[95_000_000, 90_000_000], 2),
        ("three ahead", &[90_000_000, 99_000_000, 95_000_000], 3),
        // The step between two successive wrong times is integrated.
        ("two in order", &[90_000_000, 90_001_000], 1),
        ("three", &[90_000_000, 90_001_000, 95_000_000], 2),
        ("out of order", &in_disorder, 3),
        ("one at the largest time", &[u64::MAX], 1),
    ];
    for (name, wrong, stale) in cases {
        let mut tracker = tracker();
        for i in 0..1_000_u64 {
            let wrong = i.checked_sub(500).and_then(|i| wrong.get(i as usize));
            let t_us = wrong.copied().unwrap_or(START + 1_000 * i);
            tracker.on_sample(&turning(t_us));
        }
        let counts = tracker.counts();
        let yaw = degrees(tracker.attitude().angles().yaw);
        let found = [counts.steps, counts.stale, counts.gaps];
        assert_eq!(found, [999 - stale, stale, 0], "{name}");
        assert!((yaw - 99.9).abs() < 1e-3, "{name}: {yaw}");
    }
    // The clock restarts at 0 after half a second: three samples are stale, the fourth continues.
    let mut tracker = tracker();
    for i in (0..500).chain(0..500) {
        tracker.on_sample(&turning(1_000 * i));
    }
    let counts = tracker.counts();
    assert_eq!((counts.steps, counts.stale, counts.gaps), (995, 3, 1));
    let yaw = degrees(tracker.attitude().angles().yaw);
    assert!((yaw - 99.5).abs() < 1e-3, "{yaw}");
}

/// A single time far ahead does not count as a gap when the next sample continues the earlier times, so the tilt stays settled.
#[test]
fn a_wrong_time_is_no_doubt_of_the_tilt() {
    let mut tracker = tracker();
    for i in 0..5_000 {
        tracker.on_sample(&rest(1_000 * i));
    }
    assert!(tracker.is_settled());
    assert_eq!(tracker.on_sample(&rest(1 << 40)), SampleEffect::Gap);
    assert_eq!(tracker.on_sample(&rest(5_001_000)), SampleEffect::Step);
    assert!(tracker.is_settled());
}

/// The first reading of the accelerometer that shows gravity sets the initial tilt. Shocks and free
/// fall do not show gravity.
#[test]
fn a_shock_at_the_start_is_no_gravity() {
    let shocks: [(&str, [i16; 3], u64); 5] = [
        ("along x", [30_000, 0, 4_096], 100),
        ("at the lower end of the range", [0, i16::MIN, 4_096], 100),
        ("just beyond 3 g", [0, 12_289, 0], 100),
        ("free fall", [0, 30, -20], 0),
        ("less than half a g", [2_000, 0, 0], 0),
    ];
    for (name, shock, rejected) in shocks {
        let mut tracker = tracker();
        // The sensor is rolled by 90° and turns about its y axis, which is vertical, by 90°; for the first 0.1 s the accelerometer reads
        // `shock`.
        for i in 0..=1_000 {
            let accel = if i < 100 { shock } else { [0, 4_096, 0] };
            let effect = tracker.on_sample(&Sample {
                t_us: 1_000 * i,
                accel,
                gyro: [0, 1_476, 0],
            });
            let expected = if i == 0 {
                SampleEffect::First
            } else {
                SampleEffect::Step
            };
            assert_eq!(effect, expected);
        }
        let angles = tracker.attitude().angles();
        let [yaw, pitch, roll] = [angles.yaw, angles.pitch, angles.roll].map(degrees);
        assert!((yaw - 90.0).abs() < 0.05, "{name}: yaw {yaw}");
        assert!(pitch.abs() < 0.05, "{name}: pitch {pitch}");
        assert!((roll - 90.0).abs() < 0.05, "{name}: roll {roll}");
        let counts = tracker.counts();
        assert_eq!((counts.steps, counts.rejected), (1_000, rejected), "{name}");
    }
    // Without any such reading the attitude is the rotation since the first sample.
    let mut tracker = tracker();
    for i in 0..=1_000 {
        tracker.on_sample(&Sample {
            t_us: 1_000 * i,
            accel: [i16::MAX; 3],
            gyro: [0, 0, 1_476],
        });
    }
    let yaw = degrees(tracker.attitude().angles().yaw);
    assert!((yaw - 90.0).abs() < 0.01, "{yaw}");
    assert_eq!(tracker.counts().rejected, 1_001);
}

/// Saturation of the gyroscope turns the estimated attitude upside down while the body is level. Even such a tilt error is
/// corrected within a bounded time.
#[test]
fn tilt_comes_back_after_saturation() {
    for axis in [0, 1] {
        let mut tracker = tracker();
        tracker.on_sample(&rest(0));
        let mut t_us = 0;
        for _ in 0..5_000 {
            t_us += 1_000;
            tracker.on_sample(&rest(t_us));
        }
        assert!(tracker.is_settled());
        // A rate beyond the sensor's range saturates; the tilt then recovers.
        for _ in 0..90 {
            t_us += 1_000;
            let mut gyro = [0; 3];
            gyro[axis] = i16::MAX;
            // In free fall the accelerometer does not determine the tilt.
            tracker.on_sample(&Sample {
                t_us,
                accel: [0; 3],
                gyro,
            });
        }
        let error = |tracker: &Tracker| {
            let [_, _, [x, y, z]] = tracker
                .attitude()
                .inverse()
                .axes()
                .map(|c| c.map(f64::from));
            x.hypot(y).atan2(z).to_degrees()
        };
        assert!(error(&tracker) > 170.0);
        assert_eq!(tracker.counts().saturated, 90);
        assert!(!tracker.is_settled());
        let mut errors = Vec::new();
        for _ in 0..30 {
            for _ in 0..100 {
                t_us += 1_000;
                tracker.on_sample(&rest(t_us));
            }
            errors.push(error(&tracker));
        }
        println!("{:.1}° after 1 s, {:.1}° after 3 s", errors[9], errors[29]);
        assert!(errors.is_sorted_by(|a, b| a >= b), "{errors:?}");
        assert!(errors[9] < 25.0 && errors[29] < 10.0, "{errors:?}");
    }
}

/// In 1000 s at rest without noise the attitude reaches a constant value; rounding does not make it cycle.
#[test]
fn at_rest_nothing_cycles() {
    let mut tracker = tracker();
    let tilted = |t_us| Sample {
        accel: [713, -391, 4_011],
        ..rest(t_us)
    };
    tracker.on_sample(&tilted(0));
    let mut seen = Vec::new();
    for i in 1..200_000_u64 {
        tracker.on_sample(&tilted(i * 5_000));
        if i > 100_000 {
            seen.push(tracker.attitude());
        }
    }
    seen.dedup();
    let moved = seen
        .iter()
        .map(|&at| apart(parts(seen[0]), parts(at)))
        .fold(0.0, f64::max);
    println!("{moved:.1e}° in the second half");
    assert!(moved < 1e-6, "{moved:e}");
}

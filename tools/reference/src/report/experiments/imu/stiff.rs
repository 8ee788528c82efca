//! Experiment: stiff and extreme inputs of the attitude computation, for which simple filters and integrators diverge or drift.

use glint_core::orientation::{Gain, RestBias, Sample, Units};
use serde::{Deserialize, Serialize};

use super::motions::{DAY, SPIN, TUMBLE};
use crate::imu::measure::{Largest, against_f64, tracker};
use crate::imu::motion::Motion;
use crate::imu::quaternion::Quaternion;
use crate::imu::sensor::Sensor;

/// Result of a case: a line of `imu-stiff.csv`.
#[derive(Serialize, Deserialize)]
pub struct StiffCase {
    /// Description of the input and of the measured quantity.
    pub case: String,
    /// Result of other methods; empty if there is none.
    pub other: String,
    /// Result of Glint's method.
    pub glint: String,
    /// Short summary of the outcome.
    pub outcome: String,
}

/// Measures all cases. `part` is the fraction of the full duration of long cases. `count` contains the errors of a day's rotation at one
/// count of the gyroscope; these are needed for the cases of a whole day.
pub fn measure(part: f64, count: Option<Largest>) -> Vec<StiffCase> {
    let mut rows = gains();
    rows.extend(words(part));
    rows.push(rest_cycle());
    rows.extend(uneven());
    rows.push(saturation());
    rows.extend(squares());
    if let Some(count) = count {
        let spin = against_f64(Sensor::ideal(1000.0), SPIN, DAY, false);
        for (name, largest) in [("1 count", count), ("1990 °/s", spin)] {
            rows.push(StiffCase {
                case: format!("{name} about one axis, 24 h at 1 kHz"),
                other: String::new(),
                glint: format!(
                    "{:.1e}° against f64, error of the length {:.1e}",
                    largest.angle, largest.norm
                ),
                outcome: "bounded".into(),
            });
        }
    }
    rows
}

/// Measures the remaining fraction of an error after one step of a first-order filter with the time constant τ. Compares the
/// explicit gain dt/τ with Glint's exact gain 1 − exp(−dt/τ).
fn gains() -> Vec<StiffCase> {
    [1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.0, 1.9, 2.1, 5.0, 10.0]
        .map(|ratio: f64| {
            let step = 10_000;
            let time_constant = (f64::from(step) / ratio).round() as u32;
            let gain = f64::from(Gain::new(time_constant).of(step)) / 2f64.powi(32);
            // The time constant is rounded to microseconds, which changes the ratio slightly.
            let ratio = f64::from(step) / f64::from(time_constant);
            let explicit = 1.0 - ratio;
            let outcome = match ratio {
                x if x > 2.0 => "explicit diverges, exact is monotone",
                x if x > 1.0 => "explicit oscillates, exact is monotone",
                _ => "both are monotone",
            };
            StiffCase {
                case: format!("dt/τ = {ratio:.4}: error left after a step"),
                other: format!("explicit {explicit:.6}"),
                glint: format!(
                    "{:.9}, error {:.1e}",
                    1.0 - gain,
                    (gain + (-ratio).exp_m1()).abs()
                ),
                outcome: outcome.into(),
            }
        })
        .into()
}

/// Estimates a bias of 1 LSB by running means, with accumulators of several word lengths.
fn words(part: f64) -> Vec<StiffCase> {
    [10, 100, 1000]
        .map(|time_constant: u32| {
            let gain = u64::from(Gain::new(time_constant * 1_000_000).of(1_000));
            let steps = (f64::from(5 * time_constant) * 1000.0 * part) as u64;
            let learnt = |bits: u32| {
                let one = 1_i64 << bits;
                let mut mean = 0_i64;
                for _ in 0..steps {
                    mean += (((one - mean) as u64 * gain + (1 << 31)) >> 32) as i64;
                }
                mean as f64 / one as f64
            };
            let exact = 1.0 - (-(steps as f64) * 1e-3 / f64::from(time_constant)).exp();
            let others: Vec<String> = [16, 20, 24, 28]
                .map(|bits| format!("{bits} bits {:.3}", learnt(bits)))
                .into();
            StiffCase {
                case: format!(
                    "bias with τ = {time_constant} s at 1 kHz: learnt part of 1 LSB after {:.0} s, exact {exact:.5}",
                    steps as f64 * 1e-3
                ),
                other: others.join(", "),
                glint: format!("{:.5}", learnt(32)),
                outcome: "32 bits follow, shorter words stall or run ahead".into(),
            }
        })
        .into()
}

/// Measures the motion of the attitude at rest without noise. If the rounding of the filter caused a limit cycle, the attitude would move.
fn rest_cycle() -> StiffCase {
    let mut tracker = tracker(&Sensor::ideal(1000.0), true);
    let mut first: Option<Quaternion> = None;
    let mut moved = 0.0_f64;
    for i in 0..1_000_000_u64 {
        tracker.on_sample(&Sample {
            t_us: i * 1_000,
            accel: [713, -391, 4_011],
            gyro: [0; 3],
        });
        if i >= 500_000 {
            let attitude = Quaternion::from(tracker.attitude());
            moved = moved.max(first.get_or_insert(attitude).angle_to(attitude));
        }
    }
    StiffCase {
        case: "tilted, at rest for 1000 s without noise: motion of the attitude in the second half"
            .into(),
        other: String::new(),
        glint: format!("{moved:.1e}°"),
        outcome: "no limit cycle".into(),
    }
}

/// Integrates samples with uneven spacing and with missing samples: once with their time stamps, and once as if they were evenly spaced.
fn uneven() -> Vec<StiffCase> {
    let even = Sensor::ideal(200.0);
    let error = |sensor: Sensor, stamped: bool| {
        let mut tracker = tracker(&sensor, false);
        let mut end = 0;
        for (i, mut sample) in sensor.samples(TUMBLE, 4_001, 5).enumerate() {
            end = sample.t_us;
            if !stamped {
                sample.t_us = i as u64 * 5_000;
            }
            tracker.on_sample(&sample);
        }
        let truth = TUMBLE.attitude_after(end as f64 * 1e-6, 200.0);
        truth.angle_to(tracker.attitude().into())
    };
    [
        ("even samples", even),
        (
            "jitter of ±30 %",
            Sensor {
                jitter: 0.3,
                ..even
            },
        ),
        ("1 % of samples lost", Sensor { lost: 0.01, ..even }),
        (
            "both",
            Sensor {
                jitter: 0.3,
                lost: 0.01,
                ..even
            },
        ),
    ]
    .map(|(name, sensor)| StiffCase {
        case: format!("tumble of 700 °/s, 20 s at 200 Hz, {name}: error at the end"),
        other: format!("without time stamps {:.2e}°", error(sensor, false)),
        glint: format!("{:.2e}°", error(sensor, true)),
        outcome: "time stamps keep the error small".into(),
    })
    .into()
}

/// Measures the errors of the inclination after a saturation of the gyroscope for 30 ms of a hand motion.
fn saturation() -> StiffCase {
    let sensor = Sensor::real(1000.0);
    let mut tracker = tracker(&sensor, true);
    let mut errors = [0.0; 3];
    for (i, mut sample) in sensor.samples(Motion::Hand, 60_000, 6).enumerate() {
        if (20_000..20_030).contains(&i) {
            sample.gyro[0] = i16::MAX;
        }
        tracker.on_sample(&sample);
        let Some(truth) = Motion::Hand.attitude(sample.t_us as f64 * 1e-6) else {
            continue;
        };
        let error = truth.inclination_to(tracker.attitude().into());
        match i {
            20_029 => errors[0] = error,
            23_030 => errors[1] = error,
            30_030 => errors[2] = error,
            _ => {}
        }
    }
    StiffCase {
        case: "x saturated for 30 ms of a hand motion at 1 kHz: inclination at its end, after 3 s, after 10 s".into(),
        other: String::new(),
        glint: format!("{:.1}°, {:.1}°, {:.2}°", errors[0], errors[1], errors[2]),
        outcome: format!("flagged {} times, yaw of that time lost", tracker.counts().saturated),
    }
}

/// Measures the firmware's bias estimate for square-wave rates. The expected bias is zero, the mean of the waves.
fn squares() -> Vec<StiffCase> {
    [(1500.0, 1.0), (1500.0, 0.1), (5.0, 0.1)]
        .map(|(rate, frequency)| {
            let motion = Motion::Square { rate, frequency };
            let sensor = Sensor {
                bias: [0.0; 3],
                ..Sensor::real(1000.0)
            };
            let mut tracker = tracker(&sensor, true);
            tracker.follow_bias(RestBias::new(Units::MPU_6050, [0; 3]));
            for sample in sensor.samples(motion, 60_000, 7) {
                tracker.on_sample(&sample);
            }
            let learnt = tracker.bias().iter().map(|x| x.abs()).max().unwrap_or(0);
            StiffCase {
                case: format!("square wave of ±{rate} °/s, {frequency} Hz, 60 s: learnt bias"),
                other: String::new(),
                glint: format!("{:.3} LSB", f64::from(learnt) / 256.0),
                outcome: "not learnt".into(),
            }
        })
        .into()
}

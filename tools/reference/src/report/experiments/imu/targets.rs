//! Experiment: attitude errors for which there is a requirement and a goal.

use serde::{Deserialize, Serialize};

use super::motions::{CONING, COUNT, DAY, SPIN, TUMBLE};
use crate::imu::measure::{Largest, against_f64, calibrated, inclination, method_error, yaw_drift};
use crate::imu::method::Method;
use crate::imu::motion::Motion;
use crate::imu::sensor::Sensor;

/// An error with its requirement: a line of `imu.csv`.
#[derive(Serialize, Deserialize)]
pub struct Target {
    /// Description of the measured error.
    pub what: String,
    /// Unit of the error.
    pub unit: String,
    /// Required upper bound of the error.
    pub at_least: f64,
    /// Goal, below the required bound.
    pub aim: f64,
    /// Measured value of the error.
    pub measured: f64,
    /// Best bound met: `aim` (the goal), `at least` (only the requirement), or `missed` (neither).
    pub reached: String,
}

/// Measures the errors during a rotation at one count of the gyroscope, which lasts the fraction `part` of a day. This measurement takes
/// longer than every other measurement.
pub fn one_count(part: f64) -> Largest {
    against_f64(Sensor::ideal(1000.0), COUNT, part * DAY, false)
}

/// Measures all errors that have a requirement, except `count`, which is the result of [`one_count`]. `part` is the fraction of the full
/// duration of long motions.
pub fn measure(part: f64, count: Largest) -> Vec<Target> {
    let mut rows = Vec::new();
    let mut norm = 0.0_f64;
    let mut add = |what: String, unit: &str, [at_least, aim]: [f64; 2], measured: f64| {
        rows.push(Target {
            what,
            unit: unit.to_owned(),
            at_least,
            aim,
            measured,
            reached: if measured <= aim {
                "aim"
            } else if measured <= at_least {
                "at least"
            } else {
                "missed"
            }
            .to_owned(),
        });
    };
    let hour = 3600.0 * part;
    for (name, errors, seconds, limits) in [
        (
            "hand motion",
            against_f64(Sensor::real(1000.0), Motion::Hand, 190.0, false),
            190.0,
            [0.01, 0.001],
        ),
        (
            "tumble of 500 °/s",
            against_f64(Sensor::ideal(1000.0), Motion::Tumble(500.0), hour, false),
            hour,
            [0.05, 0.002],
        ),
        (
            "1990 °/s about one axis",
            against_f64(Sensor::ideal(1000.0), SPIN, hour, false),
            hour,
            [0.2, 0.04],
        ),
        ("1 count about one axis", count, part * DAY, [0.05, 1e-5]),
    ] {
        norm = norm.max(errors.norm);
        let what = format!("firmware against f64 on the same counts: {name}, {seconds} s at 1 kHz");
        add(what, "°", limits, errors.angle);
    }
    let hand = against_f64(Sensor::real(200.0), Motion::Hand, 190.0, true);
    norm = norm.max(hand.norm);
    add(
        "firmware with the accelerometer against f64 on the same counts: hand motion, 190 s at 200 Hz".into(),
        "°",
        [0.01, 0.001],
        hand.angle,
    );
    add(
        "largest error of the quaternion's length in the rows above".into(),
        "",
        [1e-8, 2e-9],
        norm,
    );
    for (name, motion, limits) in [
        ("tumble of 700 °/s", TUMBLE, [0.1, 0.01]),
        ("coning of 5° at 10 Hz", CONING, [0.1, 0.05]),
    ] {
        let error = method_error(Method::Cubic, motion, 20.0, 200.0);
        add(
            format!("method in f64 against the truth: {name}, 20 s at 200 Hz"),
            "°",
            limits,
            error,
        );
    }
    for (name, motion) in [
        ("hand motion, mostly sideways", Motion::Hand),
        ("hand motion, mostly up and down", Motion::Nod),
        ("walk", Motion::Walk),
    ] {
        let errors = inclination(Sensor::real(1000.0), motion, 60.0);
        add(
            format!("inclination, RMS: {name}, 60 s at 1 kHz"),
            "°",
            [2.0, 1.0],
            errors.rms(),
        );
    }
    if let Ok(found) = calibrated(Sensor::real(1000.0), Motion::Rest) {
        for (name, follow) in [("kept", false), ("tracked", true)] {
            let drift = yaw_drift(Sensor::real(1000.0), &found, part, follow);
            add(
                format!("yaw drift at rest after calibration, {part} h, bias {name}"),
                "°/h",
                [10.0, 10.0],
                drift.abs(),
            );
        }
    }
    rows
}

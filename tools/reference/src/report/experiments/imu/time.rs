//! Experiment: how the errors of an attitude that is computed from the gyroscope alone grow over time.

use serde::{Deserialize, Serialize};

use crate::imu::filter::{Estimator, Filter};
use crate::imu::measure::tracker;
use crate::imu::method::Method;
use crate::imu::motion::Motion;
use crate::imu::quaternion::Quaternion;
use crate::imu::sensor::Sensor;

/// Angle random walk of a gyroscope with noise of 0.1 °/s at 1 kHz: the integrated noise has a standard deviation of `WALK`·√t
/// degrees after t seconds.
const WALK: f64 = 0.1 * 0.031_622_776_601_683_79;

/// Errors of the attitude at a time in the motion: a line of `imu-time.csv`. Errors are in degrees.
#[derive(Serialize, Deserialize)]
pub struct ErrorsAtTime {
    /// Time since the start of the motion, in seconds.
    pub seconds: f64,
    /// Error of the firmware against the same method in f64, on the same noise-free samples.
    pub numeric: f64,
    /// Error of the firmware against the true attitude, on noise-free samples.
    pub counts: f64,
    /// Error of the firmware against the true attitude, on noisy samples.
    pub sensor: f64,
    /// Standard deviation of the error that the sensor's integrated noise alone causes.
    pub floor: f64,
}

/// Measures the errors during a hand motion of this duration. Each time of measurement is about 5 % later than the previous time.
pub fn measure(seconds: f64) -> Vec<ErrorsAtTime> {
    let motion = Motion::Hand;
    let ideal = Sensor::ideal(1000.0);
    let real = Sensor::real(1000.0);
    let count = (seconds * 1000.0) as u64 + 1;
    let start = motion.attitude(0.0).unwrap_or(Quaternion::IDENTITY);
    let mut trackers = [tracker(&ideal, false), tracker(&real, false)];
    let mut reference =
        Estimator::new(Method::Cubic, Filter::None, ideal.gyro_lsb, ideal.accel_lsb);
    let mut moments = Vec::new();
    let mut due = 0.1;
    for (exact, noisy) in ideal
        .samples(motion, count, 8)
        .zip(real.samples(motion, count, 8))
    {
        trackers[0].on_sample(&exact);
        trackers[1].on_sample(&noisy);
        reference.on_sample(&exact);
        let seconds = exact.t_us as f64 * 1e-6;
        if seconds < due {
            continue;
        }
        due *= 1.05;
        let Some(truth) = motion.attitude(seconds) else {
            continue;
        };
        let truth = start.inverse().times(truth);
        let attitudes = trackers
            .each_ref()
            .map(|tracker| Quaternion::from(tracker.attitude()));
        moments.push(ErrorsAtTime {
            seconds,
            numeric: attitudes[0].angle_to(reference.attitude()),
            counts: attitudes[0].angle_to(truth),
            sensor: attitudes[1].angle_to(truth),
            floor: WALK * seconds.sqrt(),
        });
    }
    moments
}

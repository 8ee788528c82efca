//! Growth of the attitude's errors over time.

use serde::{Deserialize, Serialize};

use crate::imu::filter::{Estimator, Filter};
use crate::imu::measure::tracker;
use crate::imu::method::Method;
use crate::imu::motion::Motion;
use crate::imu::quaternion::Quaternion;
use crate::imu::sensor::Sensor;

/// Angle random walk, in degrees per root of a second, of a gyroscope with noise of 0.1 °/s at 1 kHz.
const WALK: f64 = 0.1 * 0.031_622_776_601_683_79;

/// Errors at a point of time: a line of `imu-time.csv`. Errors are in degrees.
#[derive(Serialize, Deserialize)]
pub struct ErrorsAtTime {
    /// Time since the start, in seconds.
    pub seconds: f64,
    /// Error of the firmware against f64 on the same counts.
    pub numeric: f64,
    /// Error of the firmware against the truth, on counts without noise.
    pub counts: f64,
    /// Error of the firmware against the truth, on counts with noise.
    pub sensor: f64,
    /// Standard deviation of the error that the integrated noise alone causes.
    pub floor: f64,
}

/// Measures a hand motion of this duration, with the gyroscope alone.
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
        let seconds = f64::from(exact.t_us) * 1e-6;
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

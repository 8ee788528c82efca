//! Measurements of attitude errors, shared by the tests and the report.

use glint_core::calibration::{Calibration, Progress, Report, SAMPLES, SampleError};
use glint_core::fixed::Q32_32;
use glint_core::orientation::{RestBias, Scale, TIME_CONSTANT, Tilt, Tracker, Units};

use super::filter::{Estimator, Filter};
use super::method::{Integrator, Method};
use super::motion::Motion;
use super::quaternion::Quaternion;
use super::sensor::Sensor;
use crate::errors::Errors;

/// Time constant of the firmware's tilt correction, in seconds.
pub const TAU: f64 = TIME_CONSTANT as f64 * 1e-6;

/// Makes the firmware's attitude tracker for a sensor, with the sensor's true bias rounded to 1/256 LSB. `tilt` selects whether
/// the tracker uses the accelerometer.
///
/// # Panics
/// When the firmware does not support the sensor's units.
pub fn tracker(sensor: &Sensor, tilt: bool) -> Tracker {
    let scale = Scale::new(Q32_32::from_num(sensor.gyro_lsb)).expect("units of the firmware");
    let tilt = tilt.then(|| Tilt::new(sensor.accel_lsb as u32, TIME_CONSTANT));
    let mut tracker = Tracker::new(scale, tilt);
    tracker.set_bias(bias(sensor).map(|bias| bias as i32));
    tracker
}

/// Returns the sensor's bias in units of 1/256 LSB.
fn bias(sensor: &Sensor) -> [f64; 3] {
    sensor
        .bias
        .map(|bias| (bias * sensor.gyro_lsb * 256.0).round())
}

/// Largest errors of the firmware's attitude during a motion.
#[derive(Clone, Copy, Debug, Default)]
pub struct Largest {
    /// Angle between the firmware's attitude and the attitude that the same method in f64 computes from the same samples, in degrees.
    pub angle: f64,
    /// Deviation of the length of the firmware's quaternion from 1.
    pub norm: f64,
}

/// Compares the firmware's attitude with the same method in f64, on the same samples of a motion of `seconds` seconds. `tilt`
/// selects whether both use the accelerometer.
pub fn against_f64(sensor: Sensor, motion: Motion, seconds: f64, tilt: bool) -> Largest {
    let mut tracker = tracker(&sensor, tilt);
    let filter = if tilt {
        Filter::Tilt(TAU)
    } else {
        Filter::None
    };
    let mut reference = Estimator::new(Method::Cubic, filter, sensor.gyro_lsb, sensor.accel_lsb);
    reference.set_bias(bias(&sensor).map(|bias| bias / 256.0));
    let count = (seconds * sensor.rate) as u64 + 1;
    let mut largest = Largest::default();
    for sample in sensor.samples(motion, count, 1) {
        tracker.on_sample(&sample);
        reference.on_sample(&sample);
        let attitude = Quaternion::from(tracker.attitude());
        largest.angle = largest.angle.max(attitude.angle_to(reference.attitude()));
        largest.norm = largest.norm.max((attitude.norm() - 1.0).abs());
    }
    largest
}

/// Computes the error in degrees of a method's attitude after `seconds` seconds of a motion. The
/// method receives the exact rate of the motion, without noise or rounding, `rate` times a second.
pub fn method_error(method: Method, motion: Motion, seconds: f64, rate: f64) -> f64 {
    let start = motion.attitude(0.0).unwrap_or(Quaternion::IDENTITY);
    let mut integrator = Integrator::new(method, start, motion.rate(0.0));
    let step = 1.0 / rate;
    let count = (seconds * rate).round() as u64;
    for i in 1..=count {
        integrator.advance(motion.rate(i as f64 * step), step);
    }
    let truth = motion.attitude_after(seconds, rate);
    integrator.attitude().angle_to(truth)
}

/// Assumed residual error of the gyroscope's bias after a calibration and a change of temperature, in °/s along x, y and z.
pub const LEFT_BIAS: [f64; 3] = [0.02, -0.02, 0.02];
/// Time from which errors of the inclination are counted, in seconds.
const SETTLED: f64 = 10.0;

/// Computes the errors of the firmware's inclination in degrees, if the bias that the firmware assumes is wrong by [`LEFT_BIAS`].
///
/// # Panics
/// When the motion has no attitude in closed form.
pub fn inclination(sensor: Sensor, motion: Motion, seconds: f64) -> Errors {
    let mut tracker = tracker(&sensor, true);
    let left = LEFT_BIAS.map(|bias| (bias * sensor.gyro_lsb * 256.0).round() as i32);
    let known = tracker.bias();
    tracker.set_bias([0, 1, 2].map(|i| known[i] - left[i]));
    let mut errors = Errors::default();
    for sample in sensor.samples(motion, (seconds * sensor.rate) as u64, 2) {
        tracker.on_sample(&sample);
        let t = sample.t_us as f64 * 1e-6;
        if t >= SETTLED {
            let truth = motion.attitude(t).expect("in closed form");
            errors.add(truth.inclination_to(tracker.attitude().into()));
        }
    }
    errors
}

/// Computes the errors of an f64 filter's inclination in degrees, if the bias that the filter assumes is wrong by [`LEFT_BIAS`].
///
/// # Panics
/// When the motion has no attitude in closed form.
pub fn filter_inclination(filter: Filter, sensor: Sensor, motion: Motion, seconds: f64) -> Errors {
    let mut estimator = Estimator::new(Method::Cubic, filter, sensor.gyro_lsb, sensor.accel_lsb);
    if let Some(start) = motion.attitude(0.0) {
        estimator.begin_at(start);
    }
    estimator.set_bias([0, 1, 2].map(|i| (sensor.bias[i] - LEFT_BIAS[i]) * sensor.gyro_lsb));
    let mut errors = Errors::default();
    for sample in sensor.samples(motion, (seconds * sensor.rate) as u64, 2) {
        estimator.on_sample(&sample);
        let t = sample.t_us as f64 * 1e-6;
        if t >= SETTLED {
            let truth = motion.attitude(t).expect("in closed form");
            errors.add(truth.inclination_to(estimator.attitude()));
        }
    }
    errors
}

/// Runs the firmware's calibration on samples of a motion and returns its report.
///
/// # Errors
/// When the firmware's calibration refuses a sample.
///
/// # Panics
/// When the samples end before the calibration is complete.
pub fn calibrated(sensor: Sensor, motion: Motion) -> Result<Report, SampleError> {
    let mut calibration = Calibration::new(Units::MPU_6050, SAMPLES);
    for sample in sensor.samples(motion, u64::from(SAMPLES) + 1, 3) {
        if let Progress::Done(report) = calibration.on_sample(&sample)? {
            return Ok(report);
        }
    }
    unreachable!("a calibration ends after the requested number of samples");
}

/// Computes the drift of the firmware's yaw at rest, in °/h, after the calibration in `report`. If `follow` is set, the firmware
/// adapts its bias while the sensor rests; otherwise it keeps the calibrated bias.
pub fn yaw_drift(sensor: Sensor, report: &Report, hours: f64, follow: bool) -> f64 {
    let mut tracker = tracker(&sensor, true);
    tracker.set_bias(report.bias);
    if follow {
        tracker.follow_bias(RestBias::new(Units::MPU_6050, report.bias));
    }
    for sample in sensor.samples(Motion::Rest, (hours * 3600.0 * sensor.rate) as u64, 4) {
        tracker.on_sample(&sample);
    }
    Quaternion::from(tracker.attitude()).angles()[0].to_degrees() / hours
}

//! Attitude filters in f64, which integrate the gyroscope's rates and correct the tilt by the accelerometer.

use std::f64::consts::{SQRT_2, TAU};

use glint_core::orientation::{DOUBTFUL, FRESH, LONGEST_STEP, Sample};

use super::method::{Integrator, Method};
use super::quaternion::Quaternion;
use crate::camera::{Vector, cross, dot};

/// Method of correcting the attitude by the accelerometer. Times are in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// The accelerometer is ignored.
    None,
    /// Complementary filter with this time constant τ: after each step, pitch and roll move towards the accelerometer's pitch and
    /// roll by the fraction 1 − exp(−dt/τ) of the difference.
    Complementary(f64),
    /// Mahony's filter: the deviation of the accelerometer's normalised reading from the attitude's up direction corrects the
    /// gyroscope's rate (proportional term) and bias (integral term).
    Mahony {
        /// Proportional gain in 1/s.
        proportional: f64,
        /// Integral gain in 1/s².
        integral: f64,
    },
    /// The filter VQF of Laidig and Seel without its bias estimation, with this time constant: the gyroscope's attitude rotates
    /// the accelerometer's readings to world axes, where a second-order low pass filters them. Then the attitude is rotated to
    /// make the filtered reading point upwards.
    LowPass(f64),
    /// The firmware's filter (`glint_core::orientation::Tilt`), with this time constant.
    Tilt(f64),
    /// The firmware's filter, changed to ignore accelerometer readings whose magnitude is outside a range.
    Gated {
        /// Time constant in seconds.
        tau: f64,
        /// Lowest and highest magnitude of a used reading, in g.
        range: [f64; 2],
    },
}

impl Filter {
    /// The filter's name in tables.
    pub fn name(self) -> String {
        match self {
            Self::None => "none".into(),
            Self::Complementary(tau) => format!("complementary, {tau} s"),
            Self::Mahony {
                proportional,
                integral,
            } => format!("Mahony, {proportional}, {integral}"),
            Self::LowPass(tau) => format!("low pass of second order, {tau} s"),
            Self::Tilt(tau) => format!("tilt, {tau} s"),
            Self::Gated {
                tau,
                range: [low, high],
            } => format!("tilt, {tau} s, {low} to {high} g"),
        }
    }
}

/// Attitude estimator: an integration method and a filter for samples of a gyroscope and an accelerometer.
#[derive(Clone, Debug)]
pub struct Estimator {
    filter: Filter,
    gyro_lsb: f64,
    accel_lsb: f64,
    /// Assumed bias of the gyroscope, which is subtracted from its rates, in rad/s.
    bias: Vector,
    integrator: Integrator,
    last: Option<u64>,
    /// Attitude at the first sample, for a filter that ignores the accelerometer.
    start: Quaternion,
    /// Time constant in use, in seconds. The time constant grows from a small value to the time constant of `filter`, so that the tilt
    /// settles fast.
    age: f64,
    /// Correction from the accelerometer's last reading, applied in the next step: half the rotation angle about each body axis,
    /// in radians.
    correction: Vector,
    /// The low passes of [`Filter::LowPass`], one per world axis.
    low_pass: [Butterworth; 3],
    /// For [`Filter::LowPass`], the rotation from the drifting world axes of the gyroscope's attitude to the corrected world axes.
    upright: Quaternion,
}

impl Estimator {
    /// Creates an estimator without samples. `gyro_lsb` is in LSB per °/s, `accel_lsb` in LSB per g.
    pub fn new(method: Method, filter: Filter, gyro_lsb: f64, accel_lsb: f64) -> Self {
        Self {
            filter,
            gyro_lsb,
            accel_lsb,
            bias: [0.0; 3],
            integrator: Integrator::new(method, Quaternion::IDENTITY, [0.0; 3]),
            last: None,
            start: Quaternion::IDENTITY,
            age: f64::from(FRESH) * 1e-6,
            correction: [0.0; 3],
            low_pass: [Butterworth::default(); 3],
            upright: Quaternion::IDENTITY,
        }
    }

    /// Sets the gyroscope's bias, in LSB.
    pub fn set_bias(&mut self, lsb: Vector) {
        self.bias = lsb.map(|x| (x / self.gyro_lsb).to_radians());
    }

    /// Sets the attitude at the first sample, for a filter that ignores the accelerometer. The default is the identity.
    pub fn begin_at(&mut self, attitude: Quaternion) {
        self.start = attitude;
    }

    /// Returns the attitude at the last sample.
    pub fn attitude(&self) -> Quaternion {
        self.upright.times(self.integrator.attitude())
    }

    /// Processes a sample, if it is later than the last sample.
    pub fn on_sample(&mut self, sample: &Sample) {
        let rate = [0, 1, 2]
            .map(|i| (f64::from(sample.gyro[i]) / self.gyro_lsb).to_radians() - self.bias[i]);
        let force = sample.accel.map(|x| f64::from(x) / self.accel_lsb);
        let Some(last) = self.last else {
            self.last = Some(sample.t_us);
            let attitude = match self.filter {
                Filter::None => self.start,
                _ => {
                    let [x, y, z] = force;
                    Quaternion::of_angles([0.0, (-x).atan2(y.hypot(z)), y.atan2(z)])
                }
            };
            self.integrator = Integrator::new(self.integrator.method(), attitude, rate);
            return;
        };
        let step = sample.t_us.saturating_sub(last);
        if step == 0 {
            return;
        }
        self.last = Some(sample.t_us);
        if step > u64::from(LONGEST_STEP) {
            self.integrator.restart(rate);
            self.age = self.age.min(f64::from(DOUBTFUL) * 1e-6);
            return;
        }
        self.advance(rate, force, step as f64 * 1e-6);
    }

    fn advance(&mut self, rate: Vector, force: Vector, step: f64) {
        let correction = std::mem::take(&mut self.correction);
        self.integrator.advance_corrected(rate, step, correction);
        // The accelerometer is read at the end of this step, so its reading is compared with the attitude after the step.
        let up = self.integrator.attitude().up();
        let strength = dot(force, force).sqrt();
        let turn = |gain: f64| cross(force, up).map(|x| x * gain / 2.0);
        match self.filter {
            Filter::None => {}
            Filter::Tilt(tau) if strength <= 3.0 => {
                self.correction = turn(self.aged_gain(tau, step))
            }
            Filter::Gated { tau, range } if range[0] <= strength && strength <= range[1] => {
                self.correction = turn(self.aged_gain(tau, step));
            }
            // A reading of a magnitude out of range does not correct the attitude.
            Filter::Tilt(_) | Filter::Gated { .. } => {}
            Filter::Mahony {
                proportional,
                integral,
            } => {
                let error = cross(force, up).map(|x| x / strength.max(1e-9));
                for (bias, error) in self.bias.iter_mut().zip(error) {
                    *bias -= integral * error * step;
                }
                self.correction = error.map(|x| x * proportional * step / 2.0);
            }
            Filter::Complementary(tau) => {
                let gain = 1.0 - (-step / tau).exp();
                let [x, y, z] = force;
                let [yaw, pitch, roll] = self.integrator.attitude().angles();
                let mixed = |angle: f64, read: f64| {
                    // The difference is wrapped to ±π.
                    let difference = (read - angle + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
                    angle + gain * difference
                };
                let pitch = mixed(pitch, (-x).atan2(y.hypot(z)));
                let roll = mixed(roll, y.atan2(z));
                self.integrator
                    .set_attitude(Quaternion::of_angles([yaw, pitch, roll]));
            }
            Filter::LowPass(tau) => {
                let world = self.integrator.attitude().rotate(force);
                let mean = [0, 1, 2].map(|i| self.low_pass[i].next(world[i], step, tau));
                let [x, y, z] = self.upright.rotate(mean);
                // The shortest rotation that takes the mean reading to the z axis.
                let length = (x * x + y * y + z * z).sqrt();
                if length > 1e-6 {
                    let half = Quaternion([length + z, y, -x, 0.0]);
                    if half.norm() > 1e-9 {
                        self.upright = half.normalised().times(self.upright).normalised();
                    }
                }
            }
        }
    }

    /// Returns the fraction of the tilt error that a step of `step` seconds corrects, for the time constant `tau`. For about the
    /// first `tau` seconds, the time constant in use is shorter: the filter is nearly a running mean.
    fn aged_gain(&mut self, tau: f64, step: f64) -> f64 {
        if self.age < tau {
            self.age = (self.age + step).min(tau);
        }
        1.0 - (-step / self.age).exp()
    }
}

/// A second-order Butterworth low pass by the bilinear transform. During the first τ seconds it returns the mean of all inputs so far.
#[derive(Clone, Copy, Debug, Default)]
struct Butterworth {
    age: f64,
    sum: f64,
    count: f64,
    state: [f64; 2],
}

impl Butterworth {
    fn next(&mut self, x: f64, step: f64, tau: f64) -> f64 {
        // tan(π·f·dt) for VQF's cut-off frequency f = √2/(2π·τ); `TAU` is 2π here.
        let c = (TAU / 2.0 * SQRT_2 / (TAU * tau) * step).tan();
        let d = c * c + SQRT_2 * c + 1.0;
        let b0 = c * c / d;
        let a = [2.0 * (c * c - 1.0) / d, (1.0 - SQRT_2 * c + c * c) / d];
        if self.age < tau {
            self.age += step;
            self.sum += x;
            self.count += 1.0;
            let mean = self.sum / self.count;
            // The low pass's steady state for a constant input of `mean`.
            self.state = [(1.0 - b0) * mean, (b0 - a[1]) * mean];
            return mean;
        }
        let y = b0 * x + self.state[0];
        self.state = [2.0 * b0 * x - a[0] * y + self.state[1], b0 * x - a[1] * y];
        y
    }
}

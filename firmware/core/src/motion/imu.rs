//! The motion sensor: its samples, calibration and attitude, and the steering of the camera.
//!
//! [`Imu`] is the [`Sink`] of an MPU-6050's [`Stream`](crate::mpu6050::Stream). Without samples of the sensor, the attitude stays
//! constant.

use core::fmt;

use crate::calibration::{self, Calibration, Progress, Report};
use crate::camera::{View, ViewError};
use crate::choice::choices;
use crate::fixed::Q32_32;
use crate::mpu6050::{self, Error, Identity, Measurement, Sink};
use crate::orientation::{
    Counts, Quaternion, RestBias, Sample, Scale, TIME_CONSTANT, Tilt, Tracker, Units,
};
use crate::steering::{self, Mounting, Steering};

/// Mode in which the sensor steers the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follow {
    /// The camera turns in place, in the direction of the sensor.
    Look,
    /// The camera orbits the origin and looks at it.
    Orbit,
}

choices!(Follow {
    Look: "look",
    Orbit: "orbit"
});

/// Reason why a calibration failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationError<E> {
    /// The sensor moved or is faulty.
    Samples(calibration::SampleError),
    /// The sensor failed, so no samples arrived.
    Failed(Error<E>),
    /// No sensor was found since the board started.
    Absent,
}

impl<E: fmt::Display> fmt::Display for CalibrationError<E> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Samples(error) => error.fmt(f),
            Self::Failed(error) => error.fmt(f),
            Self::Absent => f.write_str("no sensor was found: expected an MPU-6050 on the I2C bus"),
        }
    }
}

/// State of the last or current calibration. `Going` contains the calibration in progress and its number of samples so far.
#[derive(Clone, Copy, Debug)]
enum Calibrating<E> {
    Never,
    Going(Calibration, u32),
    Ended(Result<Report, CalibrationError<E>>),
}

/// Samples, attitude and calibration of a sensor, and the steering of the camera. `E` is the error of the sensor's bus.
#[derive(Clone, Copy, Debug)]
pub struct Imu<E> {
    identity: Option<Identity>,
    /// The error that stopped the samples; `None` while samples arrive.
    error: Option<Error<E>>,
    errors: u32,
    samples: u32,
    latest: Option<Sample>,
    temperature: i16,
    tracker: Tracker,
    calibrating: Calibrating<E>,
    mounting: Mounting,
    steering: Steering,
    follow: Option<Follow>,
    /// Whether the camera may have changed since the last call of `view`.
    moved: bool,
}

impl<E: Copy> Default for Imu<E> {
    fn default() -> Self {
        Self {
            identity: None,
            error: None,
            errors: 0,
            samples: 0,
            latest: None,
            temperature: 0,
            tracker: Tracker::new(
                Scale::MPU_6050,
                Some(Tilt::new(Units::MPU_6050.per_g, TIME_CONSTANT)),
            ),
            calibrating: Calibrating::Never,
            mounting: Mounting::default(),
            steering: Steering::default(),
            follow: None,
            moved: false,
        }
    }
}

impl<E: Copy> Imu<E> {
    /// The chip that was found last; `None` if none was found yet.
    pub const fn identity(&self) -> Option<Identity> {
        self.identity
    }

    /// The error that stopped the samples; `None` while samples arrive.
    pub const fn error(&self) -> Option<Error<E>> {
        self.error
    }

    /// Number of errors since the start; it saturates.
    pub const fn errors(&self) -> u32 {
        self.errors
    }

    /// Whether samples arrive.
    pub const fn is_running(&self) -> bool {
        self.identity.is_some() && self.error.is_none()
    }

    /// Number of samples since the start, modulo 2^32.
    pub const fn samples(&self) -> u32 {
        self.samples
    }

    /// The newest sample; `None` before the first.
    pub const fn latest(&self) -> Option<&Sample> {
        self.latest.as_ref()
    }

    /// The chip's temperature in 1/100 °C; `None` before the first sample.
    pub fn temperature(&self) -> Option<i32> {
        let identity = self.identity.filter(|_| self.latest.is_some())?;
        Some(identity.temperature(self.temperature))
    }

    /// The sensor's attitude.
    pub fn attitude(&self) -> Quaternion {
        self.tracker.attitude()
    }

    /// Numbers of samples by their effect on the attitude.
    pub const fn counts(&self) -> Counts {
        self.tracker.counts()
    }

    /// Bias of the gyroscope in °/s, rounded towards zero to 2^−32.
    pub fn bias(&self) -> [Q32_32; 3] {
        self.tracker
            .bias()
            .map(|bias| mpu6050::degrees_per_second(bias.into()))
    }

    /// Starts a calibration with this number of samples. A calibration in progress is cancelled.
    pub fn calibrate(&mut self, samples: u32) {
        self.calibrating = match self.error {
            Some(error) => Calibrating::Ended(Err(CalibrationError::Failed(error))),
            None if self.identity.is_none() => Calibrating::Ended(Err(CalibrationError::Absent)),
            None => Calibrating::Going(Calibration::new(Units::MPU_6050, samples), 0),
        };
    }

    /// Number of samples that the current calibration has taken; `None` without a calibration in progress.
    pub const fn calibrated_samples(&self) -> Option<u32> {
        match self.calibrating {
            Calibrating::Going(_, samples) => Some(samples),
            Calibrating::Never | Calibrating::Ended(_) => None,
        }
    }

    /// Progress of the current calibration in eighths, 0 to 7; `None` without a calibration in progress.
    pub const fn calibrated_eighths(&self) -> Option<u32> {
        match &self.calibrating {
            // At most 2^16 samples are wanted, and fewer are taken.
            Calibrating::Going(calibration, samples) => Some(8 * *samples / calibration.wanted()),
            Calibrating::Never | Calibrating::Ended(_) => None,
        }
    }

    /// Result of the last calibration; `None` before the end of a first calibration, and during a calibration.
    pub const fn calibration(&self) -> Option<Result<Report, CalibrationError<E>>> {
        match self.calibrating {
            Calibrating::Ended(result) => Some(result),
            Calibrating::Never | Calibrating::Going(..) => None,
        }
    }

    /// Mode in which the sensor steers the camera; `None` without steering.
    pub const fn follow(&self) -> Option<Follow> {
        self.follow
    }

    /// Sets the mode in which the sensor steers the camera; `None` ends the steering.
    pub const fn set_follow(&mut self, follow: Option<Follow>) {
        self.follow = follow;
        self.moved = true;
    }

    /// The mounting: which directions of the sensor point into the scene and up on the screen.
    pub const fn mounting(&self) -> Mounting {
        self.mounting
    }

    /// Sets the mounting: which directions of the sensor point into the scene and up on the screen.
    pub const fn set_mounting(&mut self, mounting: Mounting) {
        self.mounting = mounting;
        self.moved = true;
    }

    /// Sensitivity of the steering: the ratio of the camera's turns to the sensor's turns, in units of 1/256.
    pub const fn sensitivity(&self) -> u16 {
        self.steering.sensitivity()
    }

    /// Sets the sensitivity of the steering in units of 1/256, limited to the range [`SENSITIVITY`](steering::SENSITIVITY).
    pub fn set_sensitivity(&mut self, sensitivity: u16) {
        self.steering.set_sensitivity(sensitivity);
    }

    /// Turns the camera about the vertical axis to the heading 0. From then on the sensor's current attitude corresponds to this
    /// heading.
    pub fn recentre(&mut self) {
        self.steering.recentre();
        self.moved = true;
    }

    /// Passes a sample to the calibration in progress. A separate function, because its code is long and rarely runs.
    #[cold]
    #[inline(never)]
    fn continue_calibration(&mut self, sample: &Sample) {
        let Calibrating::Going(calibration, count) = &mut self.calibrating else {
            return;
        };
        match calibration.on_sample(sample) {
            Ok(Progress::Going(samples)) => *count = samples,
            Ok(Progress::Done(report)) => {
                let resting = RestBias::new(Units::MPU_6050, report.bias);
                self.tracker.follow_bias(resting);
                self.calibrating = Calibrating::Ended(Ok(report));
            }
            Err(error) => {
                self.calibrating = Calibrating::Ended(Err(CalibrationError::Samples(error)))
            }
        }
    }

    /// Computes the steered camera: at `eye` for [`Follow::Look`], at the distance `radius` from the origin for
    /// [`Follow::Orbit`]. `None` before the first sample, if the camera is unchanged since the last call, or if the sensor does
    /// not steer the camera.
    ///
    /// # Errors
    /// Eye or radius is out of range.
    pub fn view(&mut self, eye: [Q32_32; 3], radius: Q32_32) -> Option<Result<View, ViewError>> {
        let follow = self
            .follow
            .filter(|_| self.moved && self.latest.is_some())?;
        self.moved = false;
        let attitude = self.steering.follow(self.tracker.attitude());
        Some(match follow {
            Follow::Look => steering::free_look(eye, attitude, self.mounting),
            Follow::Orbit => steering::orbit(radius, attitude, self.mounting),
        })
    }
}

impl<E: Copy> Sink<E> for Imu<E> {
    fn on_start(&mut self, identity: Identity) {
        self.identity = Some(identity);
        self.error = None;
    }

    fn on_sample(&mut self, time: u64, measurement: &Measurement) {
        let sample = Sample {
            t_us: time,
            accel: measurement.accel,
            gyro: measurement.gyro,
        };
        self.samples = self.samples.wrapping_add(1);
        self.temperature = measurement.temperature;
        self.latest = Some(sample);
        self.tracker.on_sample(&sample);
        self.moved = true;
        if let Calibrating::Going(..) = self.calibrating {
            self.continue_calibration(&sample);
        }
    }

    fn on_error(&mut self, error: Error<E>) {
        self.error = Some(error);
        self.errors = self.errors.saturating_add(1);
        if let Calibrating::Going(..) = self.calibrating {
            self.calibrating = Calibrating::Ended(Err(CalibrationError::Failed(error)));
        }
    }
}

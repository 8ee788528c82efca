//! The bias of a gyroscope: measured by a calibration at rest, and tracked later whenever the sensor rests.
//!
//! [`Calibration`] takes the mean of many samples and fails if the sensor moved. Afterwards
//! [`RestBias`](crate::orientation::RestBias) corrects the bias slowly, only while the sensor is at rest.

use core::fmt;

use crate::fixed::Q32_32;
use crate::orientation::{Sample, Units};

/// Default number of samples of a calibration.
pub const SAMPLES: u32 = 8_192;
/// Smallest and largest accepted number of samples of a calibration.
pub const MOST_SAMPLES: [u32; 2] = [64, 65_536];

/// Largest accepted difference between the rates of a sample and of the first sample, in °/s: ten times the sensor's noise. Even
/// a sensor in a still hand exceeds this limit.
const MOST_RATE: u32 = 2;
/// Largest accepted difference between the mean rates of the first and the second half of the samples, in 1/8 °/s.
const MOST_CHANGE: u32 = 1;
/// Largest accepted bias, in °/s: twice the data sheet's ±20 °/s at 25 °C, because the bias also changes with temperature.
const MOST_BIAS: u32 = 40;
/// Largest accepted difference between the forces of a sample and of the first sample along an axis, in 1/8 g.
const MOST_FORCE: u32 = 1;

/// Result of a calibration of the gyroscope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Report {
    /// Number of samples.
    pub samples: u32,
    /// The bias: the mean rate about each axis in 1/256 LSB, rounded to nearest.
    pub bias: [i32; 3],
    /// Standard deviation of the samples' rate about each axis in 1/256 LSB, rounded down.
    pub deviation: [u32; 3],
    /// Standard error of the mean rate about each axis in 2^−16 LSB, rounded down. The formula assumes white noise.
    pub error: [u32; 3],
}

impl Report {
    /// Computes the drift of the angle about each axis, in °/h, that follows from [`Report::error`]. Slow changes of the bias
    /// itself add 5 to 10 °/h.
    pub fn drift(&self, units: Units) -> [Q32_32; 3] {
        self.error.map(|error| units.per_hour(error))
    }
}

/// Reason why a calibration rejects its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleError {
    /// The rate of a sample differs too much from the rate of the first sample.
    Turned {
        /// Number of the sample, from 0.
        sample: u32,
        /// The axis, 0 for x.
        axis: usize,
        /// The difference in LSB.
        by: u32,
        /// Largest accepted value in LSB.
        most: u32,
    },
    /// The force of a sample differs too much from the force of the first sample.
    Pushed {
        /// Number of the sample, from 0.
        sample: u32,
        /// The axis, 0 for x.
        axis: usize,
        /// The difference in LSB.
        by: u32,
        /// Largest accepted value in LSB.
        most: u32,
    },
    /// The mean rates of the first and the second half of the samples differ too much.
    Changed {
        /// The axis, 0 for x.
        axis: usize,
        /// The difference in 1/256 LSB.
        by: u32,
        /// The accepted maximum in 1/256 LSB.
        most: u32,
    },
    /// The mean rate is too large: the sensor turns steadily, or its bias exceeds the data sheet.
    TooLarge {
        /// The axis, 0 for x.
        axis: usize,
        /// The mean rate in LSB, rounded away from zero, so that it is beyond `most`.
        mean: i32,
        /// Largest accepted value in LSB.
        most: u32,
    },
    /// All samples have the same rates. A working sensor has noise, so this sensor is faulty.
    Frozen,
}

/// Returns the name of the axis with this number.
const fn axis_name(axis: usize) -> &'static str {
    match axis {
        0 => "x",
        1 => "y",
        _ => "z",
    }
}

impl fmt::Display for SampleError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Self::Turned {
                sample,
                axis,
                by,
                most,
            } => write!(
                f,
                "gyroscope {} of sample {sample} is {by} LSB from the first: expected at most {most}, keep it still",
                axis_name(axis)
            ),
            Self::Pushed {
                sample,
                axis,
                by,
                most,
            } => write!(
                f,
                "accelerometer {} of sample {sample} is {by} LSB from the first: expected at most {most}, keep it still",
                axis_name(axis)
            ),
            Self::Changed { axis, by, most } => write!(
                f,
                "gyroscope {}: the mean changed by {by}/256 LSB from the first half to the second: expected at most {most}/256, keep it still",
                axis_name(axis)
            ),
            Self::TooLarge { axis, mean, most } => write!(
                f,
                "gyroscope {}: the mean is {mean} LSB, rounded away from 0: expected within ±{most}, the sensor turns or is broken",
                axis_name(axis)
            ),
            Self::Frozen => f.write_str(
                "gyroscope: all samples are equal: expected noise, the sensor does not measure",
            ),
        }
    }
}

impl core::error::Error for SampleError {}

/// A calibration in progress.
#[derive(Clone, Copy, Debug)]
pub struct Calibration {
    units: Units,
    wanted: u32,
    count: u32,
    first: Sample,
    last_us: u64,
    /// Sums over all samples, for each axis: the gyroscope's counts (at most 2^31 in magnitude) and their squares (at most 2^46).
    sum: [i64; 3],
    squares: [u64; 3],
    /// Sums of the gyroscope's counts over the first half of the samples, for each axis.
    half: [i64; 3],
}

/// Progress of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The calibration is in progress and has taken this number of samples.
    Going(u32),
    /// The calibration has ended with this result.
    Done(Report),
}

impl Calibration {
    /// Number of samples that the calibration takes.
    pub const fn wanted(&self) -> u32 {
        self.wanted
    }

    /// Starts a calibration. The number of samples is clamped to the range [`MOST_SAMPLES`].
    pub fn new(units: Units, samples: u32) -> Self {
        Self {
            units,
            wanted: samples.clamp(MOST_SAMPLES[0], MOST_SAMPLES[1]),
            count: 0,
            first: Sample::default(),
            last_us: 0,
            sum: [0; 3],
            squares: [0; 3],
            half: [0; 3],
        }
    }

    /// Takes a sample and returns the progress. A sample with the time stamp of the previous sample is ignored.
    ///
    /// # Errors
    /// The sensor moved or does not measure. This ends the calibration.
    pub fn on_sample(&mut self, sample: &Sample) -> Result<Progress, SampleError> {
        if self.count == 0 {
            self.first = *sample;
        } else if sample.t_us == self.last_us {
            return Ok(Progress::Going(self.count));
        }
        self.last_us = sample.t_us;
        self.check(sample)?;
        for axis in 0..3 {
            let rate = i64::from(sample.gyro[axis]);
            self.sum[axis] += rate;
            self.squares[axis] += (rate * rate) as u64;
        }
        self.count += 1;
        if self.count == self.wanted / 2 {
            self.half = self.sum;
        }
        if self.count < self.wanted {
            return Ok(Progress::Going(self.count));
        }
        let report = self.report();
        *self = Self::new(self.units, self.wanted);
        report.map(Progress::Done)
    }

    fn check(&self, sample: &Sample) -> Result<(), SampleError> {
        let most = self.units.rate(MOST_RATE);
        let apart = |a: i16, b: i16| u32::from(a.abs_diff(b));
        for axis in 0..3 {
            let by = apart(sample.gyro[axis], self.first.gyro[axis]);
            if by > most {
                let sample = self.count;
                return Err(SampleError::Turned {
                    sample,
                    axis,
                    by,
                    most,
                });
            }
        }
        let most = (self.units.per_g * MOST_FORCE).div_ceil(8);
        for axis in 0..3 {
            let by = apart(sample.accel[axis], self.first.accel[axis]);
            if by > most {
                let sample = self.count;
                return Err(SampleError::Pushed {
                    sample,
                    axis,
                    by,
                    most,
                });
            }
        }
        Ok(())
    }

    fn report(&self) -> Result<Report, SampleError> {
        let count = i64::from(self.count);
        let mean = |sum: i64, count: i64| ((sum * 256 + count / 2).div_euclid(count)) as i32;
        let bias = self.sum.map(|sum| mean(sum, count));
        let early = count / 2;
        let changed = (self.units.rate(MOST_CHANGE) * 256).div_ceil(8);
        let largest = self.units.rate(MOST_BIAS);
        for (axis, &bias) in bias.iter().enumerate() {
            let first = mean(self.half[axis], early);
            let second = mean(self.sum[axis] - self.half[axis], count - early);
            let by = first.abs_diff(second);
            if by > changed {
                return Err(SampleError::Changed {
                    axis,
                    by,
                    most: changed,
                });
            }
            if bias.unsigned_abs() > largest * 256 {
                return Err(SampleError::TooLarge {
                    axis,
                    mean: bias.signum() * bias.unsigned_abs().div_ceil(256) as i32,
                    most: largest,
                });
            }
        }
        // n²·variance of the rate about each axis, for n samples: at most 2^62, and at least 0 by the Cauchy–Schwarz inequality.
        let spread = [0, 1, 2].map(|axis| {
            u64::from(self.count) * self.squares[axis] - self.sum[axis].unsigned_abs().pow(2)
        });
        if spread == [0; 3] {
            return Err(SampleError::Frozen);
        }
        let n = u64::from(self.count);
        Ok(Report {
            samples: self.count,
            bias,
            deviation: spread.map(|x| (x.isqrt() * 256 / n) as u32),
            error: spread.map(|x| ((((x / n) << 16).isqrt() << 8) / n) as u32),
        })
    }
}

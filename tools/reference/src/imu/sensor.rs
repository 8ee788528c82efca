//! Simulated sensors, which sample a motion.

use glint_core::orientation::Sample;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::motion::Motion;
use crate::camera::Vector;

/// Properties and errors of a simulated gyroscope and accelerometer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Counts (LSB) of the gyroscope per °/s.
    pub gyro_lsb: f64,
    /// Counts (LSB) of the accelerometer per g.
    pub accel_lsb: f64,
    /// Bias of the gyroscope in °/s.
    pub bias: Vector,
    /// Standard deviation of the noise in each sample of the gyroscope, in °/s.
    pub noise: f64,
    /// Standard deviation of the noise in each sample of the accelerometer, in g.
    pub accel_noise: f64,
    /// Relative error of the gyroscope's scale, as a fraction of the rate.
    pub scale_error: f64,
    /// Samples per second.
    pub rate: f64,
    /// Largest deviation of a sample's time from even spacing, as a fraction of the sampling period.
    pub jitter: f64,
    /// Fraction of the samples that are lost.
    pub lost: f64,
}

impl Sensor {
    /// Creates a sensor with ranges of ±2000 °/s and ±8 g that measures `rate` samples per second. Its only error is the rounding to
    /// counts.
    pub fn ideal(rate: f64) -> Self {
        Self {
            gyro_lsb: 16.4,
            accel_lsb: 4096.0,
            bias: [0.0; 3],
            noise: 0.0,
            accel_noise: 0.0,
            scale_error: 0.0,
            rate,
            jitter: 0.0,
            lost: 0.0,
        }
    }

    /// Creates a sensor with the noise and the bias of a real sensor, which were measured in logged samples.
    pub fn real(rate: f64) -> Self {
        Self {
            bias: [4.5, 0.05, 1.1],
            noise: 0.1,
            accel_noise: 0.004,
            ..Self::ideal(rate)
        }
    }

    /// Returns the samples of a motion. `count` includes lost samples. The first and the last sample are never lost and have no
    /// jitter. `seed` is the seed of the random numbers.
    pub fn samples(self, motion: Motion, count: u64, seed: u64) -> impl Iterator<Item = Sample> {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let period = 1e6 / self.rate;
        (0..count).filter_map(move |i| {
            let inner = i > 0 && i + 1 < count;
            let jitter = if inner {
                self.jitter * (2.0 * uniform(&mut random) - 1.0)
            } else {
                0.0
            };
            let lost = uniform(&mut random) < self.lost && inner;
            // Time stamps are whole microseconds, and the motion is sampled exactly at the rounded time stamp.
            let t_us = ((i as f64 + jitter) * period).round();
            let t = t_us * 1e-6;
            let (rate, force) = (motion.rate(t), motion.force(t));
            let sample = Sample {
                t_us: t_us as u64,
                gyro: [0, 1, 2].map(|k| {
                    let true_rate = rate[k].to_degrees() * (1.0 + self.scale_error);
                    let noise = scaled_noise(self.noise, &mut random);
                    counts((true_rate + self.bias[k] + noise) * self.gyro_lsb)
                }),
                accel: force.map(|x| {
                    counts((x + scaled_noise(self.accel_noise, &mut random)) * self.accel_lsb)
                }),
            };
            (!lost).then_some(sample)
        })
    }
}

/// Rounds to the nearest count. Values beyond the range of i16 saturate, as in the sensor.
fn counts(x: f64) -> i16 {
    x.round() as i16
}

fn uniform(random: &mut impl Rng) -> f64 {
    random.random()
}

/// Draws a random number from the normal distribution with mean 0 and the standard deviation `deviation`.
fn scaled_noise(deviation: f64, random: &mut impl Rng) -> f64 {
    if deviation == 0.0 {
        0.0
    } else {
        deviation * normal(random)
    }
}

/// Draws a random number from the standard normal distribution, by the method of Box and Muller.
pub(crate) fn normal(random: &mut impl Rng) -> f64 {
    let radius = (-2.0 * (1.0 - uniform(random)).ln()).sqrt();
    radius * (std::f64::consts::TAU * uniform(random)).cos()
}

//! Parts of the computation from a motion sensor's registers to an attitude: times, temperatures, tilt, bias at rest, and products.

use anyhow::{Context, Result};
use glint_core::fixed::{Q2_30, Q32_32};
use glint_core::mpu6050::{Identity, Pace, degrees_per_second};
use glint_core::orientation::{
    Integrator, Quaternion, RestBias, Sample, Scale, TIME_CONSTANT, Tilt, Units, log,
};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("temperature", |raw| {
            let [mpu6050, mpu6500, icm20689] =
                [Identity::Mpu6050, Identity::Mpu6500, Identity::Icm20689]
                    .map(|identity| identity.temperature(raw));
            Ok(Outcome::exact(format!(
                "MPU-6050 {mpu6050}, MPU-6500 {mpu6500}, ICM-20689 {icm20689} of 1/100 °C"
            )))
        }),
        Kind::new("rate", |rate| {
            Ok(Outcome::exact(format!("{} °/s", degrees_per_second(rate))))
        }),
        Kind::new("scale", |lsb: String| {
            let scale = Scale::new(lsb.parse()?);
            Ok(Outcome::exact(
                scale.map_or("no scale", |_| "accepted").to_owned(),
            ))
        }),
        Kind::new("sample-times", sample_times),
        Kind::new("log-times", log_times),
        Kind::new("quaternion-product", |[a, b]: [[i32; 4]; 2]| {
            let [w, x, y, z] = quaternion(a)?.times(quaternion(b)?).parts();
            Ok(Outcome::exact(format!("({w}, {x}, {y}, {z})")))
        }),
        Kind::new("heading", |parts: [i32; 4]| {
            let heading = quaternion(parts)?.heading().to_signed_degrees();
            Ok(Outcome::exact(format!("{:.4}°", heading.to_num::<f64>())))
        }),
        Kind::new("tilt-correction", tilt_correction),
        Kind::new("rest", rest),
        Kind::new("integration", integration),
    ]
}

fn quaternion(parts: [i32; 4]) -> Result<Quaternion> {
    Quaternion::new(parts.map(Q2_30::from_bits)).context("expected an attitude")
}

/// Computes the sample clock's time stamps in µs for a sequence of reads. Each read has a time in µs, and may return a new sample.
fn sample_times(reads: Vec<(u64, bool)>) -> Result<Outcome> {
    let mut pace = Pace::new(glint_core::mpu6050::PERIOD);
    let times = reads.into_iter().map(|(time, found)| {
        let measured = pace.on_poll(time, found);
        measured.map_or("-".to_owned(), |time| time.to_string())
    });
    Ok(Outcome::exact(times.collect::<Vec<_>>().join(" ")))
}

/// The times in µs of a log's samples, reconstructed from the low words in the records.
fn log_times(words: Vec<u32>) -> Result<Outcome> {
    let mut time = log::START;
    let times = words.into_iter().map(|word| {
        time = log::sample([word, 0, 0, 0], time).t_us;
        time.to_string()
    });
    Ok(Outcome::exact(times.collect::<Vec<_>>().join(" ")))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reading {
    /// Counts of the accelerometer, 4096 for 1 g.
    reading: [i16; 3],
    /// Time since the previous reading in µs.
    step: u32,
    /// Components of the attitude.
    attitude: [i32; 4],
    /// Number of readings.
    #[serde(default = "one")]
    times: u32,
}

const fn one() -> u32 {
    1
}

/// The number of accepted readings, and the last tilt correction about each axis in degrees.
fn tilt_correction(input: Reading) -> Result<Outcome> {
    let mut tilt = Tilt::new(Units::MPU_6050.per_g, TIME_CONSTANT);
    let attitude = quaternion(input.attitude)?;
    let (mut half, mut accepted) = ([0; 3], 0);
    for _ in 0..input.times {
        half = [0; 3];
        accepted += u32::from(tilt.correct(&attitude, input.reading, input.step, &mut half));
    }
    let [x, y, z] = half.map(|half| (2.0 * half as f64 / 2f64.powi(48)).to_degrees());
    Ok(Outcome::exact(format!(
        "{accepted} accepted; about x {x:.4}°, y {y:.4}°, z {z:.4}°"
    )))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Resting {
    /// Initial bias, in 1/256 LSB.
    bias: [i32; 3],
    gyro: [i16; 3],
    accel: [i16; 3],
    /// Time between samples in µs.
    step: u32,
    samples: u32,
}

/// Whether the sensor counts as resting after some samples, and the resulting bias.
fn rest(input: Resting) -> Result<Outcome> {
    let mut rest = RestBias::new(Units::MPU_6050, input.bias);
    for number in 0..input.samples {
        let sample = Sample {
            t_us: u64::from(number) * u64::from(input.step),
            accel: input.accel,
            gyro: input.gyro,
        };
        rest.on_sample(&sample, input.step);
    }
    let state = if rest.is_at_rest() {
        "at rest"
    } else {
        "moving"
    };
    let bias = rest.bias().map(|x| Q32_32::from_num(x) / 256);
    Ok(Outcome::exact(format!("{state}, bias {bias:?} LSB")))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Step {
    /// Rates in 1/256 LSB.
    rate: [i32; 3],
    step: u32,
}

/// The attitude after one step from rest.
fn integration(Step { rate, step }: Step) -> Result<Outcome> {
    let mut integrator = Integrator::new(Scale::MPU_6050, Quaternion::IDENTITY, rate);
    integrator.advance(rate, step, [0; 3]);
    let [w, x, y, z] = integrator.attitude().parts();
    Ok(Outcome::exact(format!("({w}, {x}, {y}, {z})")))
}

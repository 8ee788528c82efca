//! Quaternions at the poles, and samples of a motion sensor at the ends of their ranges.

use anyhow::Result;
use glint_core::calibration::{Calibration, Progress};
use glint_core::fixed::{Q2_30, Q32_32, Turns};
use glint_core::orientation::log::{Setup, record, replay, to_bytes};
use glint_core::orientation::{
    Angles, Quaternion, Sample, Scale, TIME_CONSTANT, Tilt, Tracker, Units,
};
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("quaternion", |parts: [i32; 4]| {
            let attitude = Quaternion::new(parts.map(Q2_30::from_bits));
            Ok(Outcome::exact(
                attitude.map_or_else(|| "no attitude".to_owned(), parts_of),
            ))
        }),
        Kind::new("angles", angles),
        Kind::new("about-axis", |Turn { axis, angle }| {
            Ok(Outcome::exact(parts_of(Quaternion::about_axis(
                axis,
                Turns(angle),
            ))))
        }),
        Kind::new("tilt", |reading| {
            Ok(Outcome::exact(stated(Tilt::align(reading).angles())))
        }),
        Kind::new("constant-rate", constant_rate),
        Kind::new("samples", samples),
        Kind::new("calibration", calibration),
        Kind::new("log-image", log_image),
    ]
}

fn parts_of(attitude: Quaternion) -> String {
    let [w, x, y, z] = attitude.parts();
    format!("({w}, {x}, {y}, {z})")
}

fn stated(angles: Angles) -> String {
    let degrees = |angle: Turns| angle.to_signed_degrees().to_num::<f64>();
    let [yaw, pitch, roll] = [angles.yaw, angles.pitch, angles.roll].map(degrees);
    format!("yaw {yaw:.4}°, pitch {pitch:.4}°, roll {roll:.4}°")
}

/// Converts yaw, pitch and roll in degrees to an attitude and back.
fn angles(degrees: [f64; 3]) -> Result<Outcome> {
    let [yaw, pitch, roll] = degrees.map(|x| Turns::from_degrees(Q32_32::from_num(x)));
    let attitude = Quaternion::from_angles(Angles { yaw, pitch, roll });
    Ok(Outcome::exact(stated(attitude.angles())))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Turn {
    axis: usize,
    angle: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Rate {
    /// Counts about each axis.
    gyro: [i16; 3],
    /// Time between samples in µs.
    step: u32,
    samples: u32,
    /// Time of the first sample in µs.
    #[serde(default)]
    start: u64,
}

/// Measures the error of the attitude after a rotation at a constant rate, compared with the closed form.
fn constant_rate(input: Rate) -> Result<Outcome> {
    let mut tracker = Tracker::new(Scale::MPU_6050, None);
    for i in 0..=input.samples {
        tracker.on_sample(&Sample {
            t_us: input.start + u64::from(i) * u64::from(input.step),
            accel: [0; 3],
            gyro: input.gyro,
        });
    }
    let rate = input.gyro.map(|count| f64::from(count) / 16.4);
    let speed = rate.iter().map(|x| x * x).sum::<f64>().sqrt();
    let seconds = f64::from(input.samples) * f64::from(input.step) * 1e-6;
    // Half the angle, modulo the full turns of the quaternion.
    let half = (speed * seconds % 720.0).to_radians() / 2.0;
    let (sin, cos) = half.sin_cos();
    let axis = rate.map(|x| if speed > 0.0 { x / speed } else { 0.0 });
    let exact = [cos, sin * axis[0], sin * axis[1], sin * axis[2]];
    let found = tracker.attitude().parts().map(f64::from);
    let apart = |sign: f64| {
        let squares = (0..4).map(|i| (found[i] - sign * exact[i]).powi(2));
        squares.sum::<f64>().sqrt()
    };
    // Unit quaternions at a distance of 2·sin(θ/4) differ by a rotation of θ.
    let angle = 4.0 * (apart(1.0).min(apart(-1.0)) / 2.0).asin();
    Ok(Outcome::Error(angle.to_degrees(), "°"))
}

/// Processes samples (time, and counts of accelerometer and gyroscope); states their effects and the attitude.
fn samples(samples: Vec<(u64, [i16; 3], [i16; 3])>) -> Result<Outcome> {
    let tilt = Tilt::new(Units::MPU_6050.per_g, TIME_CONSTANT);
    let mut tracker = Tracker::new(Scale::MPU_6050, Some(tilt));
    let effects: Vec<_> = samples
        .into_iter()
        .map(|(t_us, accel, gyro)| {
            let effect = tracker.on_sample(&Sample { t_us, accel, gyro });
            format!("{effect:?}").to_lowercase()
        })
        .collect();
    let counts = tracker.counts();
    Ok(Outcome::exact(format!(
        "{}; {} saturated, {} rejected; {}",
        effects.join(", "),
        counts.saturated,
        counts.rejected,
        stated(tracker.attitude().angles())
    )))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Still {
    samples: u32,
    /// Counts of the gyroscope in the even and the odd samples.
    gyro: [[i16; 3]; 2],
    /// Counts that are added to the samples from the middle of the sequence on.
    #[serde(default)]
    later: [i16; 3],
    /// Counts that are added to the accelerometer's counts in the last sample.
    #[serde(default)]
    push: [i16; 3],
}

/// A calibration of the gyroscope.
fn calibration(input: Still) -> Result<Outcome> {
    let mut calibration = Calibration::new(Units::MPU_6050, input.samples);
    for i in 0..input.samples {
        let (is_later, is_last) = (i >= input.samples / 2, i + 1 == input.samples);
        let added = |x: i16, more: i16, when: bool| x.saturating_add(if when { more } else { 0 });
        let gyro = input.gyro[i as usize % 2];
        let sample = Sample {
            t_us: 1_000 * u64::from(i),
            accel: [0, 1, 2].map(|k| added([0, 0, 4096][k], input.push[k], is_last)),
            gyro: [0, 1, 2].map(|k| added(gyro[k], input.later[k], is_later)),
        };
        match calibration.on_sample(&sample) {
            Ok(Progress::Going(_)) => {}
            Ok(Progress::Done(report)) => {
                let bias = report.bias.map(|x| f64::from(x) / 256.0);
                return Ok(Outcome::exact(format!("bias {bias:?} LSB")));
            }
            Err(error) => return Ok(Outcome::Refused(error.to_string())),
        }
    }
    Ok(Outcome::exact("takes more samples"))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Image {
    samples: u32,
    /// Bytes that are overwritten in the log, each as offset and value.
    #[serde(default)]
    edits: Vec<(usize, u8)>,
    /// Length of the log, truncated or padded with zeros.
    length: Option<usize>,
}

/// A log in the binary replay format.
fn log_image(input: Image) -> Result<Outcome> {
    let setup = Setup::new(Units::MPU_6050, true, true, [0; 3])?;
    let mut bytes = setup.header(input.samples).to_vec();
    for i in 0..input.samples {
        bytes.extend(to_bytes(record(&Sample {
            t_us: 1_000 * u64::from(i),
            accel: [0, 0, 4096],
            gyro: [0; 3],
        })));
    }
    for (offset, byte) in input.edits {
        bytes[offset] = byte;
    }
    bytes.resize(input.length.unwrap_or(bytes.len()), 0);
    Ok(Outcome::of(replay(&mut bytes), |counts| {
        format!("{} steps", counts.steps)
    }))
}

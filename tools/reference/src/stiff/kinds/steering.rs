//! Cameras steered by an attitude: mountings, ends of the ranges, poles, and sensitivities.

use anyhow::{Context, Result};
use glint_core::camera::View;
use glint_core::fixed::{Q2_30, Q32_32, Turns};
use glint_core::orientation::{Angles, Quaternion};
use glint_core::steering::{Direction, Mounting, Steering, free_look, orbit};
use serde::Deserialize;

use crate::basis;
use crate::imu::quaternion::Quaternion as Exact;
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![
        Kind::new("mounting", |[forward, up]: [String; 2]| {
            let mounting = Mounting::new(direction(&forward)?, direction(&up)?);
            Ok(Outcome::exact(mounting.map_or_else(
                || "no mounting".to_owned(),
                |mounting| mounting.to_string(),
            )))
        }),
        Kind::new("steered-look", |Look { eye, angles }| {
            let eye = eye.map(Q32_32::from_num);
            let view = free_look(eye, attitude(angles), Mounting::default());
            Ok(Outcome::of(view, |view| directions(&view)))
        }),
        Kind::new("steered-look-error", |angles: [f64; 3]| {
            let view = free_look([Q32_32::ZERO; 3], attitude(angles), Mounting::default())?;
            Ok(Outcome::Error(distortion(&view), "of 2^-23"))
        }),
        Kind::new("steered-orbit", |Orbit { r, angles }| {
            let view = orbit(r.parse()?, attitude(angles), Mounting::default());
            Ok(Outcome::of(view, |view| {
                let [x, y, z] = view.eye();
                format!("eye ({x}, {y}, {z})")
            }))
        }),
        Kind::new("sensitivity", |sensitivity| {
            let steering = Steering::new(sensitivity);
            Ok(Outcome::exact(format!("{}/256", steering.sensitivity())))
        }),
        Kind::new("steering", steering),
        Kind::new("steering-error", steering_error),
    ]
}

fn direction(name: &str) -> Result<Direction> {
    let mut all = Direction::ALL.into_iter();
    all.find(|direction| direction.name() == name)
        .with_context(|| format!("no direction {name:?}"))
}

/// The attitude with these angles: yaw, pitch and roll in degrees.
fn attitude(degrees: [f64; 3]) -> Quaternion {
    let [yaw, pitch, roll] = degrees.map(|x| Turns::from_degrees(Q32_32::from_num(x)));
    Quaternion::from_angles(Angles { yaw, pitch, roll })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Look {
    eye: [f64; 3],
    angles: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Orbit {
    /// Distance as a decimal.
    r: String,
    angles: [f64; 3],
}

fn directions(view: &View) -> String {
    let [ux, uy, uz] = view.u();
    let [nx, ny, nz] = view.n();
    format!("right ({ux}, {uy}, {uz}), forward ({nx}, {ny}, {nz})")
}

/// The largest deviation of a basis vector's length from 1, or of a scalar product from 0, in units of 2^-23.
pub fn distortion(view: &View) -> f64 {
    let [length, angle] = basis::errors(basis::of(view));
    length.max(angle) * 2f64.powi(23)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Path {
    /// Sensitivity in units of 1/256.
    sensitivity: u16,
    /// Successive attitudes of the sensor: components w, x, y, z with 30 fraction bits.
    attitudes: Vec<[i32; 4]>,
}

/// The camera's attitude after the sensor's attitudes.
fn steering(
    Path {
        sensitivity,
        attitudes,
    }: Path,
) -> Result<Outcome> {
    let mut steering = Steering::new(sensitivity);
    let mut camera = Quaternion::IDENTITY;
    for parts in attitudes {
        let attitude = Quaternion::new(parts.map(Q2_30::from_bits));
        camera = steering.follow(attitude.context("expected an attitude")?);
    }
    let [w, x, y, z] = camera.parts();
    Ok(Outcome::exact(format!("({w}, {x}, {y}, {z})")))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Turning {
    /// Sensitivity in units of 1/256.
    sensitivity: u16,
    /// Rotation about z between two polls, in 2^-32 turns.
    step: u32,
    looks: u32,
}

/// The error of the camera's attitude after many small rotations of the sensor, against f64.
fn steering_error(
    Turning {
        sensitivity,
        step,
        looks,
    }: Turning,
) -> Result<Outcome> {
    let mut steering = Steering::new(sensitivity);
    let mut camera = Quaternion::IDENTITY;
    for look in 0..=looks {
        camera = steering.follow(Quaternion::about_axis(2, Turns(look.wrapping_mul(step))));
    }
    let turns = f64::from(looks) * f64::from(step) / 2f64.powi(32) * f64::from(sensitivity) / 256.0;
    let half = turns.rem_euclid(2.0) * std::f64::consts::PI;
    let exact = Exact([half.cos(), 0.0, 0.0, half.sin()]);
    Ok(Outcome::Error(exact.angle_to(camera.into()), "°"))
}

//! Motions with known true rates and attitudes.

use std::f64::consts::TAU;

use super::method::{Integrator, Method};
use super::quaternion::Quaternion;
use crate::camera::Vector;

/// The standard acceleration of gravity, in m/s².
pub const GRAVITY: f64 = 9.806_65;

/// The wave a·sin(2π·f·t + p) at time t: amplitude a, frequency f in Hz and phase p in radians.
type Wave = [f64; 3];

fn value(waves: &[Wave], t: f64) -> f64 {
    waves
        .iter()
        .map(|[a, f, p]| a * (TAU * f * t + p).sin())
        .sum()
}

fn slope(waves: &[Wave], t: f64) -> f64 {
    waves
        .iter()
        .map(|[a, f, p]| a * TAU * f * (TAU * f * t + p).cos())
        .sum()
}

/// A motion of the sensor. Times are in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The sensor is at rest.
    Rest,
    /// A constant rate in °/s about each axis.
    Spin(Vector),
    /// Rotation about all axes simultaneously, at rates up to this value in °/s. The attitude has no closed form.
    Tumble(f64),
    /// The body's z axis moves around a cone.
    Coning {
        /// Half the cone's angle, in degrees.
        angle: f64,
        /// Revolutions around the cone per second.
        frequency: f64,
    },
    /// A square-wave rate about z.
    Square {
        /// Amplitude of the square wave, in °/s.
        rate: f64,
        /// Frequency of the square wave, in Hz.
        frequency: f64,
    },
    /// Hand motion about the wrist, which is 10 cm from the sensor; mostly sideways, with 0.5 to 2 Hz and up to 300 °/s.
    Hand,
    /// Hand motion about the wrist, which is 10 cm from the sensor; mostly up and down.
    Nod,
    /// Motion of a walking person: accelerations of ±3 m/s² vertically and ±1.5 m/s² fore and aft, both at 2 Hz, and 10 m/s²
    /// upwards for 50 ms at every footstep.
    Walk,
}

const HAND: [&[Wave]; 3] = [
    &[[1.2, 0.5, 0.0]],
    &[[0.2, 1.3, 1.0], [0.25, 0.6, 0.0]],
    &[[0.15, 2.0, 0.5]],
];
const NOD: [&[Wave]; 3] = [&[[0.2, 0.7, 0.0]], &[[1.3, 0.5, 0.0]], &[[0.15, 2.0, 0.0]]];
const WALK: [&[Wave]; 3] = [&[[0.3, 0.1, 0.0]], &[[0.05, 2.0, 0.4]], &[[0.07, 1.0, 0.0]]];
/// Vector from the wrist to the sensor, in m.
const ARM: Vector = [0.1, 0.0, 0.0];

impl Motion {
    /// Returns the rate about the body's axes at time `t`, in rad/s.
    pub fn rate(self, t: f64) -> Vector {
        match self {
            Self::Rest => [0.0; 3],
            Self::Spin(rate) => rate.map(f64::to_radians),
            Self::Tumble(peak) => {
                let peak = peak.to_radians();
                [
                    0.6 * peak * (TAU * 0.7 * t).sin(),
                    0.55 * peak * (TAU * 1.1 * t + 1.0).sin(),
                    0.58 * peak * (TAU * 0.5 * t + 0.3).cos(),
                ]
            }
            Self::Coning { angle, frequency } => {
                let (sin, cos) = angle.to_radians().sin_cos();
                let turn = TAU * frequency;
                let (side, front) = (turn * t).sin_cos();
                [-turn * sin * side, turn * sin * front, turn * (cos - 1.0)]
            }
            Self::Square { rate, frequency } => {
                let sign = if (t * frequency).fract() < 0.5 {
                    1.0
                } else {
                    -1.0
                };
                [0.0, 0.0, sign * rate.to_radians()]
            }
            Self::Hand | Self::Nod | Self::Walk => {
                let waves = self.waves();
                let [_, pitch, roll] = waves.map(|waves| value(waves, t));
                let [yawing, pitching, rolling] = waves.map(|waves| slope(waves, t));
                let ((sp, cp), (sr, cr)) = (pitch.sin_cos(), roll.sin_cos());
                [
                    rolling - yawing * sp,
                    pitching * cr + yawing * cp * sr,
                    yawing * cp * cr - pitching * sr,
                ]
            }
        }
    }

    /// Returns yaw, pitch and roll as sums of waves, for motions defined by such sums.
    fn waves(self) -> [&'static [Wave]; 3] {
        match self {
            Self::Hand => HAND,
            Self::Nod => NOD,
            Self::Walk => WALK,
            _ => [&[]; 3],
        }
    }

    /// Returns the attitude at time `t`, if the motion's attitude has a closed form.
    pub fn attitude(self, t: f64) -> Option<Quaternion> {
        match self {
            Self::Rest => Some(Quaternion::IDENTITY),
            Self::Spin(rate) => Some(Quaternion::exp(rate.map(|x| x.to_radians() * t / 2.0))),
            Self::Coning { angle, frequency } => {
                let (sin, cos) = (angle.to_radians() / 2.0).sin_cos();
                let (side, front) = (TAU * frequency * t).sin_cos();
                Some(Quaternion([cos, sin * front, sin * side, 0.0]))
            }
            Self::Tumble(_) => None,
            Self::Square { rate, frequency } => {
                let part = (t * frequency).fract();
                let way = part.min(1.0 - part) / frequency;
                Some(Quaternion::of_angles([rate.to_radians() * way, 0.0, 0.0]))
            }
            Self::Hand | Self::Nod | Self::Walk => Some(Quaternion::of_angles(
                self.waves().map(|waves| value(waves, t)),
            )),
        }
    }

    /// Returns the attitude after `seconds` seconds. Without a closed form ([`Self::attitude`]), integrates from the identity
    /// with 16 · `rate` steps per second.
    pub fn attitude_after(self, seconds: f64, rate: f64) -> Quaternion {
        self.attitude(seconds).unwrap_or_else(|| {
            let step = 1.0 / (16.0 * rate);
            let count = (seconds / step).round() as u64;
            let mut integrator =
                Integrator::new(Method::Cubic, Quaternion::IDENTITY, self.rate(0.0));
            for i in 1..=count {
                integrator.advance(self.rate(i as f64 * step), step);
            }
            integrator.attitude()
        })
    }

    /// Returns the exact reading of an accelerometer along the body's axes at time `t`, in g. For a pure rotation the reading is gravity
    /// alone. If the attitude has no closed form, gravity is assumed along the body's z axis.
    pub fn force(self, t: f64) -> Vector {
        let attitude = self.attitude(t).unwrap_or(Quaternion::IDENTITY);
        let [x, y, z] = self.acceleration(t);
        attitude
            .inverse()
            .rotate([x, y, z + GRAVITY])
            .map(|x| x / GRAVITY)
    }

    /// Returns the acceleration of the sensor along the world's axes at time `t`, in m/s².
    fn acceleration(self, t: f64) -> Vector {
        match self {
            Self::Hand | Self::Nod => {
                // A difference quotient approximates the second derivative of the position, with a negligible error of about 1e-6 m/s².
                let step = 1e-3;
                let [a, b, c] = [t - step, t, t + step].map(|t| {
                    let attitude = self.attitude(t).unwrap_or(Quaternion::IDENTITY);
                    attitude.rotate(ARM)
                });
                [0, 1, 2].map(|i| (a[i] - 2.0 * b[i] + c[i]) / (step * step))
            }
            Self::Walk => {
                let heading = value(WALK[0], t);
                let fore = 1.5 * (TAU * 2.0 * t + 0.8).sin();
                let strike = if (2.0 * t).fract() < 0.1 { 10.0 } else { 0.0 };
                let up = 3.0 * (TAU * 2.0 * t).sin() + strike;
                [fore * heading.cos(), fore * heading.sin(), up]
            }
            _ => [0.0; 3],
        }
    }
}

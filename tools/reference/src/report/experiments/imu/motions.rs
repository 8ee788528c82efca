//! Motions used in several experiments.

use crate::imu::motion::Motion;

/// Rotation at up to 700 °/s about a rotating axis.
pub const TUMBLE: Motion = Motion::Tumble(700.0);
/// Coning with a half angle of 5° at 10 revolutions per second.
pub const CONING: Motion = Motion::Coning {
    angle: 5.0,
    frequency: 10.0,
};
/// Constant rotation at a rate slightly below the limit of the gyroscope's range.
pub const SPIN: Motion = Motion::Spin([0.0, 0.0, 1990.0]);
/// Constant rotation at the rate that corresponds to one count of the gyroscope.
pub const COUNT: Motion = Motion::Spin([1.0 / 16.4, 0.0, 0.0]);

/// Duration of a day in seconds.
pub const DAY: f64 = 86_400.0;

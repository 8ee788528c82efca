//! Motions that several experiments share.

use crate::imu::motion::Motion;

/// A tumble of 700 °/s about a turning axis.
pub const TUMBLE: Motion = Motion::Tumble(700.0);
/// Coning of 5° at 10 Hz.
pub const CONING: Motion = Motion::Coning {
    angle: 5.0,
    frequency: 10.0,
};
/// A rate just inside the gyroscope's range.
pub const SPIN: Motion = Motion::Spin([0.0, 0.0, 1990.0]);
/// A rate of one count.
pub const COUNT: Motion = Motion::Spin([1.0 / 16.4, 0.0, 0.0]);

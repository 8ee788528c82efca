//! The attitude of a body from its gyroscope and accelerometer, in integer arithmetic.
//!
//! Conventions: the quaternion maps body to world, the world's z axis points up, and a flat sensor at rest reads +1 g on its z
//! axis. The attitude at the first sample is the identity; with tilt correction it has the tilt measured by the accelerometer,
//! and yaw 0. Times are in µs. `docs/formats/imu.md` states the number formats and the rounding, and `docs/report/imu.md` states
//! the errors.

mod gain;
mod integrator;
pub mod log;
mod quaternion;
mod rate;
mod rest;
mod sample;
mod scale;
mod tilt;
mod tracker;
mod units;

pub use gain::{Gain, SHORTEST};
pub use integrator::{Integrator, LONGEST_STEP};
pub use quaternion::{Angles, Quaternion};
pub use rate::{LONGEST_CURVE, MOST_STRETCH};
pub use rest::RestBias;
pub use sample::Sample;
pub use scale::{LSB_PER_DPS, Scale};
pub use tilt::{DOUBTFUL, FRESH, LSB_PER_G, TIME_CONSTANT, Tilt};
pub use tracker::{Counts, SampleEffect, Tracker};
pub use units::Units;

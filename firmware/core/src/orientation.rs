//! The attitude of a body from its gyroscope and accelerometer, by integer arithmetic alone.
//!
//! Conventions: the quaternion maps body to world, the world's z is up, a flat sensor at rest reads +1 g on its z. The
//! attitude starts at the first sample: at the identity, or level by the accelerometer with yaw 0. Times are in µs. Formats and
//! roundings are those of `docs/formats.md`, the errors those of `docs/report/imu.md`.

mod gain;
mod integrator;
pub mod log;
mod quaternion;
mod rate;
mod sample;
mod scale;
mod tilt;
mod tracker;

pub use gain::{Gain, SHORTEST};
pub use integrator::{Integrator, LONGEST_STEP};
pub use quaternion::{Angles, Quaternion};
pub use rate::{LONGEST_CURVE, MOST_STRETCH};
pub use sample::Sample;
pub use scale::{LSB_PER_DPS, Scale};
pub use tilt::{DOUBTFUL, FRESH, LSB_PER_G, TIME_CONSTANT, Tilt};
pub use tracker::{Counts, Outcome, Tracker};

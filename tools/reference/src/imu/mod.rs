//! Attitudes from a gyroscope and an accelerometer, in f64: the firmware's method without rounding, other methods, motions with
//! known true attitudes, and simulated sensors of these motions.
//!
//! Rates are in rad/s about the body's axes, forces in g. At rest, an accelerometer reads +1 g upwards.

pub mod filter;
pub mod measure;
pub mod method;
pub mod motion;
pub mod quaternion;
pub mod sensor;

//! Attitudes from a gyroscope and an accelerometer in f64: the firmware's method without its roundings, other methods, motions of
//! known truth, and sensors that measure them.
//!
//! Rates are in rad/s about the body's axes, forces in g. An accelerometer at rest reads +1 g upwards.

pub mod filter;
pub mod measure;
pub mod method;
pub mod motion;
pub mod quaternion;
pub mod sensor;

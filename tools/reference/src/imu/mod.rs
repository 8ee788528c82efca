//! Attitudes from a gyroscope and an accelerometer in f64: the method of the firmware without its roundings, other methods
//! beside it, motions whose truth is known, and sensors that measure them.
//!
//! Rates are in rad/s about the body's axes, forces in g; what an accelerometer at rest reads is +1 g upwards.

pub mod filter;
pub mod measure;
pub mod method;
pub mod motion;
pub mod quaternion;
pub mod sensor;

//! Attitudes from a gyroscope and an accelerometer, in f64: the firmware's method without its roundings, other methods,
//! motions whose true attitude is known, and sensors that measure these motions.
//!
//! Rates are in rad/s about the body's axes, forces in g. At rest, an accelerometer reads +1 g upwards.

pub mod filter;
pub mod measure;
pub mod method;
pub mod motion;
pub mod quaternion;
pub mod sensor;

//! Gyroscope and accelerometer: access to a board's sensor, logs, and the computation of attitudes
//! from logs.

pub mod log;
pub mod replay;
pub mod sensor;
pub mod timeline;

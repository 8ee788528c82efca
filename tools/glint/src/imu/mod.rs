//! Gyroscope and accelerometer: access to a board's sensor, logs, and the attitudes of logs.

pub mod log;
pub mod replay;
pub mod sensor;
pub mod timeline;

//! Logs of a gyroscope and an accelerometer, and the attitudes that follow from them.

pub mod log;
pub mod replay;

//! A gyroscope and an accelerometer: those of a board, their logs, and the attitudes that follow from them.

pub mod log;
pub mod replay;
pub mod sensor;

//! Experiments on the errors of the attitude from gyroscope and accelerometer.
//!
//! - `targets`: errors with a requirement.
//! - `methods`, `filters`: errors of integration methods and of filters, compared with the true attitude.
//! - `time`: growth of the errors over time.
//! - `stiff`: stiff and extreme inputs.
//! - `soft_core`: cycles on the soft core.

pub mod filters;
pub mod methods;
mod motions;
pub mod soft_core;
pub mod stiff;
pub mod targets;
pub mod time;

//! Experiments on the errors of attitudes that are computed from gyroscope and accelerometer.
//!
//! - `targets`: errors that must not exceed a required limit.
//! - `methods`, `filters`: deviations of integration methods and of filters from the true attitude.
//! - `time`: growth of the firmware's errors over time.
//! - `stiff`: errors for difficult and extreme inputs.
//! - `soft_core`: number of the soft core's cycles per sample.

pub mod filters;
pub mod methods;
mod motions;
pub mod soft_core;
pub mod stiff;
pub mod targets;
pub mod time;

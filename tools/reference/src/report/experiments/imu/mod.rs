//! Errors of the attitude: against the same method in f64, against
//! the truth, by method and filter, over time, and in stiff cases.

pub mod filters;
pub mod methods;
mod motions;
pub mod soft_core;
pub mod stiff;
pub mod targets;
pub mod time;

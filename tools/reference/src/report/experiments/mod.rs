//! Measurements. Each returns typed rows, one CSV line each.

pub mod gouraud;
pub mod imu;
pub mod raymarch;
pub mod sine;
pub mod triangle;

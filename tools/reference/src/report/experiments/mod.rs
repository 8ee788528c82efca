//! The measurements of the report. Each measurement returns rows of a type, and each row becomes a line of a CSV file.

pub mod antialiasing;
pub mod constants;
pub mod cpu;
pub mod geometry;
pub mod gesture;
pub mod gouraud;
pub mod imu;
pub mod kernels;
pub mod long;
pub mod quality;
pub mod raymarch;
pub mod sine;
pub mod stiff;
pub mod textures;
pub mod timeline;
pub mod triangle;

//! The motion sensor, its attitude, and the camera that it steers.

pub mod calibration;
pub mod imu;
pub mod mpu6050;
pub mod orientation;
pub mod steering;

//! Tests of the crate's public functions against f64, models and stated texts.
//!
//! One program has them all, because each program is linked on its own.

mod calibration;
mod camera;
mod console;
mod field;
mod fixed;
mod flash;
mod follow;
mod framing;
mod gesture;
mod gesture_colours;
mod image_sensor;
mod imu;
mod interrupts;
mod light;
mod matrix;
mod mesh;
mod mpu6050;
mod orientation;
mod polar;
mod random;
mod regions;
mod shape;
mod stereo;
mod trig;
mod wire;
mod wireframe;

//! Tests of the crate's public functions against f64, models and expected texts.
//!
//! All tests are in one program, because linking further programs takes time.

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

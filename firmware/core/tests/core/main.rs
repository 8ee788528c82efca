//! Tests of the crate's public functions against f64, models and expected texts.
//!
//! All tests are in one program, because linking further programs takes time.

mod allocator;
mod animation;
mod bits;
mod calibration;
mod camera;
mod colour;
mod console;
mod cordic;
mod field;
mod fixed;
mod flash;
mod font;
mod framing;
mod gesture;
mod gesture_colours;
mod image_sensor;
mod imu;
mod interrupts;
mod lens;
mod light;
mod matrix;
mod mesh;
mod mpu6050;
mod orientation;
mod random;
mod shape;
mod steering;
mod stereo;
mod texture;
mod trig;
mod wire;
mod wireframe;

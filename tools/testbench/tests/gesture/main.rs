//! Compares the results of the gesture engine, whose input is the pins of an image sensor, with glint-model. The ratio of the system clock
//! to the sensor's clock varies.
//!
//! The build `gesture_engine_hasty` has the sums of products, and regards the sensor's clock as stopped after 64 clocks.

mod bench;
mod camera;
mod colours;
mod frames;
mod stiff;

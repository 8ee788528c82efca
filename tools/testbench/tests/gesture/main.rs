//! Compares the gesture engine, from the image sensor's pins to the results, with glint-model, at any ratio of the two clocks.
//!
//! The build `gesture_engine_hasty` has the sums of products, and regards the sensor's clock as stopped after 64 clocks.

mod bench;
mod camera;
mod colours;
mod frames;
mod stiff;

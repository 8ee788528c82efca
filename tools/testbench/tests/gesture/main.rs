//! Compares the gesture engine with glint-model, from the pins of the image sensor to the results, with two clocks of any ratio.
//!
//! In the build `gesture_engine_hasty`, the sensor's clock counts as stopped after 64 clocks, and the sums of products are built.

mod bench;
mod camera;
mod colours;
mod frames;
mod stiff;

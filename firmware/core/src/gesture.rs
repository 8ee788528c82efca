//! A hand in front of an image sensor that moves the camera on a sphere about the origin.
//!
//! The gesture engine counts the pixels of the hand's colour in each camera frame, and adds up their coordinates
//! ([`Statistics`]). From these sums the firmware computes centre, width and confidence ([`Blob`]), then a target for the camera
//! ([`target()`]):
//!
//! | hand | camera |
//! |---|---|
//! | x of the centre | azimuth θ, one turn over the frame's width |
//! | y of the centre | polar angle φ, half a turn over the height, limited to [`POLE`] from both poles |
//! | width, the square root of the area | distance r: 5 for [`WIDTHS`]`[0]` of the frame or less, 2 for [`WIDTHS`]`[1]` or more |
//!
//! [`Control`] filters the target, holds the camera while the hand is lost, and moves smoothly to a hand that returns. [`Control`]
//! also returns the [`EngineSetting`] for the next frame: the region around the hand, outside which no pixels are counted.
//! [`calibrate`] finds the windows of the hand's colour from a small picture.
//!
//! Noise pixels all over the frame pull the mean of all pixels to the frame's middle: 5 % of noise pixels shift it by up to 90 pixels for
//! a hand of 500 pixels (docs/report/gesture.md). Therefore the engine ignores short runs of pixels in a line, and all pixels outside the
//! region. Around a hand at rest the region is small, so shorter runs, such as fingertips, may count.

mod blob;
mod calibration;
mod control;
mod filter;
mod target;

pub use blob::{Blob, Doubt, LEAST_CONFIDENCE, Region, Statistics, quotient};
pub use calibration::{Calibrated, ColourError, LEAST_SAMPLES, WIDEST, Window, calibrate};
pub use control::{
    ANGLE, CHANNELS, Control, DISTANCE, EngineSetting, PATIENCE, Pose, Presence, RUN_MOVING,
    RUN_RESTING, RUN_SEARCHING,
};
pub use filter::{Backlash, OneEuro, TimeStep, Tuning, low_pass_gain, towards};
pub use target::{POLE, WIDTHS, target};

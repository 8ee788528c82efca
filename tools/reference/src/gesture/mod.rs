//! Camera frames with a hand at a known position, and the errors of the camera's control by the hand.

pub mod cases;
pub mod filters;
pub mod frame;
pub mod path;

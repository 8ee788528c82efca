//! Camera frames with a hand whose place is known, and the errors of the camera's control by it.

pub mod cases;
pub mod filters;
pub mod frame;
pub mod path;

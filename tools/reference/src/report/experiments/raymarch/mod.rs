//! Experiments on the raymarcher: errors of its pictures, its speed on the whole SoC, and studies of its parameters.

pub mod fixed_point;
pub mod pictures;
pub mod rates;
pub mod requirements;
pub mod studies;
pub mod trials;
pub mod words;

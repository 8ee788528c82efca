//! The raymarcher's parts against the model's.

mod frames;
mod generator;
mod lane;
mod paint;
mod scenes;

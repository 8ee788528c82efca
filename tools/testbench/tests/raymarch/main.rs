//! The raymarcher's modules against the model.

mod frames;
mod generator;
mod lane;
mod paint;
mod scenes;

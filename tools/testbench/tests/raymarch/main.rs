//! Tests that compare the raymarcher's modules with the model.

mod frames;
mod generator;
mod lane;
mod paint;
mod scenes;

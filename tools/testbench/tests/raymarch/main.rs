//! Tests that compare the raymarcher's modules with the model.

mod exits;
mod frames;
mod generator;
mod lane;
mod paint;
mod scenes;
mod spheres;

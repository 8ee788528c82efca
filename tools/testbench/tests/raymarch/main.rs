//! The raymarcher's parts against the model's.

#[path = "../../../../firmware/model/tests/common/mod.rs"]
mod common;
mod frames;
mod generator;
mod lane;
mod paint;
mod ports;
mod scenes;

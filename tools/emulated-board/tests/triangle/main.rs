//! Tests that the frames of the emulated board's triangle engine equal the model's.

mod bench;
mod damage;
mod frames;
mod lines;

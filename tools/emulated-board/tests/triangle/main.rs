//! The triangle engine of the emulated board, by its registers: its frames are those of the model.

mod bench;
mod damage;
mod frames;
mod lines;

//! Words, and names of values.

pub mod choice;
pub mod words;

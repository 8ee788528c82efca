//! What a board does without a host: its demo, its displays of digits, and the turns of its tasks.

pub mod demo;
pub mod digits;
pub mod tasks;

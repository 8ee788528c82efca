//! Functions of a board without a host: the demo, the seven-segment displays, and the scheduling of tasks.

pub mod demo;
pub mod digits;
pub mod tasks;

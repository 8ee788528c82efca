//! Experiments on smooth shading: errors of the model and of other forms of it, and their clocks and FPGA resources.

pub mod clocks;
pub mod engines;
pub mod forms;
pub mod scenes;
